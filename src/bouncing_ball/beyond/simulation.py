"""The simulation of balls with any law of the impact, which determines the dynamics.

The laws of this wing have the method ``dynamics``. The two laws of the paper, the spring-damper
contact and the restitution coefficient, have not: they know nothing of motion.
"""

from numpy.typing import ArrayLike

from bouncing_ball.beyond.corrected.signature import Signature
from bouncing_ball.beyond.laws.contact_law import ContactLaw
from bouncing_ball.beyond.laws.linear import LinearLaw
from bouncing_ball.beyond.restitution_by_speed import RestitutionLaw
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.dynamics import Dynamics
from bouncing_ball.paper.motion.restitution import RestitutionDynamics
from bouncing_ball.paper.motion.sequence import Cycle, ImpactSequence

Law = ContactLaw | SpringDamper | Signature | RestitutionLaw | ArrayLike
"""A contact law, the signature of one, or a restitution coefficient: a law r(v) or numbers r."""


def dynamics_of(law: Law, amplitude: ArrayLike) -> Dynamics:
    """The dynamics of a law of the impact on a table of amplitude Λ.

    Raises
    ------
    ModelError
        If r or Λ is outside its range.
    """
    if hasattr(law, "dynamics"):
        return law.dynamics(amplitude)
    if isinstance(law, SpringDamper):
        return LinearLaw.of(law).dynamics(amplitude)
    return RestitutionDynamics.of(law, amplitude)


def simulate(
    law: Law, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """Follow balls from an impact through a number of impacts, the first included.

    Parameters
    ----------
    law : ContactLaw, Signature, RestitutionLaw or array_like
        The contact law, for contacts of finite duration; its signature, for the corrected model;
        or the restitution coefficient, a law r(v) or a number in (0, 1]. Arrays of parameters have
        one entry per ball.
    amplitude : array_like
        Λ ≥ 0.
    phase, velocity : array_like
        The table's phase φ and the absolute velocity z′_i of the ball just before the first impact.
    impacts : int
        Number of impacts to compute. The bounces that are summed up before a ball sticks are not
        counted. Balls that remain on the table have fewer impacts.

    Returns
    -------
    ImpactSequence
        Its rows have the shape to which the arguments broadcast.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range, or if a ball rises from the table.

    Examples
    --------
    On a table at rest an undamped contact preserves the speed, and r = 1/2 halves it:

    >>> simulate(SpringDamper(100.0, 0.0), 0.0, 0.0, -2.0, 3).impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    >>> simulate(0.5, 0.0, 0.0, -8.0, 3).time.tolist()
    [0.0, 8.0, 12.0]
    """
    return dynamics_of(law, amplitude).simulate(phase, velocity, impacts)


def next_impact(
    law: Law, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map from one impact (φ, δ′) to the next, for arguments that broadcast.

    Parameters
    ----------
    law, amplitude
        As in :func:`simulate`.
    phase, relative_velocity : array_like
        The table's phase φ and the ball's δ′ ≤ 0 just before an impact.

    Raises
    ------
    ModelError
        If r or Λ is outside its range, or if a flight is too long for floating-point numbers.

    Examples
    --------
    On a table at rest a ball whose contact is undamped returns with the same velocity:

    >>> from bouncing_ball.beyond.laws.hertzian import HuntCrossley
    >>> cycle = next_impact(HuntCrossley(1e6, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 11)
    -2.0
    """
    return dynamics_of(law, amplitude).next_impact(phase, relative_velocity)
