"""The impacts of periodic orbits, and what follows from them and from the flights between them.

An orbit has k impacts in m periods of the table. An impact is the start of a contact, at the phase
φ of the table. The contact lasts for D = τ_b, and the flight after it ends at the next impact.
Heights and velocities are absolute unless they are called relative, which means relative to the
table: δ = z - w.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.numerics.arrays import Batch, blocks
from bouncing_ball_beyond.models.attributes import Suggesting
from bouncing_ball_beyond.models.contacts_and_flights import Impact
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls, Path
from bouncing_ball_beyond.periodic.orbits.legs import (
    Legs,
    lag_of,
    selects_ends,
    time_to_section,
    without_force,
)
from bouncing_ball_beyond.periodic.orbits.paths import balls_along
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

if TYPE_CHECKING:
    import xarray as xr

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
_INTERNAL = {
    "check_shape",
    "clock",
    "contact_motion",
    "contact_path",
    "flat",
    "flight_path",
    "of",
    "of_dataset",
    "point",
    "problem",
    "resumes",
    "take",
    "touches",
    "turns",
}


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

    def to_dataset(self) -> xr.Dataset:
        """The orbit, or a row of orbits, as a labelled dataset with the model and its parameters.

        :func:`bouncing_ball_beyond.read_orbits` makes equal orbits from it, also from a netCDF file
        of it.

        Examples
        --------
        >>> from bouncing_ball_beyond import read_orbits
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
        >>> orbit = Orbit.of(RestitutionModel(0.5), 1, 1.5, 0.7)
        >>> read_orbits(orbit.to_dataset()) == orbit
        True
        """
        # Imported here, because a single orbit needs no labels.
        from bouncing_ball_beyond.periodic.orbits.saved import dataset_of

        return dataset_of(self)

    @classmethod
    def of_dataset(cls, data: xr.Dataset, prefix: str = "") -> Self:
        """The orbits in the variables of a dataset whose names begin with a prefix.

        Raises
        ------
        ModelError
            If there are none, or if their law is not known.
        """
        from bouncing_ball_beyond.periodic.orbits.saved import fields_in

        return cls(**fields_in(data, prefix))

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

    def _shaped(self, values: np.ndarray) -> Any:
        """Quantities of the impacts, shape (..., k), without this axis if k = 1."""
        if self.impacts > 1:
            return values
        first = values[..., 0]
        return first if first.ndim else first.item()

    def _single(self, values: Any) -> Any:
        """Quantities of the orbits; a Python number for a single orbit."""
        return values if np.ndim(values) else np.asarray(values).item()

    @property
    def impacts(self) -> int:
        """k."""
        return self.phases.shape[-1]

    @property
    def periods(self) -> Any:
        """m."""
        return self._single(np.sum(self.turns, axis=-1))

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
        """The values of the parameters of the branch from which the orbit comes."""
        balls, names = balls_along(self.model, self.amplitude, *self.along)
        values = balls.values
        return {name: float(values[name]) for name in names}

    @property
    def exists(self) -> Any:
        """Whether there is an orbit: its contacts have durations."""
        return self._single(np.all(np.isfinite(self.durations), axis=-1))

    @property
    def phase(self) -> Any:
        """φ, the table's phase at the impacts."""
        return self._shaped(self.phases)

    @property
    def contact_duration(self) -> Any:
        """D = τ_b."""
        return self._shaped(self.durations)

    @property
    def impact_velocity(self) -> Any:
        """Absolute velocity z′_i of the ball at the start of contact."""
        return self._shaped(self.velocities)

    @property
    def _lam(self) -> np.ndarray:
        """Λ with an axis for the impacts."""
        return np.asarray(self.amplitude)[..., np.newaxis]

    @cached_property
    def _intervals(self) -> np.ndarray:
        """The times from impact to impact, shape (..., k)."""
        return (np.roll(self.phases, -1, axis=-1) - self.phases) + 2 * np.pi * np.asarray(
            self.turns
        )

    @property
    def _flights(self) -> np.ndarray:
        return self._intervals - self.durations

    @property
    def _bounces(self) -> np.ndarray:
        # In flight the velocity falls by the flight time.
        return np.roll(self.velocities, -1, axis=-1) + self._flights

    @property
    def flight_time(self) -> Any:
        """T, the time from the release to the next impact.

        For an n-T orbit it is τ_2 - τ_b = 2πn - D, because τ_i = 0 (Eq. 18), τ_2 = τ_i + 2πn
        (Eq. 19) and D = τ_b; that z′_2 = z′_i (Eq. 20) is a condition on the orbit.
        """
        return self._shaped(self._flights)

    @property
    def release_phase(self) -> Any:
        """The table's phase φ + τ_b at release."""
        return self._shaped(self.phases + self.durations)

    @property
    def bounce_velocity(self) -> Any:
        """Absolute velocity z′_b at release, z′_i + 2πn - τ_b for an n-T orbit (Eq. 27)."""
        return self._shaped(self._bounces)

    @property
    def _closing(self) -> np.ndarray:
        return self.velocities - self._lam * np.cos(self.phases)

    @property
    def _leaving(self) -> np.ndarray:
        return self._bounces - self._lam * np.cos(self.phases + self.durations)

    @property
    def relative_impact_velocity(self) -> Any:
        """δ′ = z′_i - w′_i at the start of contact: negative unless a contact resumes."""
        return self._shaped(self._closing)

    @property
    def relative_bounce_velocity(self) -> Any:
        """δ′ = z′_b - w′_b at release, positive."""
        return self._shaped(self._leaving)

    @property
    def apparent_restitution(self) -> Any:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17); NaN where the impact grazes."""
        closing = np.where(self._closing == 0, np.nan, self._closing)
        return self._shaped(-self._leaving / closing)

    # What needs the motion in contact.

    @property
    def _balls(self) -> Balls:
        """The balls; where Λ is not known they stand on a table with Λ = 1."""
        lam = np.asarray(self.amplitude, dtype=float)
        return Balls(self.model, np.where(np.isfinite(lam), lam, 1.0))

    @cached_property
    def _start(self) -> tuple[Dynamics, Impact]:
        """The dynamics and the impacts in a row, which is k times as long as that of the orbits."""
        dynamics = self._balls.row(self.shape, self.impacts).dynamics()
        whole = (*self.shape, self.impacts)
        phase = np.broadcast_to(self.phases, whole).ravel()
        velocity = np.broadcast_to(self._closing, whole).ravel()
        with np.errstate(invalid="ignore"):
            impact = dynamics.start(phase, velocity)
        resumes = np.broadcast_to(self.resumes, whole).ravel()
        return dynamics, without_force(impact, lag_of(dynamics, resumes))

    def problem(self, *along: str | Path) -> OrbitEquations:
        """The equations of these orbits, with parameters that vary, or a path of parameters.

        Raises
        ------
        ParameterError
            If the balls have no such parameter, or if one of them follows from another.
        """
        balls, names = balls_along(self.model, self.amplitude, *along)
        dynamics, impact = self._start
        whole = (*self.shape, self.impacts)
        durations = np.broadcast_to(self.durations, whole).ravel()
        return OrbitEquations(
            balls=balls,
            impacts=self.impacts,
            turns=self.turns,
            along=names,
            selects=selects_ends(dynamics, impact, durations),
            resumes=np.broadcast_to(self.resumes, (self.impacts,)),
        )

    def point(self, problem: OrbitEquations) -> np.ndarray:
        """y of these orbits among the unknowns of a problem, shape (..., N + parameters)."""
        dynamics, impact = self._start
        whole = (*self.shape, self.impacts)
        with np.errstate(invalid="ignore"):
            phase = self.phases + time_to_section(dynamics, impact).reshape(whole)
            _, velocity = dynamics.section(impact)
        duration = np.broadcast_to(self.durations, whole)
        given = {}
        if problem.along:
            values = Balls(self.model, self.amplitude, problem.balls.path).values
            given = {name: values[name] for name in problem.along}
        return problem.point(phase, velocity.reshape(whole), duration, **given)

    @cached_property
    def _own(self) -> tuple[OrbitEquations, np.ndarray]:
        """The equations with no parameter that varies, and the unknowns."""
        problem = replace(self.problem(), balls=self._balls)
        return problem, self.point(problem)

    @cached_property
    def _legs(self) -> Legs:
        problem, y = self._own
        return problem.legs(y)

    def _of_existing(self, quantity: Callable[[Self], np.ndarray], tail: int = 0) -> np.ndarray:
        """A quantity of the orbits that exist, NaN for others, computed in blocks.

        ``tail`` is the length of its last axis, 0 if it has the shape of the orbits.
        """
        exists = np.broadcast_to(self.exists & np.isfinite(self.amplitude), self.shape)
        if np.all(exists) and 0 < self.size <= _LEGS:
            return quantity(self)
        ends = (tail,) if tail else ()
        found = np.full((self.size, *ends), np.nan)
        which = np.flatnonzero(exists)
        row = self.flat(self.shape)
        for part in blocks(which.size, _LEGS):
            found[which[part]] = quantity(row.take(which[part]))
        return found.reshape((*self.shape, *ends))
