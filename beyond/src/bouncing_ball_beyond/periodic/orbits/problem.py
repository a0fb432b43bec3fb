r"""The equations of a periodic orbit with k impacts in m periods of the table.

An impact has the state (θ, v) on the Poincaré section of the model: for most models the phase of
the table and δ′ at the start of the contact. A leg is a contact and the flight after it. It leads
from the state s_i of impact i to P(s_i), which must be the state of the next impact (for one impact
in n periods these are Eqs. 24-26 of the paper)::

    P(s_i) = s_{i+1},    s_{k+1} = s_1 + (2πm, 0)

The landing is the one near the phase θ_{i+1} among the unknowns, found by one step of Newton's
method, and not the first one. The equations therefore are smooth where a flight grazes the table,
and a branch can be followed beyond this point, where no ball follows the orbit. With a landing that
is late by t, the two equations of a leg are ::

    height:    δ′ t = -δ = 0
    velocity:  (δ′ at the landing - v_{i+1}) - δ″ t = δ′ - v_{i+1} = 0

with δ and δ′ at the phase θ_{i+1}, which are smooth where v_{i+1} vanishes, whereas t is not. The
factor δ′ and the matrix in the Jacobian are those at the phase θ_{i+1} as well. Those of the
monodromy are at the landing, so that they depend on θ_i and v_i alone.

After a release by force a contact may resume below the level of the table, with δ + κ δ′ = 0 and
δ′ > 0. Its state is also (θ, δ′), the height is δ + κ δ′, and the factor of t is δ′ + κ δ″. The
section of the corrected model is such a line below the level too, with κ = -t_c(-δ′): a ball
arrives there some time after its landing, also where it lands slowly.

If a model can continue its contacts beyond their first release (:meth:`.Dynamics.depart`),
the duration D_i of each contact is a further unknown. It selects the release near D_i, which
Newton's method finds, and nothing else depends on it: its equation is that D_i is the duration of
the contact. The unknown of a linear contact is arsinh ϖD_i: ϖD_i is about π however stiff the
contact is, so that a point far ahead on a branch along ϖ is predicted well, and 2πϖ m if the ball
hardly leaves the table. The equations of such a model are smooth also where a contact grazes the
release.

The derivatives of these equations and of the durations with respect to the states follow from the
tangent maps of the models, exactly at a solution. Those with respect to a parameter are central
differences, whose error of 1e-9 only affects how fast Newton's method converges and not the
solution. Their step is small against the square of the slowest impact, because the legs change
rapidly next to a grazing impact.

A parameter p enters as arsinh p, which is p for small p and ln 2p for large p, so that steps along
ϖ = 2…1000 are as long as those along Λ. If no parameter varies there are as many unknowns as
equations.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import Any, Self

import numpy as np

from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.numerics.events import Event
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.contacts_and_flights import Impact, Section
from bouncing_ball_beyond.models.deviations import Jacobian
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.periodic.orbits.balls import FREQUENCY, LAMBDA, Balls, dynamics_inside
from bouncing_ball_beyond.periodic.orbits.beside import LegsBeside
from bouncing_ball_beyond.periodic.orbits.legs import Legs, lag_of, landed
from bouncing_ball_beyond.periodic.orbits.stability import multiplier_at, shifted_determinant

# Step of the central differences, near the optimum ε^(1/3).
_DIFFERENCE = 6e-6
# An orbit that is moved by h lands earlier or later by about h/v at a slow impact, which must be
# small against v/a, the time in which its speed changes. The step is therefore shorter by the
# square of this factor times the slowest impact, and by _LEAST at most.
_PER_SLOW = 10.0
_LEAST = 1e-4
# The ends of the range of a phase or a velocity.
_UNLIMITED = np.array([-np.inf, np.inf])
# numpy converts a member of an enumeration in each comparison.
_BOUNCING = int(Status.BOUNCING)
# Number of points at which the legs are known at the same time.
_KEPT = 8


@dataclass(frozen=True)
class OrbitEquations:
    """The equations of orbits with k impacts in m periods: a
    :class:`~bouncing_ball_beyond.inherited.numerics.corrector.Problem`.

    The last axis of y holds θ_1, v_1, θ_2, …, v_k, the durations D_1, …, D_k if they are unknowns,
    as arsinh ϖD_1, …, arsinh ϖD_k of linear contacts,
    and the coordinates arsinh p of the parameters in ``along``. With two of them the
    solutions are a surface.

    Parameters
    ----------
    balls : Balls
        The balls, with the values of the parameters that do not vary; an array of balls has the
        leading shape of y.
    impacts : int
        k.
    turns : array of int
        The whole turns of the table from each phase to the next among the unknowns, shape (..., k):
        the phases themselves stay within a few turns, so that they keep their digits.
    along : tuple of str
        The names of the parameters that vary.
    selects : bool
        Whether the durations of the contacts are unknowns, which select their releases.
    resumes : array of bool
        Which contacts resume below the level of the table, shape (k,); by default none.
    """

    balls: Balls
    impacts: int
    turns: Any
    along: tuple[str, ...] = ()
    selects: bool = False
    resumes: Any = False

    def __getstate__(self) -> dict[str, Any]:
        # Only the fields are pickled: what has been computed holds functions.
        return {field.name: getattr(self, field.name) for field in fields(self)}

    # The unknowns of a branch may be others, such as those of the paper.

    @property
    def equations(self) -> Self:
        """The equations in the unknowns of this class."""
        return self

    def inner(self, y: np.ndarray) -> np.ndarray:
        """The unknowns of this class: y itself."""
        return y

    def outer(self, inner: np.ndarray) -> np.ndarray:
        """The inverse of :meth:`inner`."""
        return inner

    def event(self, event: Event) -> Event:
        """An event as a function of y: the event itself."""
        return event

    @cached_property
    def resuming(self) -> np.ndarray:
        """Which contacts resume, shape (k,)."""
        return np.broadcast_to(self.resumes, (self.impacts,))

    @cached_property
    def _some_resume(self) -> bool:
        """Whether any contact resumes."""
        return bool(self.resuming.any())

    @cached_property
    def periods(self) -> Any:
        """m, of the leading shape of y."""
        return np.sum(self.turns, axis=-1)

    @cached_property
    def _turned(self) -> np.ndarray:
        """The whole turns between the impacts, as angles."""
        return 2 * np.pi * np.asarray(self.turns)

    @property
    def size(self) -> int:
        """N, the number of equations."""
        return self.impacts * (3 if self.selects else 2)

    def states(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """θ and v of the impacts, each of shape (..., k)."""
        state = y[..., : 2 * self.impacts].reshape(*y.shape[:-1], self.impacts, 2)
        return state[..., 0], state[..., 1]

    def values(self, y: np.ndarray) -> dict[str, np.ndarray]:
        """The values of the parameters that vary, each with the leading shape of y."""
        return {name: np.sinh(y[..., self.size + j]) for j, name in enumerate(self.along)}

    def durations(self, y: np.ndarray) -> np.ndarray:
        """The durations of the contacts, shape (..., k); 0 if they are no unknowns."""
        if not self.selects:
            return np.zeros((*y.shape[:-1], self.impacts))
        ends = self._ends(y)
        return np.sinh(ends) / self._clock(self.values(y)) if self.oscillates else ends

    def _ends(self, y: np.ndarray) -> np.ndarray:
        """The unknowns that select the ends of the contacts, shape (..., k)."""
        return y[..., 2 * self.impacts : 3 * self.impacts]

    def _clock(self, varied: dict[str, Any]) -> np.ndarray:
        """ϖ of linear contacts at values of the parameters that vary, with an axis for the
        impacts.
        """
        path = self.balls.path
        balls = self.balls.at(varied) if path is not None and path.name in varied else self.balls
        values = {**balls.model.numbers(), **varied}
        return np.asarray(values["frequency_ratio"])[..., np.newaxis]

    @cached_property
    def oscillates(self) -> bool:
        """Whether the unknown durations are those of linear contacts."""
        return self.selects and self.balls.model.dynamics(1.0).contact is not None

    def point(
        self, phase: np.ndarray, velocity: np.ndarray, duration: np.ndarray, **values: Any
    ) -> np.ndarray:
        """y of orbits from θ, v and D, shape (..., k), and the parameters that vary."""
        state = np.stack([phase, velocity], axis=-1)
        state = state.reshape(*phase.shape[:-1], 2 * self.impacts)
        coordinates = [np.arcsinh(np.asarray(values[name])) for name in self.along]
        parts = [state]
        if self.selects:
            clocked = self.oscillates
            parts.append(np.arcsinh(duration * self._clock(values)) if clocked else duration)
        parts.extend(x[..., np.newaxis] for x in coordinates)
        leading = np.broadcast_shapes(*(x.shape[:-1] for x in parts))
        return np.concatenate([np.broadcast_to(x, (*leading, x.shape[-1])) for x in parts], axis=-1)

    @cached_property
    def _kept(self) -> dict[tuple[tuple[int, ...], bytes], LegsBeside]:
        # The legs at the last points, in order. A step along a branch evaluates the residual, the
        # Jacobian and the events at the same points.
        return {}

    def _known(self, y: np.ndarray, directions: int) -> LegsBeside:
        """The legs at y and at points beside it in at least so many directions."""
        place = y.shape, y.tobytes()
        known = self._kept.get(place)
        if known is None or len(known.lengths) < directions:
            points, lengths = self._points_around(y, directions)
            known = LegsBeside(points, lengths, self._legs(points), self.selects)
            self._kept[place] = known
            if len(self._kept) > _KEPT:
                del self._kept[next(iter(self._kept))]
        return known

    def legs(self, y: np.ndarray) -> Legs:
        """The legs of the orbits at points y of shape (..., N + parameters)."""
        return self._known(y, 0).here

    def compared(self, y: np.ndarray, everywhere: bool = False) -> LegsBeside:
        """The legs at y and at points beside it.

        They are y itself, y moved by ± the step of the differences in each parameter, and, if
        ``everywhere`` is set, y with all θ or all v moved: a leg depends on the state at its start
        alone. The latter may be there also if it is not set.
        """
        return self._known(y, len(self.along) + (2 if everywhere else 0))

    def dynamics(self, y: np.ndarray) -> tuple[Dynamics | None, np.ndarray]:
        """The dynamics of the legs in a row, and which legs are inside the ranges."""
        leading = y.shape[:-1]
        row = self.balls if self._one_ball else self._row(leading)
        if not self.along:
            return row.dynamics(), np.ones(math.prod(leading) * self.impacts, dtype=bool)
        varied = {name: np.repeat(x.ravel(), self.impacts) for name, x in self.values(y).items()}
        return dynamics_inside(row, varied, self._bounds)

    @cached_property
    def _row(self) -> Callable[[tuple[int, ...]], Balls]:
        """The balls of the legs in a row, for a leading shape of y."""
        return lru_cache(maxsize=_KEPT)(lambda leading: self.balls.row(leading, self.impacts))

    @cached_property
    def _one_ball(self) -> bool:
        """Whether one ball serves all orbits, up to the parameters that vary."""
        return not self.balls.model.shape and not np.ndim(self.balls.amplitude)

    def amplitude(self, y: np.ndarray) -> np.ndarray:
        """Λ of the orbits, of the leading shape of y."""
        varied = self.values(y)
        moved = self.balls.path is not None and self.balls.path.name in varied
        lam = self.at(y).amplitude if moved else varied.get(LAMBDA, self.balls.amplitude)
        return np.broadcast_to(lam, y.shape[:-1])

    @property
    def remembered(self) -> tuple[str, ...]:
        """The names of the parameters that vary as an orbit has them: the path of a user is known
        to the branch alone, and its orbits have the parameters that change along it.
        """
        path = self.balls.path
        found: list[str] = []
        for name in self.along or (LAMBDA,):
            of_user = path is not None and name == path.name != FREQUENCY
            found += path.moves(self.balls) if path is not None and of_user else [name]
        return tuple(found)

    def at(self, y: np.ndarray) -> Balls:
        """The balls with the parameters of the orbits."""
        return self.balls.at(self.values(y)) if self.along else self.balls

    def fixed(self, y: np.ndarray) -> tuple[Self, np.ndarray]:
        """The problem with no parameter that varies, whose balls are those at y, and the unknowns.

        It costs less to solve, because a derivative by a parameter needs two more legs.
        """
        return replace(self, balls=self.at(y), along=()), y[..., : self.size]

    def take(self, which: Any) -> Self:
        """The problem of some orbits of a row; that of a single orbit is its own."""
        turns = np.asarray(self.turns)
        if turns.ndim == 1 and self._one_ball:
            return self
        return replace(
            self,
            balls=self.balls.take(which),
            turns=turns[which] if turns.ndim > 1 else turns,
        )

    def _section(self, dynamics: Dynamics, shape: tuple[int, ...], after: bool) -> Section:
        """The section of the impacts in a row, or of those ``after`` each of them."""
        if not self._some_resume:
            return dynamics.section()
        resumes = _of_next(self.resuming) if after else self.resuming
        return dynamics.section(lag_of(dynamics, np.broadcast_to(resumes, shape).ravel()))

    def impact(self, dynamics: Dynamics, y: np.ndarray) -> Impact:
        """The impacts of the orbits in a row."""
        phase, velocity = self.states(y)
        section = self._section(dynamics, phase.shape, after=False)
        return section.impact(phase.ravel(), velocity.ravel())

    def intervals(self, y: np.ndarray) -> np.ndarray:
        """θ_{i+1} - θ_i, shape (..., k)."""
        phase, _ = self.states(y)
        return (_of_next(phase) - phase) + self._turned

    @np.errstate(all="ignore")
    def _legs(self, y: np.ndarray) -> Legs:
        dynamics, inside = self.dynamics(y)
        shape = (*y.shape[:-1], self.impacts)
        if dynamics is None:
            return Legs.unknown(shape)
        interval = self.intervals(y).ravel()
        impact = self.impact(dynamics, y)
        clock = None
        near = self._ends(y) if self.selects else np.zeros(shape)
        if self.oscillates:
            clock = np.broadcast_to(dynamics.law.frequency_ratio, interval.shape).reshape(shape)
            near = np.sinh(near) / clock
        departure = dynamics.depart(impact, near=near.ravel())
        bouncing = inside & (departure.status == _BOUNCING)
        duration = np.where(bouncing, departure.duration, np.nan)
        section = self._section(dynamics, shape, after=True)
        landing = landed(section, impact, departure, duration, interval)
        _, velocity = self.states(y)
        residual = np.empty((*shape, 2))
        residual[..., 0] = -landing.height.reshape(shape)
        residual[..., 1] = landing.velocity.reshape(shape) - _of_next(velocity)
        return Legs(
            residual=residual,
            duration=duration.reshape(shape),
            clock=clock,
            velocity=landing.rate.reshape(shape),
            acceleration=landing.acceleration.reshape(shape),
            dynamics=dynamics,
            impact=impact,
            departure=departure,
            landing=landing,
        )

    def residual(self, y: np.ndarray) -> np.ndarray:
        """The two equations of each leg, and the errors of the durations, shape (..., N).

        For one impact in n periods the paper has, with the heights Z in contact and z in flight::

            Z′(τ_b) = z′_b                      (24)
            z(τ_2) = Λ sin(τ_2 + φ)             (25)
            z′(τ_2) = z′_2                      (26)

        where τ_2 = 2πn and z′_2 = z′_i. The flight begins with the velocity with which the contact
        ends, so that Eq. 24 holds. The first equation of the leg is -δ(τ_2) = 0, which is Eq. 25,
        and the second δ′(τ_2) - v = 0 with v = z′_i - Λ cos φ, which is Eq. 26; ``landed`` computes
        δ and δ′. The error of the duration is D - τ_b, with τ_b by Eq. 23.
        """
        legs = self.compared(y).legs
        here = legs.residual[0].reshape(*y.shape[:-1], -1)
        if not self.selects:
            return here
        return np.concatenate([here, self._ends(y) - legs.ends[0]], axis=-1)

    def _points_around(self, y: np.ndarray, directions: int) -> tuple[np.ndarray, list[np.ndarray]]:
        """The points of :meth:`compared` in the first of its directions, and the distances of each
        pair of them.

        Points beside y do not leave the ranges of the parameters. Where y itself is outside of
        them, they are equal to y.
        """
        points = np.repeat(y[np.newaxis], 1 + 2 * directions, axis=0)
        if not directions:
            return points, []
        columns = [slice(j, j + 1) for j in range(self.size, y.shape[-1])]
        columns += [slice(0, 2 * self.impacts, 2), slice(1, 2 * self.impacts, 2)]
        limits = [*self._limits, _UNLIMITED, _UNLIMITED]
        ranges = zip(columns[:directions], limits[:directions], strict=True)
        step = self._step(y)
        lengths = []
        for j, (column, (low, high)) in enumerate(ranges):
            here = y[..., column]
            right = here + step
            left = here - step
            if not ((left >= low) & (right <= high)).all():
                inside = (here >= low) & (here <= high)
                right = np.where(inside, np.minimum(right, high), here)
                left = np.where(inside, np.maximum(left, low), here)
            points[1 + 2 * j, ..., column] = right
            points[2 + 2 * j, ..., column] = left
            lengths.append(right - left)
        return points, lengths

    @cached_property
    def _bounds(self) -> dict[str, tuple[float, float]]:
        """The least and the greatest values of the parameters that vary."""
        return {name: self.balls.bounds(name) for name in self.along}

    @cached_property
    def _limits(self) -> list[np.ndarray]:
        """The least and the greatest coordinates of these parameters."""
        return [np.arcsinh(ends) for ends in self._bounds.values()]

    def _step(self, y: np.ndarray) -> np.ndarray:
        """The steps of the central differences, shape (..., 1)."""
        _, velocity = self.states(y)
        # The whole step where the speed is not known.
        slowest = np.fmin(np.abs(velocity).min(axis=-1, keepdims=True) * _PER_SLOW, 1.0)
        return _DIFFERENCE * np.maximum(slowest * slowest, _LEAST)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Jacobian of the residual, shape (..., N, N + parameters)."""
        return self.compared(y).jacobian

    def equations_at(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The residual and its Jacobian, which is square if no parameter varies."""
        return self.residual(y), self.jacobian(y)

    def matrices(self, y: np.ndarray) -> np.ndarray:
        """DP of the legs, shape (..., k, 2, 2)."""
        return self.compared(y).here.matrices

    def monodromy(self, y: np.ndarray) -> Jacobian:
        """The derivative of the map Pᵏ at the first impact; entries of the leading shape of y."""
        product = self.compared(y).here.monodromy
        return Jacobian(*(product[..., i, j] for i, j in ((0, 0), (0, 1), (1, 0), (1, 1))))

    def trace_and_determinant(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Trace and determinant of the monodromy, each with the leading shape of y."""
        return self.compared(y).here.trace_and_determinant

    def bifurcation(self, kind: Bifurcation, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The test function det(M - μ) of a bifurcation, μ = ±1, and its gradient.

        The derivatives of the matrices of the legs are central differences. The results have the
        shapes (...,) and (..., N + parameters).
        """
        compared = self.compared(y, everywhere=True)
        matrices = compared.legs.matrices
        value, weights = shifted_determinant(matrices[0], multiplier_at(kind))
        # tr(W_i dM_i) for each leg.
        change = [
            np.einsum("...ij,...ji->...", weights, right - left)
            for right, left in zip(matrices[1::2], matrices[2::2], strict=True)
        ]
        return value, self.gradient(y, np.array(change))

    def gradient(self, y: np.ndarray, change: np.ndarray) -> np.ndarray:
        """The gradient of a sum of a function over the legs, shape (..., N + parameters).

        ``change`` are the differences of the function between the two points beside y of each pair,
        everywhere (:meth:`compared`), shape (pairs of points, ..., k).
        """
        lengths = self.compared(y, everywhere=True).lengths
        parameters = len(self.along)
        gradient = np.zeros(y.shape)
        for j in range(parameters):
            gradient[..., self.size + j] = change[j].sum(axis=-1) / lengths[j][..., 0]
        for j in range(2):
            column = slice(j, 2 * self.impacts, 2)
            gradient[..., column] = change[parameters + j] / lengths[parameters + j]
        return gradient


def _of_next(values: np.ndarray) -> np.ndarray:
    """Values of the impacts of orbits, shape (..., k), for the impact after each of them."""
    return np.concatenate([values[..., 1:], values[..., :1]], axis=-1)
