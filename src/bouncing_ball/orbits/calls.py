"""What most people need: an orbit, its limits, a simulation; and a contact law by its orbit.

Each takes the parameters of a model: r alone is the restitution model, r and ϖ
are a spring-damper contact with the damping of r by Eq. 16.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.motion.sequence import ImpactSequence
from bouncing_ball.orbits.law_model import LawModel
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side

# Law and orbit in turn: the speed hardly depends on a law with the same r and D, and the
# secant through two rounds leaves little of that.
_ROUNDS = 20
_SETTLED = 1e-13


class Limits(NamedTuple):
    """The orbits between which a family is stable; NaN where there is none."""

    saddle_node: Orbit
    period_doubling: Orbit

    def __repr__(self) -> str:
        return f"saddle-node: {self.saddle_node!r}\nperiod doubling: {self.period_doubling!r}"


def model(
    restitution: float | np.ndarray,
    frequency_ratio: ArrayLike | None = None,
    release: str = "displacement",
) -> ImpactModel:
    """The model with these parameters.

    Parameters
    ----------
    restitution : array_like
        Restitution coefficient r in (0, 1].
    frequency_ratio : array_like, optional
        ϖ of a spring-damper contact; without it an impact is an instant.
    release : str
        What ends a contact: "displacement", as in the paper, or "force".

    Raises
    ------
    ModelError
        If a parameter is out of range, or a release is given and no contact.

    Examples
    --------
    >>> model(0.85)
    RestitutionModel(restitution=0.85)
    """
    if frequency_ratio is not None:
        return SpringDamperModel(
            SpringDamper.from_restitution(restitution, frequency_ratio, release)
        )
    if release != "displacement":
        raise ModelError("a release needs a contact: give its frequency ratio ϖ as well")
    return RestitutionModel(restitution)


def orbit(
    n: int,
    amplitude: float,
    *,
    restitution: float,
    frequency_ratio: float | None = None,
    release: str = "displacement",
    side: str = "stable",
) -> Orbit:
    """The n-T orbit at the excitation amplitude Λ.

    ``side`` is the side of the saddle-node: the one that is stable next to it,
    or the "unstable" one. For other parameters see :func:`model`.

    Raises
    ------
    NoOrbitError
        If there is none, with the reason.
    ModelError
        If a parameter is out of range.

    Examples
    --------
    >>> orbit(1, 1.0, restitution=0.85, frequency_ratio=10.0)  # doctest: +ELLIPSIS
    SpringDamperOrbit
      n                     1
      law                   SpringDamper(frequency_ratio=10, damping_ratio=0.0516623, ...)
      amplitude             1
      phase                 1.16848
      contact_duration      0.314782
      impact_velocity       -2.99694
      bounce_velocity       2.97147
      apparent_restitution  0.851132
      max_height            5.41098
    """
    return model(restitution, frequency_ratio, release).require_orbit(n, amplitude, Side.of(side))


def limits(
    n: int,
    *,
    restitution: float,
    frequency_ratio: float | None = None,
    release: str = "displacement",
) -> Limits:
    """Saddle-node and period doubling of the n-T orbits.

    Examples
    --------
    >>> found = limits(1, restitution=0.85)
    >>> float(found.saddle_node.amplitude) < float(found.period_doubling.amplitude)
    True
    >>> str(found).splitlines()[0]
    'saddle-node: RestitutionOrbit'
    """
    of = model(restitution, frequency_ratio, release)
    return Limits(of.saddle_node(n), of.period_doubling(n))


def simulate(
    amplitude: float,
    *,
    restitution: float,
    frequency_ratio: float | None = None,
    release: str = "displacement",
    phase: ArrayLike = 0.0,
    velocity: ArrayLike = -math.pi,
    impacts: int = 100,
) -> ImpactSequence:
    """Impacts in order, from a first one at a phase of the table.

    ``velocity`` is that of the ball before the first impact. Arrays follow
    many balls at once.

    Raises
    ------
    ModelError
        If a parameter is out of range.

    Examples
    --------
    >>> simulate(0.0, restitution=0.5, velocity=-4.0, impacts=3).time.tolist()
    [0.0, 4.0, 6.0]
    """
    if not isinstance(impacts, int) or impacts < 1:
        raise ModelError(f"number of impacts {impacts} is not a positive integer")
    of = model(restitution, frequency_ratio, release)
    return of.simulate(amplitude, phase, velocity, impacts)


def law_at_orbit(
    kind: type[ContactLaw],
    restitution: float,
    duration: ArrayLike,
    n: int,
    amplitude: float,
    side: Side = Side.STABLE,
) -> ContactLaw:
    """The contact laws with r and D at the impact speeds of their own n-T orbits at Λ.

    A law whose restitution falls with the speed has *one* r and *one* D only at a speed. To
    compare models, it is given by both at the impact speed of the orbit in question.

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
