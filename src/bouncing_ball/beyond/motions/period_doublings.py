"""Cascades of period doublings of the n-T orbits, for every model.

An orbit with 2ᵏ impacts repeats after 2ᵏ n periods of the table. At its period doubling the orbit
of twice the period branches off (:mod:`bouncing_ball.periodic.branches.switching`). Newton's method
finds the doubling of the new orbit from a point on its branch; many cascades are computed together.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.errors import require
from bouncing_ball.numerics.corrector import newton
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.branches.switching import ahead, twice
from bouncing_ball.periodic.orbits.balls import LAMBDA
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.problem import OrbitEquations
from bouncing_ball.periodic.orbits.stability import Bifurcation
from bouncing_ball.periodic.orbits.steps import PATIENT

FEIGENBAUM = 4.669201609102990
"""Limit of the ratio of successive distances between period doublings of a dissipative map
(M. J. Feigenbaum, 1978)."""
# The doubled orbit is computed at this share of the estimated distance in Λ to its next doubling.
# Nearly elastic impacts nearly preserve areas; the ratio of distances then tends to 8.72 first
# (J. M. Greene et al., 1981), so that the share must be below 4.67/8.72 = 0.54.
_SHARE = 0.4
# The first estimate of the distance is this number times sin φ, because Λ cos φ is constant along a
# family (Eq. 6) and doublings occur at nearly the same Λ sin φ for all n, so that
# dΛ = sin φ d(Λ sin φ). The later estimates follow from Feigenbaum's number.
_FIRST = 0.15
MOST = 8
"""Largest number of doublings that double precision resolves."""


class Cascade(NamedTuple):
    """Orbits at their period doublings, shape (doublings, ...); NaN from the first doubling that
    was not found.

    ``amplitude`` is Λ; ``phase`` and ``velocity`` are φ and δ′ of one of the 2ᵏ impacts, and those
    of the instant in the corrected model. All quantities are dimensionless.
    """

    amplitude: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray

    def ratios(self) -> np.ndarray:
        """Ratios (Λ_k - Λ_{k-1})/(Λ_{k+1} - Λ_k), shape (doublings - 2, ...)."""
        steps = np.diff(self.amplitude, axis=0)
        return steps[:-1] / steps[1:]


def cascade(orbit: Orbit, doublings: int) -> Cascade:
    """Period doublings of the orbits with 1, 2, 4, … impacts, in order.

    Parameters
    ----------
    orbit : Orbit
        The n-T orbits at their period doubling, the first of the cascade: one orbit or an array.
    doublings : int
        Number of period doublings to be computed, including the first, from 1 to 8.

    Raises
    ------
    ModelError
        If the number of doublings is outside its range.

    Examples
    --------
    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> from bouncing_ball.periodic.one_impact import n_t
    >>> found = cascade(n_t.period_doubling(RestitutionModel(0.5), 1), 4)
    >>> found.amplitude.round(6).tolist(), found.ratios().round(2).tolist()
    ([1.526824, 1.667131, 1.696781, 1.703181], [4.73, 4.63])
    """
    require(1 <= doublings <= MOST, doublings, "number of period doublings", f"from 1 to {MOST}")
    existing = np.flatnonzero(np.broadcast_to(orbit.exists, orbit.shape))
    found = np.full((doublings, orbit.size, 3), np.nan)
    if existing.size:
        row = orbit.in_a_row().take(existing)
        found[:, existing] = _at_doublings(row, doublings)
    phase, velocity, amplitude = np.moveaxis(found, -1, 0).reshape(3, doublings, *orbit.shape)
    return Cascade(amplitude, reduce_angle(phase), velocity)


def _at_doublings(row: Orbit, doublings: int) -> np.ndarray:
    """φ, δ′ and Λ at the doublings of a one-dimensional array of orbits, (doublings, orbits, 3)."""
    equations = row.problem(LAMBDA)
    y = row.point(equations)
    phase, velocity = (x[:, 0] for x in equations.states(y))
    amplitude = np.broadcast_to(row.amplitude, phase.shape)
    found = np.full((doublings, row.size, 3), np.nan)
    found[0] = np.stack([phase, velocity, amplitude], axis=-1)
    gap = _FIRST * np.abs(np.sin(phase))
    which = np.arange(row.size)
    before = found[0, :, -1]
    for k in range(1, doublings):
        if not which.size:
            break
        with np.errstate(all="ignore"):
            # The coordinate is arsinh Λ.
            guess = ahead(equations, y, _SHARE * gap / np.hypot(1, before))
            equations, _ = twice(equations, y)
            solved = newton(equations, guess, _condition(equations), PATIENT)
        amplitude = equations.values(solved.point)[LAMBDA]
        step = amplitude - before
        # Λ rises along a cascade; a doubling at or below the previous Λ is that of the old orbit.
        # Feigenbaum's number underestimates a distance by a factor of at most 1.8 in all cascades
        # that were tried; a doubling farther away is that of another orbit.
        good = np.flatnonzero(solved.converged & (step > 0) & ((k == 1) | (step < 2 * gap)))
        which = which[good]
        y = solved.point[good]
        before = amplitude[good]
        gap = step[good] / FEIGENBAUM
        equations = equations.take(good)
        phases, velocities = equations.states(y)
        found[k, which] = np.stack([phases[:, 0], velocities[:, 0], before], axis=-1)
    return found


def _condition(equations: OrbitEquations):
    """The condition that the period of the orbits doubles."""
    return lambda y: equations.bifurcation(Bifurcation.PERIOD_DOUBLING, y)
