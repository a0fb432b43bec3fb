"""A contact law that is known by its free impact at an orbit's own speed.

A law whose restitution falls with the speed has *one* r and *one* D only at a speed. To
compare models, it is given by both at the impact speed of the orbit in question.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.law_model import LawModel
from bouncing_ball.orbits.model import Side

# Law and orbit in turn: the speed hardly depends on a law with the same r and D, and the
# secant through two rounds leaves little of that.
_ROUNDS = 20
_SETTLED = 1e-13


def rigid_speed(n: int, restitution: float) -> float:
    """Impact speed 2πn/(1 + r) of the restitution model's n-T orbits, at every Λ.

    Examples
    --------
    >>> rigid_speed(2, 1.0) == 2 * math.pi
    True
    """
    return 2 * math.pi * n / (1 + restitution)


def law_at_orbit(
    kind: type[ContactLaw],
    restitution: float,
    duration: ArrayLike,
    n: int,
    amplitude: float,
    side: Side = Side.STABLE,
) -> ContactLaw:
    """The laws with r and D at the impact speeds of their own n-T orbits at Λ.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    ModelError
        If no law of this kind has these r and D.

    Examples
    --------
    >>> from bouncing_ball.contacts.law_signature import free_impact
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji
    >>> law = law_at_orbit(Tsuji, 0.65, 0.1, 1, 1.0)
    >>> speed = -LawModel(law).orbit(1, 1.0).relative_impact_velocity
    >>> round(float(free_impact(law, speed).duration), 12)
    0.1
    """
    taken = np.asarray(duration, dtype=float)
    speed = np.full_like(taken, rigid_speed(n, restitution))
    before = missed_before = np.full_like(taken, np.nan)
    for _ in range(_ROUNDS):
        law = law_of_impact(kind, restitution, taken, speed)
        model = LawModel(law)
        orbit = model.orbit(n, amplitude, side)
        lost = np.flatnonzero(~np.atleast_1d(orbit.exists))
        if lost.size:
            LawModel(law.take(lost[0])).require_orbit(n, amplitude, side)
        missed = -orbit.relative_impact_velocity - speed
        if np.all(np.abs(missed) <= _SETTLED * speed):
            return law
        slope = np.full_like(taken, -1.0)
        np.divide(missed - missed_before, speed - before, out=slope, where=speed != before)
        before, missed_before = speed, missed
        speed = speed - missed / np.where(np.abs(slope + 1) < 0.5, slope, -1.0)
    raise NoOrbitError(
        f"no {n}-T orbit at Λ = {amplitude:g} whose own impact has r = {restitution:g} and "
        f"D = {float(taken.flat[0]):g} was found for {kind.name}"
    )
