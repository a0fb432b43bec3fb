"""Orbits on the contact law that has a given restitution and duration at their impacts."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.corrector import checked, solve
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_beyond.periodic.orbits.balls import Balls
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.steps import OF_A_ROUND

# The largest number of rounds that compute the law and the orbit in turn. At given r and D the
# speed hardly depends on the law, and after a secant step less than a hundredth of the last step
# is left.
_ROUNDS = 20
_SETTLED = 1e-10


def orbit_of_law(
    kind: type[ContactLaw],
    restitution: float,
    duration: ArrayLike,
    n: int,
    amplitude: float,
    side: Side = Side.STABLE,
) -> Orbit:
    """The n-T orbits at Λ on contacts whose free impacts have r and D at the orbit's impact speed.

    The restitution and the duration of a law may depend on the speed. To compare models, r and D
    are therefore prescribed at the impact speed of the orbit in question. The search answers at
    which speed v the orbit hits the table on the law that has r and D at v, by a secant iteration;
    :func:`~bouncing_ball_beyond.models.laws.law_of_impact.law_of_impact` has the law of each v. The
    unknowns of an orbit are the phase and δ′ of the impact, whatever the law is, so that the orbits
    of one round are the guesses of the next.

    Parameters
    ----------
    kind : type of ContactLaw
    restitution : float
        r in (0, 1].
    duration : array_like
        D; there is one law for each D.
    n : int
        Index of the family.
    amplitude : float
        Λ.
    side : Side

    Returns
    -------
    Orbit
        Has the shape of ``duration``; its ``law`` is the contact law.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    ModelError
        If no law of this kind has these r and D.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji
    >>> orbit = orbit_of_law(Tsuji, 0.65, 0.1, 1, 1.0)
    >>> round(float(orbit.law.signature(-orbit.relative_impact_velocity).duration), 12)
    0.1
    """
    side = Side(side)
    taken = np.asarray(duration, dtype=float)
    speed = np.full_like(taken, rigid_speed(n, restitution))
    before = missed_before = np.full_like(taken, np.nan)
    law = law_of_impact(kind, restitution, taken, speed)
    orbit = n_t.orbit(ContactModel(law), n, amplitude, side)
    problem, y = equations_of(orbit)
    for _ in range(_ROUNDS):
        lost = np.flatnonzero(np.isnan(y).any(axis=-1))
        if lost.size:
            n_t.require_orbit(ContactModel(law.take(lost[0])), n, amplitude, side)
        missed = -problem.states(y)[1][..., 0] - speed
        slope = np.full_like(taken, -1.0)
        np.divide(missed - missed_before, speed - before, out=slope, where=speed != before)
        before = speed
        missed_before = missed
        speed = speed - missed / np.where(np.abs(slope + 1) < 0.5, slope, -1.0)
        law = law_of_impact(kind, restitution, taken, speed)
        problem = replace(problem, balls=Balls(ContactModel(law), amplitude))
        found = checked(solve(problem.equations_at, y, OF_A_ROUND), problem.residual)
        y = np.where(found.converged[..., np.newaxis], found.point, np.nan)
        if np.all((np.abs(missed) <= _SETTLED * speed) & found.converged):
            return orbit_of_point(problem, y)
    raise NoOrbitError(
        f"no {n}-T orbit at Λ = {amplitude:g} whose impact has r = {restitution:g} and "
        f"D = {float(taken.flat[0]):g} was found for {kind.name}"
    )
