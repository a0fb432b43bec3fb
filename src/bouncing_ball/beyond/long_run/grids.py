"""Motions on which balls end, as datasets: for given starts, over Λ, and for basins.

All quantities are dimensionless, and phases are in radians.
"""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.beyond.corrected.instant import instant_of
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.motions import Kind, Motions
from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.variables import described
from bouncing_ball.errors import ParameterError

MOST_BALLS = 20_000_000
"""Largest number of balls that are followed at the same time; they take some gigabytes."""
# Balls start again from the ends of balls that are this many amplitudes away. The fractional parts
# of multiples of the two numbers in _EVEN cover a square evenly.
_FURTHER = (1, 4)
# Families of orbits beside which balls start, and the difference between their phases.
_FAMILIES, _BESIDE = (1, 2, 3), 1e-3
_EVEN = np.array([0.7548776662466927, 0.5698402909980532])
_SEEN = ("impact_phase", "impact_speed")
REACH = max(_FURTHER)
"""The motions at one Λ depend on at most this number of amplitudes on each side."""


def require_memory(balls: int, what: str) -> None:
    """Raise :class:`ParameterError` if there are more balls than fit into memory.

    Examples
    --------
    >>> require_memory(10**9, "starts")
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ParameterError: starts: 1000000000 balls are more than fit into memory, \
20000000 are allowed
    """
    if balls > MOST_BALLS:
        raise ParameterError(
            f"{what}: {balls} balls are more than fit into memory, {MOST_BALLS} are allowed"
        )


def _columns(found: Motions, dims: tuple[str, ...]) -> dict[str, Any]:
    names = {"exponent": "lyapunov_exponent", "exponent_error": "lyapunov_error"}
    shown = {name: value for name, value in vars(found).items() if name != "followed"}
    return {names.get(name, name): (dims, value) for name, value in shown.items()}


def motions(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, impacts: int
) -> xr.Dataset:
    """The motions on which a row of balls ends that start with the impacts (Λ, φ, z′_i).

    The variables are the fields of :class:`~bouncing_ball.beyond.long_run.motions.Motions`, except
    ``followed``, over the row, the dimension "case".

    Raises
    ------
    ModelError
        If there are too many balls, or a state is outside its range.
    """
    require_memory(amplitude.size, "a grid of starts")
    found = final_motions(model.impact_law, amplitude, phase, velocity, impacts=impacts)
    return described(_columns(found, (CASE,)))


def fastest(model: Any, amplitude: Any) -> np.ndarray:
    """A speed above which every impact slows the ball, (1 + r) max(Λ, 1)/(1 - r), 1 - r ≥ 0.05.

    An impact changes the absolute speed v of the ball to r v + (1 + r) Λ at most, which is less
    than v above this value. r is that of a free impact with the speed 2π.

    Examples
    --------
    >>> from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
    >>> float(fastest(RestitutionModel(0.5), 2.0))
    6.0
    """
    lam = np.asarray(amplitude, dtype=float)
    r = np.asarray(instant_of(model, 2 * np.pi).restitution)
    return (1 + r) * np.maximum(lam, 1.0) / np.maximum(1 - r, 0.05)


