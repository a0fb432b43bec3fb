"""The interface of the n-T orbits of a model, whatever formula or search finds them."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit


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
