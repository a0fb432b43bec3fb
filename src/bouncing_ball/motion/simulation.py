"""The simulation of balls from impact to impact, for any kind of impact."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.restitution_law import RestitutionLaw
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError, require
from bouncing_ball.motion.angles import table
from bouncing_ball.motion.contact import ContactDynamics, LinearContactDynamics
from bouncing_ball.motion.corrected import CorrectedDynamics
from bouncing_ball.motion.dynamics import Dynamics, Impact
from bouncing_ball.motion.ensembles import blocks, pick
from bouncing_ball.motion.linear_contact import has_closed_form
from bouncing_ball.motion.restitution import RestitutionDynamics
from bouncing_ball.motion.sequence import RECORDED, Cycle, ImpactSequence, Status

Law = ContactLaw | Signature | RestitutionLaw | ArrayLike
"""A contact law, the signature of one, or a restitution coefficient: a law r(v) or numbers r."""

# Rounding may give a ball at rest on the table a small upward velocity.
_ROUNDING = 8 * np.finfo(float).eps


def _dynamics(law: Law, amplitude: ArrayLike) -> Dynamics:
    lam = np.asarray(amplitude, dtype=float)
    require((lam >= 0) & np.isfinite(lam), lam, "amplitude Λ", "finite and ≥ 0")
    if isinstance(law, SpringDamper) and has_closed_form(law):
        return LinearContactDynamics(law, lam)
    if isinstance(law, ContactLaw):
        return ContactDynamics(law, lam)
    if isinstance(law, Signature):
        return CorrectedDynamics(law, lam)
    if not isinstance(law, RestitutionLaw):
        law = np.asarray(law, dtype=float)
        require((law > 0) & (law <= 1), law, "restitution coefficient r", "in (0, 1]")
    return RestitutionDynamics(law, lam)


def in_a_row(law: Law, amplitude: ArrayLike, *states: ArrayLike):
    """The dynamics and the states of balls, flattened, and the shape to which they broadcast.

    Raises
    ------
    ModelError
        If r or Λ is outside its range.
    """
    dynamics = _dynamics(law, amplitude)
    arrays = [np.asarray(x, dtype=float) for x in states]
    shape = np.broadcast_shapes(dynamics.shape, *(x.shape for x in arrays))
    return dynamics.flat(shape), [np.broadcast_to(x, shape).reshape(-1) for x in arrays], shape


def first_impacts(
    law: Law, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike
) -> tuple[Dynamics, np.ndarray, np.ndarray, tuple[int, ...]]:
    """The dynamics of balls, and φ and δ′ ≤ 0 of their first impacts, flattened; and their shape.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range, or if a ball rises from the table.
    """
    dynamics, (start, before), shape = in_a_row(law, amplitude, phase, velocity)
    if not np.all(np.isfinite(start) & np.isfinite(before)):
        raise ModelError("the phase and the velocity of the impact must be finite")
    relative = before - table(start, dynamics.amplitude)[0]
    if not np.all(relative <= _ROUNDING * (np.abs(before) + dynamics.amplitude)):
        raise ModelError("a ball that rises from the table has no impact: z′ > w′")
    return dynamics, start, np.minimum(relative, 0.0), shape


def simulate(
    law: Law, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """Follow balls from an impact through a number of impacts, the first included.

    Parameters
    ----------
    law : ContactLaw, Signature, RestitutionLaw or array_like
        The contact law, for contacts of finite duration; its signature, for the corrected model;
        or the restitution coefficient, a law r(v) or a number in (0, 1]. Arrays of parameters have
        one entry per ball.
    amplitude : array_like
        Λ ≥ 0.
    phase, velocity : array_like
        The table's phase φ and the absolute velocity z′_i of the ball just before the first impact.
    impacts : int
        Number of impacts to compute. The bounces that are summed up before a ball sticks are not
        counted. Balls that remain on the table have fewer impacts.

    Returns
    -------
    ImpactSequence
        Its rows have the shape to which the arguments broadcast.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range, or if a ball rises from the table.

    Examples
    --------
    On a table at rest an undamped contact preserves the speed, and r = 1/2 halves it:

    >>> simulate(SpringDamper(100.0, 0.0), 0.0, 0.0, -2.0, 3).impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    >>> simulate(0.5, 0.0, 0.0, -8.0, 3).time.tolist()
    [0.0, 8.0, 12.0]
    """
    dynamics, start, relative, shape = first_impacts(law, amplitude, phase, velocity)
    rows = {name: np.full((impacts, start.size), np.nan) for name in RECORDED}
    status = np.zeros(start.size, dtype=np.int8)
    for part in blocks(start.size, dynamics.block):
        own = [values[:, part] for values in rows.values()]
        here = dynamics.take(part)
        _run(here, here.start(start[part], relative[part]), own, status[part])
    return ImpactSequence(
        amplitude=np.broadcast_to(np.asarray(amplitude, dtype=float), shape),
        contact=law if isinstance(law, ContactLaw) else None,
        status=status.reshape(shape),
        **{name: values.reshape(impacts, *shape) for name, values in rows.items()},
    )


def _run(dynamics: Dynamics, impact: Impact, rows: list[np.ndarray], status: np.ndarray) -> None:
    """Fill the rows and the status of one block of balls, impact by impact."""
    time = np.zeros_like(impact.phase)
    alive: Any = slice(None)
    impacts = len(rows[0])
    for row in range(impacts):
        departure = dynamics.depart(impact)
        flight = departure.flight
        values = (time, *impact[:3], departure.duration, flight.displacement, flight.velocity)
        for column, value in zip(rows, (*values, departure.settling), strict=True):
            column[row, alive] = value
        if np.any(departure.status):
            status[alive] = departure.status
            going = np.flatnonzero(departure.status == Status.BOUNCING)
            alive = np.arange(len(status))[alive][going]
            dynamics, departure, time = dynamics.take(going), pick(departure, going), time[going]
        if row == impacts - 1 or not len(time):
            break
        impact, passed = dynamics.fly(departure)
        time = time + passed


def next_impact(
    law: Law, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map from one impact (φ, δ′) to the next, for arguments that broadcast.

    Parameters
    ----------
    law, amplitude
        As in :func:`simulate`.
    phase, relative_velocity : array_like
        The table's phase φ and the ball's δ′ ≤ 0 just before an impact.

    Raises
    ------
    ModelError
        If r or Λ is outside its range, or if a flight is too long for floating-point numbers.

    Examples
    --------
    On a table at rest a ball whose contact is undamped returns with the same velocity:

    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> cycle = next_impact(HuntCrossley(1e6, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 11)
    -2.0
    """
    dynamics, (start, velocity), shape = in_a_row(law, amplitude, phase, relative_velocity)
    out = np.full((len(Cycle._fields), start.size), np.nan)
    out[-1] = np.inf
    for part in blocks(start.size, dynamics.block):
        here = dynamics.take(part)
        departure = here.depart(here.start(start[part], velocity[part]))
        going = np.flatnonzero(departure.status == Status.BOUNCING)
        if going.size:
            landed, passed = here.take(going).fly(pick(departure, going))
            values = landed.phase, landed.velocity, landed.displacement, passed
            out[:, part.start + going] = values
    return Cycle(*out.reshape(len(Cycle._fields), *shape))