def diagram(
    model: Any, amplitude: np.ndarray, starts: int, samples: int, impacts: int
) -> xr.Dataset:
    """The attractors over Λ, from several starts and from the motions at neighbouring Λ.

    After the starts, balls start again at each Λ from the ends of balls at lower and at higher Λ.
    An attractor is thus followed in both directions beyond the Λ at which a start finds it. The
    motions are over (amplitude, start). ``impact_phase`` and ``impact_speed`` are over (amplitude,
    start, impact), NaN beyond the impacts of one period.

    Raises
    ------
    ModelError
        If there are too many balls.
    """
    balls = starts + len(_FAMILIES) + 2 * len(_FURTHER)
    require_memory(amplitude.size * balls * samples, "amplitudes, starts and samples")
    lam = amplitude[:, np.newaxis]
    even = np.mod(0.5 + np.arange(1, starts + 1)[:, np.newaxis] * _EVEN, 1.0)
    # More balls start beside the orbits with one impact, which may attract few of the other balls.
    orbit = model.orbit(np.array(_FAMILIES), np.where(lam > 0, lam, np.nan))
    phase = 2 * np.pi * even[:, 0] - np.pi + 0 * lam, orbit.phase + _BESIDE
    speed = even[:, 1] * fastest(model, lam), -orbit.relative_impact_velocity
    found = _ends(model, lam, np.concatenate(phase, 1), np.concatenate(speed, 1), impacts)
    # The ends of the first ball at two lower and at two higher Λ.
    place = np.arange(amplitude.size)[:, np.newaxis] + np.multiply.outer([-1, 1], _FURTHER).ravel()
    place = np.clip(place, 0, amplitude.size - 1)
    phase, velocity = found.end_phase[place, 0], found.end_velocity[place, 0]
    speed = amplitude[place] * np.cos(phase) - velocity
    swept = _ends(model, lam, phase, speed, impacts)
    both = zip(vars(found).values(), vars(swept).values(), strict=True)
    found = Motions(*(np.concatenate(x, 1) for x in both))
    seen = _impacts(model, lam, found, samples)
    dims = ("amplitude", "start")
    data = {name: ((*dims, "impact"), x) for name, x in zip(_SEEN, seen, strict=True)}
    return described(_columns(found, dims) | data, {"amplitude": amplitude})


def _ends(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, speed: np.ndarray, impacts: int
) -> Motions:
    """The motions of balls that start with impacts of given speeds.

    If the speed is not positive, for example for a ball on the table, the ball starts with speed 1.
    """
    phase, speed = np.nan_to_num(phase), np.where(speed > 0, speed, 1.0)
    return final_motions(model.impact_law, amplitude, phase, amplitude * np.cos(phase) - speed,
                 impacts=impacts)  # fmt: skip


def _impacts(model: Any, amplitude: np.ndarray, found: Motions, samples: int) -> np.ndarray:
    """Phase and speed of the impacts of motions, shape (2, ..., samples); NaN beyond a period."""
    seen = np.full((2, samples, *found.shape), np.nan)
    lam = np.broadcast_to(amplitude, found.shape)
    falls = found.end_velocity < lam * np.cos(found.end_phase)
    if falls.any():
        sequence = model.simulate(
            lam[falls], found.end_phase[falls], found.end_velocity[falls], samples
        )
        seen[:, :, falls] = sequence.phase, -sequence.relative_velocity
    length = np.where(found.impacts > 0, found.impacts, samples)
    late = np.arange(samples).reshape(-1, *(1,) * length.ndim) >= length
    return np.moveaxis(np.where(late, np.nan, seen), 1, -1)


def basins(
    model: Any, amplitude: float, starts: int, fast: float | None, impacts: int
) -> xr.Dataset:
    """The motions on which a grid of impacts (φ, δ′) ends, with their shares of the grid.

    ``destination`` (start_speed, start_phase) is an index along ``motion``. Over ``motion`` the
    dataset has ``motion_kind``, ``motion_periods``, ``motion_impacts``, ``share`` and its standard
    error ``share_error``; ``lyapunov_exponent`` is over the starts.

    Raises
    ------
    ModelError
        If there are too many starts.
    """
    require_memory(starts * starts, "a grid of starts")
    middle = (np.arange(starts) + 0.5) / starts
    top = float(fastest(model, amplitude)) if fast is None else fast
    phase, speed = 2 * np.pi * middle - np.pi, top * middle
    phi, towards = np.meshgrid(phase, speed)
    law = model.impact_law
    found = final_motions(law, amplitude, phi, amplitude * np.cos(phi) - towards, impacts=impacts)
    names = np.array(list(Kind))
    number = np.argmax(found.kind[..., np.newaxis] == names, axis=-1)
    key = np.stack([number, found.periods, found.impacts], axis=-1).reshape(-1, 3)
    known, which, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    share, dims = count / which.size, ("start_speed", "start_phase")
    of_motions = {
        "motion_kind": names[known[:, 0]],
        "motion_periods": known[:, 1],
        "motion_impacts": known[:, 2],
        "share": share,
        "share_error": np.sqrt(share * (1 - share) / which.size),
    }
    data = {
        "destination": (dims, which.reshape(found.shape)),
        "lyapunov_exponent": (dims, found.exponent),
        **{name: ("motion", values) for name, values in of_motions.items()},
    }
    coords = {"start_phase": phase, "start_speed": speed}
    return described(data, coords)
