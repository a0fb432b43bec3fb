"""Balls followed from impact to impact, whatever the impact is made of.

A model gives its :class:`Dynamics`; rows, blocks of balls, balls that stop and the
Poincaré map are the same for all.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol, Self

import numpy as np

from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.ensembles import blocks, pick
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status


class Impact(NamedTuple):
    """Starts of contact: table phase, δ and δ′."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros_like(phase), velocity)


class Departure(NamedTuple):
    """Ends of contact: table phase, δ and δ′; its duration and the :class:`Status`."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    duration: np.ndarray
    status: np.ndarray

    def take(self, which: Any) -> "Departure":
        """Those of some of the balls."""
        return Departure(*(pick(x, which) for x in self))


Columns = Mapping[str, Callable[[Any, Any], np.ndarray]]
"""What is recorded of an impact and its departure, by the names of :class:`ImpactSequence`."""

BELOW: Columns = {
    "displacement": lambda impact, _: impact.displacement,
    "release_displacement": lambda _, departure: departure.displacement,
}
"""The columns of contacts that may start or end below the table's level."""

_COLUMNS: Columns = {
    "phase": lambda impact, _: impact.phase,
    "relative_velocity": lambda impact, _: impact.velocity,
    "contact_duration": lambda _, departure: departure.duration,
    "relative_release_velocity": lambda _, departure: departure.velocity,
}


class Dynamics(Protocol):
    """The contacts and flights of balls in a row.

    Impacts and departures have the fields of :class:`Impact` and of
    :class:`Departure`, and what else a model hands on from one to the next.
    """

    @property
    def block(self) -> int:
        """How many balls are worked on at once, at most."""

    @property
    def columns(self) -> Columns:
        """What is recorded besides time, phases, velocities and durations.

        A displacement that is not recorded is always 0.
        """

    def take(self, which: Any) -> Self:
        """Those of some of the balls."""

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Any:
        """The first impacts, at states of the table's phase and the relative velocity."""

    def depart(self, impact: Any) -> Any:
        """The ends of the contacts that start so."""

    def fly(self, departure: Any) -> tuple[Any, np.ndarray]:
        """The next impact of balls that leave, and the time until it from the last."""


def follow(
    dynamics: Dynamics, state: tuple[np.ndarray, np.ndarray], law, amplitude, shape, impacts: int
) -> ImpactSequence:
    """The impacts of balls in a row from their states (phase, relative velocity) on.

    Parameters
    ----------
    dynamics : Dynamics
    state : tuple of array
        What :meth:`Dynamics.start` takes, one-dimensional.
    law, amplitude
        The contact's law, or None, and Λ, as the result has them.
    shape : tuple of int
        Shape of the balls in the result.
    impacts : int
        Rows of the result.
    """
    phase, velocity = state
    size = phase.size
    columns = {**_COLUMNS, **dynamics.columns}
    table = {name: np.full((impacts, size), np.nan) for name in ("time", *columns)}
    status = np.zeros(size, dtype=np.int8)
    for part in blocks(size, dynamics.block):
        here = dynamics.take(part)
        rows = {name: values[:, part] for name, values in table.items()}
        _run(here.start(phase[part], velocity[part]), here, columns, rows, status[part])
    found = {name: values.reshape(impacts, *shape) for name, values in table.items()}
    for name, known in (("displacement", "time"), ("release_displacement", "contact_duration")):
        if name not in found:
            found[name] = np.where(np.isfinite(found[known]), 0.0, np.nan)
    return ImpactSequence(
        amplitude=np.broadcast_to(np.asarray(amplitude, dtype=float), shape),
        contact=law,
        status=status.reshape(shape),
        **found,
    )


def _run(impact, dynamics: Dynamics, columns: Columns, rows, status) -> None:
    """Fill the rows of one block, impact by impact."""
    time = np.zeros_like(impact.phase)
    alive: Any = slice(None)
    impacts = len(rows["time"])
    for row in range(impacts):
        departure = dynamics.depart(impact)
        rows["time"][row, alive] = time
        for name, value in columns.items():
            rows[name][row, alive] = value(impact, departure)
        if np.any(departure.status):
            status[alive] = departure.status
            going = np.flatnonzero(departure.status == Status.BOUNCING)
            alive = np.arange(len(status))[alive][going]
            dynamics, departure, time = dynamics.take(going), departure.take(going), time[going]
        if row == impacts - 1 or not len(time):
            break
        impact, passed = dynamics.fly(departure)
        time = time + passed


def next_impact(dynamics: Dynamics, state: tuple[np.ndarray, np.ndarray], shape) -> Cycle:
    """The Poincaré map of balls in a row, given back in a shape; see :func:`follow`."""
    phase, velocity = state
    out = np.full((4, phase.size), np.nan)
    out[3] = np.inf
    for part in blocks(phase.size, dynamics.block):
        here = dynamics.take(part)
        departure = here.depart(here.start(phase[part], velocity[part]))
        going = np.flatnonzero(departure.status == Status.BOUNCING)
        if not going.size:
            continue
        landed, passed = here.take(going).fly(departure.take(going))
        values = (landed.phase, landed.velocity, landed.displacement, passed)
        out[:, part.start + going] = values
    return Cycle(*(row.reshape(shape) for row in out))
