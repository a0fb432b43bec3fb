"""Cascades of period doublings of the n-T orbits, for every model.

An orbit with m = 2ᵏ impacts repeats after m n periods of the table. It is a fixed point of the
m-th iterate of the map P from impact to impact. Its period doubles where a multiplier is -1:

    Pᵐ(s) = s,    1 + tr M + det M = 0,    M = DPᵐ(s).

Newton's method solves these equations together for the orbit and Λ. At the doubling, the orbit of
twice the period branches off along the eigenvector of that multiplier. Because this orbit is
attracting, iterating the map leads to a point near it.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.errors import require
from bouncing_ball.numerics.corrector import NewtonSettings, solve
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.motion.deviations import Jacobian
from bouncing_ball.paper.motion.sequence import Status
from bouncing_ball.paper.orbits.orbit import Orbit

FEIGENBAUM = 4.669201609102990
"""Limit of the ratio of successive distances between period doublings of a dissipative map
(M. J. Feigenbaum, 1978)."""
# Step of the central differences; it affects only the convergence of Newton's method.
_DIFFERENCE = 1e-6
_SETTINGS = NewtonSettings(max_iterations=25, longest=0.3)
# The doubled orbit is computed at this share of the estimated distance in Λ to its next doubling.
# Nearly elastic impacts nearly preserve areas; the ratio of distances then tends to 8.72 first
# (J. M. Greene et al., 1981), so that the share must be below 4.67/8.72 = 0.54.
_SHARE = 0.4
# The first estimate of the distance is this number times sin φ, because Λ cos φ is constant along a
# family (Eq. 6) and doublings occur at nearly the same Λ sin φ for all n, so that
# dΛ = sin φ d(Λ sin φ). The later estimates follow from Feigenbaum's number.
_FIRST = 0.15
# The map starts beside the old orbit, at this number times the square root of the distance in Λ.
_ASIDE = 0.2
# The map is iterated over this number of impacts, and at least this number of turns.
_IMPACTS = 48
_TURNS = 20
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


@dataclass(frozen=True)
class Turns:
    """Orbits with m impacts in m n periods at their period doublings: equations for y = (φ, δ′, Λ).

    Parameters
    ----------
    orbits : Orbit
        n-T orbits with the law and the mean number n of table periods from one impact to the next:
        one for all, or a row with one entry for each point.
    impacts : int
        m, the number of impacts in one turn.
    """

    orbits: Orbit
    impacts: int

    def after(self, y: np.ndarray, differentiate: bool = True) -> tuple[Any, Any, Any, Jacobian]:
        """φ, δ′ and the time after m impacts, and M, which is only computed with ``differentiate``;
        each has the leading shape of y, and is NaN where the ball is not released before.
        """
        phase, velocity, amplitude = np.moveaxis(y, -1, 0)
        # Newton's steps may lead to Λ < 0, where no doubling is accepted.
        dynamics = self.orbits.dynamics(self.orbits.law, np.abs(amplitude))
        dynamics, (phase, velocity), shape = dynamics.in_a_row(phase, velocity)
        impact = dynamics.at_section(phase, velocity)
        change = Jacobian.identity(phase.size)
        time = np.zeros(phase.size)
        moving = np.arange(phase.size)
        found = np.full((7, phase.size), np.nan)
        for _ in range(self.impacts):
            departure = dynamics.depart(impact, differentiate=differentiate)
            going = np.flatnonzero(departure.status == Status.BOUNCING)
            if going.size < moving.size:
                rows = impact, departure, change, time, moving
                dynamics, impact, departure, change, time, moving = dynamics.kept(going, *rows)
            after, passed = dynamics.fly(departure)
            if differentiate:
                change = dynamics.jacobian(impact, departure, after, passed).after(change)
            # The time between two instants differs from the time between two contacts.
            start_phase, _ = dynamics.section(impact)
            end_phase, end_velocity = dynamics.section(after)
            time += passed + reduce_angle(end_phase - start_phase - passed)
            impact = after
        found[:, moving] = end_phase, end_velocity, time, *change
        phase, velocity, time, *entries = found.reshape(7, *shape)
        return phase, velocity, time, Jacobian(*entries)

    def _late(self, turned: np.ndarray, time: np.ndarray) -> np.ndarray:
        """How much later than after m n periods of the table a turn ends.

        It is the angle by which the phase has turned, apart from whole turns, because the time of
        up to 256 periods has three digits less.
        """
        late = time - 2 * np.pi * np.asarray(self.orbits.n) * self.impacts
        turned = reduce_angle(turned)
        return turned + 2 * np.pi * np.rint((late - turned) / (2 * np.pi))

    def system(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The differences in time and velocity between Pᵐ(s) and s, and 1 + tr M + det M, shape
        (..., 3), with their Jacobian; central differences give the entries that do not follow
        from M.
        """
        steps = _DIFFERENCE * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
        leading_axes = tuple(range(1, y.ndim))
        moved = y + np.expand_dims(steps, leading_axes)
        phase, velocity, time, m = self.after(moved)
        late = self._late(phase - moved[..., 0], time)
        doubling = 1 + m.a + m.d + m.a * m.d - m.b * m.c
        values = np.stack([late, velocity - moved[..., 1], doubling], axis=-1)
        matrix = np.moveaxis(values[1:4] - values[4:], 0, -1) / (2 * _DIFFERENCE)
        by_state = np.stack([entry[0] for entry in m], axis=-1).reshape(*y.shape[:-1], 2, 2)
        matrix[..., :2, :2] = by_state - np.eye(2)
        return values[0], matrix


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
    >>> from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
    >>> found = cascade(RestitutionModel(0.5).period_doubling(1), 4)
    >>> found.amplitude.round(6).tolist(), found.ratios().round(2).tolist()
    ([1.526824, 1.667131, 1.696781, 1.703181], [4.73, 4.63])
    """
    require(1 <= doublings <= MOST, doublings, "number of period doublings", f"from 1 to {MOST}")
    existing = np.flatnonzero(np.broadcast_to(orbit.exists, orbit.shape))
    found = np.full((doublings, orbit.size, 3), np.nan)
    if existing.size:
        row = orbit.flat(orbit.shape).take(existing)
        found[:, existing] = _followed(row, doublings)
    phase, velocity, amplitude = np.moveaxis(found, -1, 0).reshape(3, doublings, *orbit.shape)
    return Cascade(amplitude, reduce_angle(phase), velocity)


def _followed(row: Orbit, doublings: int) -> np.ndarray:
    """Points y at the doublings of a one-dimensional array of orbits, (doublings, orbits, 3)."""
    dynamics = row.dynamics(row.law, row.amplitude)
    dynamics, start, _ = dynamics.in_a_row(row.phase, row.relative_impact_velocity)
    phase, velocity = dynamics.section(dynamics.start(*start))
    y = np.stack(np.broadcast_arrays(phase, velocity, row.amplitude), axis=-1)
    found = np.full((doublings, *y.shape), np.nan)
    found[0] = y
    gap = _FIRST * np.abs(np.sin(phase))
    which = np.arange(len(y))
    for k in range(1, doublings):
        old = Turns(row, 2 ** (k - 1))
        turns = Turns(row, 2**k)
        solved = solve(turns.system, _doubled(old, turns, y, _SHARE * gap), _SETTINGS)
        step = solved.point[:, -1] - y[:, -1]
        # Λ rises along a cascade; a doubling at or below the previous Λ is that of the old orbit.
        # Feigenbaum's number underestimates a distance by a factor of at most 1.8 in all cascades
        # that were tried; a doubling farther away is that of another orbit.
        good = np.flatnonzero(solved.converged & (step > 0) & ((k == 1) | (step < 2 * gap)))
        row = row.take(good)
        which = which[good]
        y = solved.point[good]
        found[k, which] = y
        gap = step[good] / FEIGENBAUM
    return found


def _doubled(old: Turns, turns: Turns, y: np.ndarray, above: np.ndarray) -> np.ndarray:
    """Points of the attracting orbits of twice the period, at Λ a little above the doubling."""
    _, _, _, change = old.after(y)
    # The eigenvector of an eigenvalue μ is (μ - d, c), here with μ = -1.
    along = np.stack([-1 - change.d, change.c], axis=-1)
    length = np.hypot(along[..., 0], along[..., 1])
    aside = _ASIDE * np.sqrt(above) / length
    y = y + np.concatenate([along * aside[:, np.newaxis], above[:, np.newaxis]], axis=-1)
    for _ in range(max(_TURNS, _IMPACTS // turns.impacts)):
        phase, velocity, _, _ = turns.after(y, differentiate=False)
        moved = np.stack([reduce_angle(phase), velocity], axis=-1)
        y[:, :2] = np.where(np.isnan(moved), y[:, :2], moved)
    return y
