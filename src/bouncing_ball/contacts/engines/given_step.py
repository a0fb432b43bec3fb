r"""What a contact does in an engine whose time step is given, and how stiff it may be there.

In most simulations the time step Δt is given, and the contact has to suit it. With ``h = ωΔt`` a
free impact is computed by the map of the engine's scheme
(:mod:`bouncing_ball.contacts.engines.scheme`) as it is: beyond the limit of stability a ball is
thrown out of a single step, faster than it came. For a given ζ the duration T of a contact in
units of 1/ω is fixed, so that a contact that needs N steps has ::

    ω = T/(N Δt),   k = m ω²,   c = 2ζmω

With the smallest N for which r is within the error, this is the stiffest contact.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.engines.scheme import (
    Scheme,
    fewest_steps,
    free_impact,
    impacts_in_steps,
    is_stable,
)
from bouncing_ball.errors import ModelError
from bouncing_ball.models.damping import Release

# Velocities below this part of that of the impact are those of a ball that does not leave.
_STAYS = 1e-6
# Time steps in a contact of a simulation, with a wide margin.
_FEWEST = 1e-3
_MOST = 1e8


@dataclass(frozen=True)
class AtStep:
    """A contact in an engine with a given time step, in SI units.

    ``restitution`` is the r of the contact with small steps. In the engine a free impact has an r
    between ``least`` and ``most``, which depends on where in a step the contact begins, and
    ``error`` is the largest difference from ``restitution``; ``is_within`` tells whether it is
    ``allowed``. A ball that does not leave has r = 0. The contact takes so many ``steps``; it is
    unstable if the steps of a lasting contact grow. The stiffest contact with the same r is within
    the error allowed. ``remarks`` are sentences on how the engine changes the contact at this step.
    """

    engine: str
    time_step: float
    steps: float
    is_stable: bool
    restitution: float
    least: float
    most: float
    error: float
    allowed: float
    is_within: bool
    stiffest: float
    stiffest_damping: float
    stiffest_contact_time: float
    stiffest_steps: float
    remarks: tuple[str, ...] = ()

    @property
    def verdict(self) -> str:
        """What the contact does at this step, in one sentence."""
        span = f"r = {self.least:.4g} to {self.most:.4g}"
        if f"{self.least:.4g}" == f"{self.most:.4g}":
            span = f"r = {self.least:.4g}"
        found = f"a free impact has {span} in place of {self.restitution:.4g}"
        if not self.is_stable:
            return f"unstable in {self.engine}: {found}"
        held = "resolved" if self.is_within else "not resolved"
        allowed = "within" if self.is_within else "not within"
        return f"{held} in {self.engine}: {found}, {allowed} {self.allowed:g}"


def stiffest_contact(
    scheme: Scheme, mass: float, zeta: float, release: Release, time_step: float, error: float
) -> tuple[Physical, float]:
    """The stiffest contact with this ζ whose r is within an error, and its number of time steps.

    Examples
    --------
    >>> ball, steps = stiffest_contact(Scheme.IMPLICIT, 1.0, 0.0, Release.FORCE, 1e-3, 0.1)
    >>> f"{ball.stiffness:.5g} N/m", round(ball.contact_time(Release.FORCE) / 1e-3 - steps, 9)
    ('4550.6 N/m', 0.0)
    """
    fewest = fewest_steps(scheme, zeta, release, error)
    omega = free_impact(zeta, release).duration / (fewest * time_step)
    return Physical(mass, mass * omega**2, 2 * zeta * mass * omega), fewest


def at_step(
    engine: str,
    scheme: Scheme,
    contact: Physical,
    release: Release,
    time_step: float,
    error: float,
    asked: Physical | None = None,
) -> AtStep:
    """What a contact does in an engine's scheme with a time step in s.

    Parameters
    ----------
    engine : str
        Its name, for the texts.
    scheme : Scheme
    contact : Physical
    release : Release
    time_step : float
        Δt in s.
    error : float
        Largest error of r that is allowed, above 0.
    asked : Physical, optional
        The contact that was asked for, if the engine changes it at this step.

    Raises
    ------
    ModelError
        If ζ ≥ 1 with the displacement release, or if contact and step differ by so much that no
        simulation has both.

    Examples
    --------
    >>> ball = Physical(mass=1.0, stiffness=1e8, damping=2e3)
    >>> found = at_step("mujoco", Scheme.SEMI_IMPLICIT, ball, Release.FORCE, 2e-3, 0.001)
    >>> found.is_stable, found.is_within
    (False, False)
    """
    wanted = asked or contact
    r = wanted.restitution(release)
    duration = contact.contact_time(release) * contact.angular_frequency
    step = contact.angular_frequency * time_step
    if not _FEWEST <= duration / step <= _MOST:
        raise ModelError(
            f"a contact of {duration / contact.angular_frequency:.3g} s takes "
            f"{duration / step:.3g} time steps of {time_step:.3g} s, which is not between "
            f"{_FEWEST:g} and {_MOST:g}: check the units"
        )
    zeta = contact.damping_ratio
    found = np.maximum(impacts_in_steps(scheme, zeta, release, step), 0.0)
    found = np.where(found < _STAYS, 0.0, found)
    off = float(np.max(np.abs(found - r)))
    stable = is_stable(scheme, zeta, step)
    same = wanted.damping_ratio
    most, fewest = stiffest_contact(scheme, contact.mass, same, release, time_step, error)
    return AtStep(
        engine=engine,
        time_step=time_step,
        steps=wanted.contact_time(release) / time_step,
        is_stable=stable,
        restitution=r,
        least=float(found.min()),
        most=float(found.max()),
        error=off,
        allowed=error,
        is_within=stable and off <= error,
        stiffest=most.stiffness,
        stiffest_damping=most.damping,
        stiffest_contact_time=fewest * time_step,
        stiffest_steps=fewest,
    )
