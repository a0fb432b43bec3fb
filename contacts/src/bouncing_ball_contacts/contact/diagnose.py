"""Why a ball does not bounce with the parameters of an engine, and the least change that makes it.

The damping ratio of the parameters is compared with that of a bounce, and what a time step takes
with what it may take. The stiffness stays: the least change is that of the damping, or of the step.
"""

import math

from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.engines.engine import Engine, without_step
from bouncing_ball_contacts.engines.given_step import AtStep
from bouncing_ball_contacts.engines.impacts import steps_for
from bouncing_ball_contacts.engines.physical import Physical

# The r of the change that is named if none is asked for, and how closely an r is met.
_SOME = 0.5
_NEAR = 0.01


def diagnosis(contact: Contact, at: AtStep | None) -> tuple[str, ...]:
    """Sentences on what keeps the parameters of an engine from the r that is asked for, or from
    any bounce; empty if nothing does.

    Parameters
    ----------
    contact : Contact
        With the parameters of an engine, whose damping does not depend on the speed, and the
        ``restitution`` that is asked for, if one is.
    at : AtStep, optional
        What they are at a time step.

    Examples
    --------
    >>> contact = Contact(mass=1.0, from_engine="mujoco", solref="0.02 1", restitution=0.8)
    >>> diagnosis(contact, None)
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
    if zeta < 1 and at is not None and wanted is not None and abs(at.mean - r) > _NEAR:
        found.append(_by_step(engine, ball, release, at))
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


def _by_step(engine: Engine, ball: Physical, release: Release, at: AtStep) -> str:
    """A clause on the step: it is too long for the stiffness."""
    enough = steps_for(engine.scheme.uncompensated, ball.damping_ratio, release, _NEAR)
    step = float(f"{ball.contact_time(release) / enough:.2g}")
    return (
        f"the time step of {at.time_step:g} s changes r to {at.span}: a contact takes "
        f"{at.steps:.3g} steps, and from {enough} on, at {step:g} s, r is within {_NEAR:g}"
    )
