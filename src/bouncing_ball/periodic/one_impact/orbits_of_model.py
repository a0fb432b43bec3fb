"""The interface of the n-T orbits of a model, and the searches for one ball after the other."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.periodic.orbits.impacts import check_index
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.stability import Bifurcation, Side

NO_LIMITS = (
    "the period doublings of limits are those of a table that moves as a sine, with free flight: "
    "use follow(orbit(…)) for another table or flight"
)


@dataclass(frozen=True)
class OrbitsOfModel(ABC):
    """The n-T orbits of a model. Entries are NaN where there is no such orbit."""

    model: Any

    is_complete: ClassVar[bool] = False
    """Whether an orbit that is not found does not exist: the branch is a formula."""

    @abstractmethod
    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node."""

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """All n-T orbits of a single model at one Λ, in order of contact duration, in a row.

        By default they are those on both sides of the saddle-node.
        """
        sides = [self.orbit(n, amplitude, side) for side in Side]
        return in_order(sides, Orbit.of(self.model, n, amplitude, np.nan))

    @abstractmethod
    def saddle_node(self, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node."""

    @abstractmethod
    def period_doubling(self, n: ArrayLike) -> Orbit:
        """The orbits at the period doubling nearest to the saddle-node on the stable side."""


class OrbitsOneByOne(OrbitsOfModel):
    """The n-T orbits of balls in another setting than that of the paper, for one ball after the
    other.
    """

    @abstractmethod
    def rows(self, model: Any, n: int, amplitude: float) -> Iterator[Orbit]:
        """The orbits of a single model at one Λ that a first search finds, in a row; then those of
        each further search, together with those before.
        """

    @abstractmethod
    def rank(self, row: Orbit) -> np.ndarray:
        """A number for each orbit of a row: of several on a side the first of the highest number is
        chosen.
        """

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where none was found."""
        check_index(n)
        shape = np.broadcast_shapes(np.shape(n), np.shape(amplitude), self.model.shape)
        index = np.broadcast_to(n, shape)
        lam = np.broadcast_to(np.asarray(amplitude, dtype=float), shape)
        columns = np.full((3, *shape), np.nan)
        models = self.model.flat(shape)
        for k, place in enumerate(np.ndindex(shape)):
            if not lam[place] > 0:
                continue
            rows = self.rows(models.take(k), int(index[place]), float(lam[place]))
            columns[(slice(None), *place)] = self._first_on(side, rows)
        phase, duration, velocity = columns
        return Orbit.of(self.model, index, lam, phase, duration, velocity)

    def _first_on(self, side: Side, rows: Iterator[Orbit]) -> tuple[float, float, float]:
        """φ, D and z′_i of the orbit chosen on a side in the first row that has one; NaN if there
        is none.
        """
        for row in rows:
            if not row.size:
                continue
            on_stable_side = Bifurcation.SADDLE_NODE.test(*row.trace_and_determinant()) > 0
            here = np.flatnonzero(on_stable_side == (side is Side.STABLE))
            if here.size:
                k = here[np.argmax(np.atleast_1d(self.rank(row))[here])]
                return row.phase[k], row.contact_duration[k], row.impact_velocity[k]
        return np.nan, np.nan, np.nan

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """The n-T orbits of a single model at one Λ, in a row, in order of contact duration."""
        check_index(n)
        *_, found = self.rows(self.model, n, amplitude)
        return found[np.argsort(found.contact_duration, kind="stable")]

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """Raise an error: period doublings are found by :func:`bouncing_ball.follow`."""
        raise ModelError(NO_LIMITS)


def in_order(orbits: list[Orbit], none: Orbit) -> Orbit:
    """Those of the single n-T orbits of one model at one Λ that exist, as a row in order of contact
    duration.

    Both sides of a saddle-node are one orbit at the saddle-node itself. ``none`` is an orbit of
    this model, which determines an empty row.
    """
    places = {(x.phase, x.contact_duration, x.impact_velocity, x.amplitude) for x in orbits}
    known = [place for place in places if not any(np.isnan(place))]
    # The orbit with the larger phase, which is on the stable side, comes first of two instants.
    known.sort(key=lambda place: (place[1], -place[0]))
    phase, duration, velocity, lam = np.array(known).reshape(-1, 4).T
    return Orbit.of(none.model, none.n, lam, phase, duration, velocity)
