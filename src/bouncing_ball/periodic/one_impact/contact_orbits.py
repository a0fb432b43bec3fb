r"""The n-T orbits of contacts of finite duration on another table, beside a drag or a spring.

No closed form is known. Newton's method on the equations of the model starts from the orbits of the
rigid ball in the same setting, whose r is that of the model's impact: with the delay t_c and the
duration D of its signature, the contact starts at ψ - t_c, earlier than the instant at ψ, and lasts
for D. Where these starts lead to no orbit, and for all orbits at one Λ, further starts are at even
phases. Such a search may miss an orbit; :func:`bouncing_ball.orbit_of_motion` and
:func:`bouncing_ball.follow` find others.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.model import Model
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.numerics.corrector import NewtonSettings, solve
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.one_impact.other_settings import NO_LIMITS, OtherOrbits
from bouncing_ball.periodic.one_impact.start import restitution_speed
from bouncing_ball.periodic.orbits.impacts import check_index
from bouncing_ball.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball.periodic.orbits.stability import Bifurcation, Side

_SETTINGS = NewtonSettings(max_iterations=25, longest=0.5)
# Starts in one period of the highest harmonic of the table.
_STARTS = 8
# Orbits whose phases and velocities differ by less than this are one.
_SAME = 1e-6


@dataclass(frozen=True)
class OrbitsOfContact:
    """The n-T orbits of balls on contacts in another setting than that of the paper."""

    model: Model

    is_complete: ClassVar[bool] = False

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where none was found.

        If several orbits are on this side, the first admissible one that is stable is chosen, and
        otherwise the first admissible or the first one.
        """
        check_index(n)
        shape = np.broadcast_shapes(np.shape(n), np.shape(amplitude), self.model.shape)
        index = np.broadcast_to(n, shape)
        lam = np.broadcast_to(np.asarray(amplitude, dtype=float), shape)
        columns = np.full((3, *shape), np.nan)
        models = self.model.flat(shape)
        for k, place in enumerate(np.ndindex(shape)):
            if not lam[place] > 0:
                continue
            one = models.take(k)
            for even in (False, True):
                found = _found(one, int(index[place]), float(lam[place]), even)
                best = _best(found, side)
                if best is not None:
                    columns[(slice(None), *place)] = best
                    break
        phase, duration, velocity = columns
        return Orbit.of(self.model, index, lam, phase, duration, velocity)

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """The n-T orbits of a single model at one Λ, in a row, in order of contact duration."""
        check_index(n)
        found = _found(self.model, n, amplitude, even=True)
        if found is None:
            none = np.empty(0)
            return Orbit.of(self.model, n, none, none, none, none)
        return found[np.argsort(found.contact_duration, kind="stable")]

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """No orbit: saddle-nodes are found by :func:`bouncing_ball.follow`."""
        return Orbit.of(self.model, n, np.nan, np.nan)

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """Raise an error: period doublings are found by :func:`bouncing_ball.follow`."""
        raise ModelError(NO_LIMITS)


def _best(found: Orbit | None, side: Side) -> tuple[float, float, float] | None:
    """φ, D and z′_i of the orbit of a row that is chosen on a side."""
    if found is None:
        return None
    on_stable_side = Bifurcation.SADDLE_NODE.test(*found.trace_and_determinant()) > 0
    here = np.flatnonzero(on_stable_side == (side is Side.STABLE))
    if not here.size:
        return None
    rank = np.atleast_1d(2 * found.is_admissible() + found.is_stable())[here]
    k = here[np.argmax(rank)]
    return found.phase[k], found.contact_duration[k], found.impact_velocity[k]


def _found(model: Model, n: int, amplitude: float, even: bool) -> Orbit | None:
    """The orbits of a single model to which Newton's method leads, in a row; None if there is none.

    With ``even`` also from starts at even phases, from which only orbits that a ball follows are
    taken.
    """
    speed, instant = restitution_speed(n, model)
    rigid = OtherOrbits(RestitutionModel(float(instant.restitution), model.place))
    near = rigid.orbits(n, amplitude)
    found = [_solved(model, n, amplitude, near.phase, near.impact_velocity, instant)]
    if even:
        count = _STARTS * int(model.place.waveform.orders[-1])
        phase = 2 * np.pi * (np.arange(count) + 0.5) / count - np.pi
        start = amplitude * model.place.waveform.velocity(phase) - float(speed)
        more = _solved(model, n, amplitude, phase, start, instant)
        if more is not None:
            followed = np.flatnonzero(np.atleast_1d(more.is_admissible()))
            found.append(more[followed] if followed.size else None)
    rows = [each for each in found if each is not None]
    return _distinct(model, n, amplitude, rows) if rows else None


def _solved(
    model: Model,
    n: int,
    amplitude: float,
    phase: np.ndarray,
    velocity: np.ndarray,
    instant: Instant,
) -> Orbit | None:
    """The orbits near instants with these phases and velocities of the ball before them."""
    if not phase.size:
        return None
    delay = float(instant.delay)
    # In the time t_c before the instant the ball falls faster by t_c.
    guess = Orbit.of(
        model,
        n,
        np.full(phase.shape, amplitude),
        phase - delay,
        float(instant.duration),
        velocity + delay,
    )
    problem = guess.problem()
    with np.errstate(all="ignore"):
        found = solve(problem.equations_at, guess.point(problem), _SETTINGS)
    good = np.flatnonzero(found.converged & np.isfinite(found.point).all(axis=-1))
    if not good.size:
        return None
    orbit = orbit_of_point(problem.take(good), found.point[good])
    lands = (orbit.contact_duration > 0) & (orbit.flight_time > 0)
    lands &= orbit.relative_impact_velocity < 0
    return orbit[np.flatnonzero(lands)] if lands.any() else None


def _distinct(model: Model, n: int, amplitude: float, rows: list[Orbit]) -> Orbit:
    """The orbits of several rows as one row in which each stands once."""
    names = ("phase", "contact_duration", "impact_velocity")
    columns = [np.concatenate([getattr(row, name) for row in rows]) for name in names]
    kept: list[int] = []
    for k in range(columns[0].size):
        apart = (
            np.abs(reduce_angle(columns[0][j] - columns[0][k]))
            + np.abs(columns[2][j] - columns[2][k])
            for j in kept
        )
        if all(distance > _SAME for distance in apart):
            kept.append(k)
    phase, duration, velocity = (column[kept] for column in columns)
    lam = np.full(len(kept), amplitude)
    return Orbit.of(model, n, lam, phase, duration, velocity)
