r"""The n-T orbits of contacts of finite duration on another table, beside a drag or a spring.

No closed form is known. Newton's method on the equations of the model starts from the orbits of the
rigid ball in the same setting, whose r is that of the model's impact: with the delay t_c and the
duration D of its signature, the contact starts at ψ - t_c, earlier than the instant at ψ, and lasts
for D. Where these starts lead to no orbit, and for all orbits at one Λ, further starts are at even
phases. Such a search may miss an orbit; :func:`bouncing_ball.orbit_of_motion` and
:func:`bouncing_ball.follow` find others.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.instant import Instant
from bouncing_ball.models.model import Model
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.numerics.corrector import NewtonSettings, solve
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.one_impact.orbits_of_model import OrbitsOneByOne
from bouncing_ball.periodic.one_impact.other_settings import OtherOrbits
from bouncing_ball.periodic.one_impact.start import restitution_speed
from bouncing_ball.periodic.orbits.orbit import Orbit, orbit_of_point

_SETTINGS = NewtonSettings(max_iterations=25, longest=0.5)
# Starts in one period of the highest harmonic of the table.
_STARTS = 8
# Orbits whose phases and velocities differ by less than this are one.
_SAME = 1e-6


class OrbitsOfContact(OrbitsOneByOne):
    """The n-T orbits of balls on contacts in another setting than that of the paper.

    If several are on a side, the first admissible one that is stable is chosen, and otherwise the
    first admissible or the first one.
    """

    def rows(self, model: Model, n: int, amplitude: float) -> Iterator[Orbit]:
        """The orbits to which Newton's method leads from those of the rigid ball, and then also
        from starts at even phases, of which only orbits that a ball follows are taken.
        """
        speed, instant = restitution_speed(n, model)
        rigid = OtherOrbits(RestitutionModel(float(instant.restitution), model.place))
        near = rigid.orbits(n, amplitude)
        first = _solved(model, n, amplitude, near.phase, near.impact_velocity, instant)
        yield _distinct(model, n, amplitude, [first])
        count = _STARTS * int(model.place.waveform.orders[-1])
        phase = 2 * np.pi * (np.arange(count) + 0.5) / count - np.pi
        start = amplitude * model.place.waveform.velocity(phase) - float(speed)
        more = _solved(model, n, amplitude, phase, start, instant)
        followed = np.flatnonzero(more.is_admissible()) if more.size else slice(None)
        yield _distinct(model, n, amplitude, [first, more[followed]])

    def rank(self, row: Orbit) -> np.ndarray:
        """Admissible orbits come first, and stable ones among them."""
        return 2 * row.is_admissible() + row.is_stable()

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """No orbit: saddle-nodes are found by :func:`bouncing_ball.follow`."""
        return Orbit.of(self.model, n, np.nan, np.nan)


def _solved(
    model: Model,
    n: int,
    amplitude: float,
    phase: np.ndarray,
    velocity: np.ndarray,
    instant: Instant,
) -> Orbit:
    """The orbits near instants with these phases and velocities of the ball before them, in a
    row.
    """
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
    if not guess.size:
        return guess
    problem = guess.problem()
    with np.errstate(all="ignore"):
        found = solve(problem.equations_at, guess.point(problem), _SETTINGS)
    good = np.flatnonzero(found.converged & np.isfinite(found.point).all(axis=-1))
    if not good.size:
        return guess[good]
    orbit = orbit_of_point(problem.take(good), found.point[good])
    lands = (orbit.contact_duration > 0) & (orbit.flight_time > 0)
    lands &= orbit.relative_impact_velocity < 0
    return orbit[np.flatnonzero(lands)]


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
