"""The impacts of periodic orbits, and what follows from them and from the flights between them.

An orbit has k impacts in m periods of the table. An impact is the start of a contact, at the phase
φ of the table. The contact lasts for D = τ_b, and the flight after it ends at the next impact.
Heights and velocities are absolute unless they are called relative, which means relative to the
table: δ = z - w.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.arrays import Batch, blocks
from bouncing_ball_beyond.models.attributes import Suggesting
from bouncing_ball_beyond.models.contacts_and_flights import Impact
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls, Path
from bouncing_ball_beyond.periodic.orbits.legs import (
    lag_of,
    selects_ends,
)
from bouncing_ball_beyond.periodic.orbits.paths import balls_along
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

# The fields with an entry for each impact.
_OF_IMPACTS = ("turns", "phases", "velocities", "durations")
# Number of orbits whose legs are in memory at the same time.
_LEGS = 8192


def _comparable(value: Any) -> Any:
    """A value as one that can be compared with ``==``: an array as its shape and its entries."""
    if isinstance(value, np.ndarray):
        return value.shape, tuple(value.ravel().tolist())
    return value


# What the house itself needs of orbits, which is not among the names that an editor completes.
_INTERNAL = {"check_shape", "flat", "of", "own_equations", "resumes", "starts", "take", "turns"}


@dataclass(frozen=True, repr=False)
class OrbitImpacts(Suggesting, Batch):
    """The impacts of orbits with k impacts in m periods of one model: see
    :class:`~bouncing_ball_beyond.periodic.orbits.orbit.Orbit`, whose fields and shapes these are.
    """

    model: Model
    amplitude: Any
    turns: Any
    phases: np.ndarray
    velocities: np.ndarray
    durations: np.ndarray
    resumes: Any = False
    kind: str = ""
    along: tuple[str, ...] = (LAMBDA,)

    @classmethod
    def of(
        cls,
        model: Model,
        n: ArrayLike,
        amplitude: ArrayLike,
        phase: ArrayLike,
        contact_duration: ArrayLike = 0.0,
        impact_velocity: ArrayLike | None = None,
    ) -> Self:
        """n-T orbits with one impact; there is no orbit where the phase is NaN.

        Λ and φ suffice for an impact without duration, because z′_i is then -nπ.
        """
        if impact_velocity is None:
            impact_velocity = -np.asarray(n) * np.pi
        missing = np.where(np.isnan(phase), np.nan, 0.0)
        lam, phi, duration, velocity, _ = np.broadcast_arrays(
            np.asarray(amplitude, dtype=float),
            np.asarray(phase, dtype=float),
            contact_duration + missing,
            impact_velocity + missing,
            n,
        )
        return cls(
            model=model,
            amplitude=lam if lam.ndim else float(lam),
            turns=np.asarray(n)[..., np.newaxis],
            phases=phi[..., np.newaxis],
            velocities=velocity[..., np.newaxis],
            durations=duration[..., np.newaxis],
        )

    # Orbits with the same fields are equal, have the same hash, and are the same when pickled.

    @property
    def _values(self) -> tuple[Any, ...]:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        values["turns"] = np.broadcast_to(self.turns, (*self.shape, self.impacts))
        values["resumes"] = np.broadcast_to(self.resumes, (self.impacts,))
        return tuple(_comparable(each) for each in values.values())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, OrbitImpacts) and self._values == other._values

    def __hash__(self) -> int:
        return hash(self._values)

    def __bool__(self) -> bool:
        """Whether there is a single orbit.

        Raises
        ------
        ModelError
            If there are several: ask for ``exists``.
        """
        if self.shape:
            raise ModelError("several orbits are neither true nor false: see their exists")
        return bool(self.exists)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in _INTERNAL and name[0] != "_"]

    def __getstate__(self) -> dict[str, Any]:
        # Computed quantities are left out: the equations of an orbit hold functions.
        return {field.name: getattr(self, field.name) for field in fields(self)}

    # The shape of the orbits is that of the model, of Λ and of the impacts without their last axis.

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of the orbits, without the axis of the impacts."""
        turns = np.shape(self.turns)[:-1]
        return np.broadcast_shapes(
            self.model.shape, np.shape(self.amplitude), turns, self.phases.shape[:-1]
        )

    def _entries(self, shape: tuple[int, ...], index: Any) -> Self:
        whole = (*shape, self.impacts)
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        for name in _OF_IMPACTS:
            values[name] = np.broadcast_to(values[name], whole)[index]
        if self.model.shape:
            numbers = np.arange(self.model.size).reshape(self.model.shape)
            which = np.broadcast_to(numbers, shape)[index]
            values["model"] = self.model.flat(self.model.shape)[which]
        if np.ndim(self.amplitude):
            lam = np.broadcast_to(self.amplitude, shape)[index]
            values["amplitude"] = lam if lam.ndim else float(lam)
        return type(self)(**values)

    @property
    def impacts(self) -> int:
        """k."""
        return self.phases.shape[-1]

    @property
    def periods(self) -> Any:
        """m."""
        return number_or_row(np.sum(self.turns, axis=-1))

    @property
    def n(self) -> Any:
        """Index of the family of an n-T orbit: the number m of periods."""
        return self.periods

    @property
    def law(self) -> Any:
        """The law of the impact: a contact law, its signature, or r."""
        return self.model.impact_law

    @property
    def parameters(self) -> dict[str, Any]:
        """The values of the parameters of the branch from which the orbits come."""
        balls, names = balls_along(self.model, self.amplitude, *self.along)
        values = balls.values
        return {name: number_or_row(values[name]) for name in names}

    @property
    def exists(self) -> Any:
        """Whether there is an orbit: its contacts have durations."""
        return number_or_row(np.all(np.isfinite(self.durations), axis=-1))

    @property
    def phase(self) -> Any:
        """φ, the table's phase at the impacts."""
        return of_impacts(self.phases)

    @property
    def contact_duration(self) -> Any:
        """D = τ_b."""
        return of_impacts(self.durations)

    @property
    def impact_velocity(self) -> Any:
        """Absolute velocity z′_i of the ball at the start of contact."""
        return of_impacts(self.velocities)

    @property
    def flight_time(self) -> Any:
        """T, the time from the release to the next impact.

        For an n-T orbit it is τ_2 - τ_b = 2πn - D, because τ_i = 0 (Eq. 18), τ_2 = τ_i + 2πn
        (Eq. 19) and D = τ_b; that z′_2 = z′_i (Eq. 20) is a condition on the orbit.
        """
        return of_impacts(flights(self))

    @property
    def release_phase(self) -> Any:
        """The table's phase φ + τ_b at release."""
        return of_impacts(self.phases + self.durations)

    @property
    def bounce_velocity(self) -> Any:
        """Absolute velocity z′_b at release, z′_i + 2πn - τ_b for an n-T orbit (Eq. 27)."""
        return of_impacts(bounces(self))

    @property
    def relative_impact_velocity(self) -> Any:
        """δ′ = z′_i - w′_i at the start of contact: negative unless a contact resumes."""
        return of_impacts(closing(self))

    @property
    def relative_bounce_velocity(self) -> Any:
        """δ′ = z′_b - w′_b at release, positive."""
        return of_impacts(leaving(self))

    @property
    def apparent_restitution(self) -> Any:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17); NaN where the impact grazes."""
        speed = closing(self)
        return of_impacts(-leaving(self) / np.where(speed == 0, np.nan, speed))

    @property
    def _known_balls(self) -> Balls:
        """The balls; where Λ is not known they stand on a table with Λ = 1."""
        lam = np.asarray(self.amplitude, dtype=float)
        return Balls(self.model, np.where(np.isfinite(lam), lam, 1.0))

    @cached_property
    def starts(self) -> tuple[Dynamics, Impact]:
        """The dynamics and the impacts in a row, which is k times as long as that of the orbits."""
        dynamics = self._known_balls.row(self.shape, self.impacts).dynamics()
        whole = (*self.shape, self.impacts)
        phase = np.broadcast_to(self.phases, whole).ravel()
        velocity = np.broadcast_to(closing(self), whole).ravel()
        resumes = np.broadcast_to(self.resumes, whole).ravel()
        with np.errstate(invalid="ignore"):
            impact = dynamics.start(phase, velocity)
        return dynamics, impact.resumed(lag_of(dynamics, resumes))

    @cached_property
    def own_equations(self) -> tuple[OrbitEquations, np.ndarray]:
        """The equations with no parameter that varies, and y of the orbits."""
        return _equations(self, self._known_balls)


def number_or_row(values: Any) -> Any:
    """Quantities of the orbits; a Python number for a single orbit."""
    return values if np.ndim(values) else np.asarray(values).item()


def of_impacts(values: np.ndarray) -> Any:
    """Quantities of the impacts, shape (..., k), without this axis if k = 1."""
    return values if values.shape[-1] > 1 else number_or_row(values[..., 0])


# What follows from the impacts, arrays of shape (..., k).


def table_amplitude(orbit: OrbitImpacts) -> np.ndarray:
    """Λ with an axis for the impacts."""
    return np.asarray(orbit.amplitude)[..., np.newaxis]


def intervals(orbit: OrbitImpacts) -> np.ndarray:
    """The times from impact to impact."""
    turned = 2 * np.pi * np.asarray(orbit.turns)
    return (np.roll(orbit.phases, -1, axis=-1) - orbit.phases) + turned


def flights(orbit: OrbitImpacts) -> np.ndarray:
    """The times from the releases to the next impacts."""
    return intervals(orbit) - orbit.durations


def bounces(orbit: OrbitImpacts) -> np.ndarray:
    """Absolute velocities at release: in flight the velocity falls by the flight time."""
    return np.roll(orbit.velocities, -1, axis=-1) + flights(orbit)


def closing(orbit: OrbitImpacts) -> np.ndarray:
    """δ′ at the starts of contact."""
    return orbit.velocities - table_amplitude(orbit) * np.cos(orbit.phases)


def leaving(orbit: OrbitImpacts) -> np.ndarray:
    """δ′ at the releases."""
    table = table_amplitude(orbit) * np.cos(orbit.phases + orbit.durations)
    return bounces(orbit) - table


# The equations that the orbits solve.


def equations_of(orbit: OrbitImpacts, *along: str | Path) -> tuple[OrbitEquations, np.ndarray]:
    """The equations of orbits, with parameters that vary, or a path of parameters, and y of the
    orbits, shape (..., N + parameters).

    Raises
    ------
    ParameterError
        If the balls have no such parameter, or if one of them follows from another.
    """
    return _equations(orbit, *balls_along(orbit.model, orbit.amplitude, *along))


def _equations(
    orbit: OrbitImpacts, balls: Balls, along: tuple[str, ...] = ()
) -> tuple[OrbitEquations, np.ndarray]:
    durations = np.broadcast_to(orbit.durations, (*orbit.shape, orbit.impacts)).ravel()
    problem = OrbitEquations(
        balls=balls,
        impacts=orbit.impacts,
        turns=orbit.turns,
        along=along,
        selects=selects_ends(*orbit.starts, durations),
        resumes=np.broadcast_to(orbit.resumes, (orbit.impacts,)),
    )
    return problem, point_of(orbit, problem)


def point_of(orbit: OrbitImpacts, problem: OrbitEquations) -> np.ndarray:
    """y of orbits among the unknowns of a problem, shape (..., N + parameters)."""
    dynamics, impact = orbit.starts
    whole = (*orbit.shape, orbit.impacts)
    with np.errstate(invalid="ignore"):
        phase = orbit.phases + dynamics.section().delay(impact).reshape(whole)
        _, velocity = dynamics.section().state(impact)
    given = {}
    if problem.along:
        values = Balls(orbit.model, orbit.amplitude, problem.balls.path).values
        given = {name: values[name] for name in problem.along}
    duration = np.broadcast_to(orbit.durations, whole)
    return problem.point(phase, velocity.reshape(whole), duration, **given)


def of_existing(
    orbit: OrbitImpacts, quantity: Callable[[OrbitImpacts], np.ndarray], tail: int = 0
) -> np.ndarray:
    """A quantity of the orbits that exist, NaN for others, computed in blocks.

    ``tail`` is the length of its last axis, 0 if it has the shape of the orbits.
    """
    exists = np.broadcast_to(orbit.exists & np.isfinite(orbit.amplitude), orbit.shape)
    if np.all(exists) and 0 < orbit.size <= _LEGS:
        return quantity(orbit)
    ends = (tail,) if tail else ()
    found = np.full((orbit.size, *ends), np.nan)
    which = np.flatnonzero(exists)
    row = orbit.flat(orbit.shape)
    for part in blocks(which.size, _LEGS):
        found[which[part]] = quantity(row.take(which[part]))
    return found.reshape((*orbit.shape, *ends))
