"""Why a ball does not bounce with the parameters of an engine, and the least change that makes it.

The damping ratio of the parameters is compared with that of a bounce. The stiffness stays: the
least change is that of the damping.
"""

import math

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.engines.engine import Engine, without_step
from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.models.damping import Release, damping_ratio

# The r of the change that is named if none is asked for, and how closely an r is met.
_SOME = 0.5
_NEAR = 0.01


def diagnosis(contact: Contact) -> tuple[str, ...]:
    """Sentences on what keeps the parameters of an engine from the r that is asked for, or from
    any bounce; empty if nothing does.

    Parameters
    ----------
    contact : Contact
        With the parameters of an engine, whose damping does not depend on the speed, and the
        ``restitution`` that is asked for, if one is.

    Examples
    --------
    >>> contact = Contact(mass=1.0, from_engine="mujoco", solref="0.02 1", restitution=0.8)
    >>> diagnosis(contact)
    ("it does not bounce, because ζ = 1 leaves r = 0.14 at most; with solref = '-2500 -7.44', \
of the same stiffness, r is 0.8 with small steps",)
    """
    engine = contact.engine
    if engine is None or engine.needs_speed:
        return ()
    ball = engine.read(without_step(contact.engine_parameters), contact.mass)
    release = engine.release(contact.release)
    zeta = ball.damping_ratio
    holds = ball.holds(release)
    r = 0.0 if holds else ball.restitution(release)
    wanted = contact.restitution
    found = []
    if holds or zeta >= 1 or (wanted is not None and abs(r - wanted) > _NEAR):
        why = f"r is {r:.4g} with small steps, as ζ = {zeta:.4g}"
        if holds or zeta >= 1:
            why = f"it does not bounce, because ζ = {zeta:.4g} leaves r = {r:.2g} at most"
        change = _with_restitution(engine, ball, _SOME if wanted is None else wanted, release)
        found.append(f"{why}; {change}")
    return tuple(found)


def _with_restitution(engine: Engine, ball: Physical, r: float, release: Release) -> str:
    """A clause on the parameters of the same stiffness with a restitution."""
    zeta = float(damping_ratio(r, release))
    c = 2 * zeta * math.sqrt(ball.stiffness * ball.mass)
    values = engine.parameters(ball._replace(damping=float(f"{c:.3g}")))
    before = engine.parameters(ball)
    said = [f"{name} = {_text(x)}" for name, x in values.items() if x != before[name]]
    return f"with {' and '.join(said)}, of the same stiffness, r is {r:.4g} with small steps"


def _text(value: float | list[float]) -> str:
    if isinstance(value, list):
        return repr(" ".join(f"{x:.12g}" for x in value))
    return f"{value:.12g}"
