"""Motions on which balls end, as datasets: for given starts, over Λ, and for basins.

All quantities are dimensionless, and phases are in radians.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import require_memory
from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe, described
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.motions.basins import basins as basins_of
from bouncing_ball_beyond.motions.basins import fastest
from bouncing_ball_beyond.motions.contraction import exponent_sum
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.motions.lyapunov import NEAR
from bouncing_ball_beyond.motions.motions import Kind, Motions, Reason
from bouncing_ball_beyond.periodic.one_impact import n_t

VARIABLES = {
    "motion": Variable("motion on which a ball ends"),
    "kind": Variable("kind of motion on which the ball ends"),
    "start_phase": Variable("phase of the table at the first impact", symbol="φ", units="rad"),
    "start_speed": Variable("relative speed at the first impact", symbol="-δ′"),
    "end_phase": Variable(
        "phase of the table at an impact of the motion on which the ball ends", units="rad"
    ),
    "destination": Variable("motion on which a start ends, index of the motion", budget=math.inf),
    "share": Variable("share of nodes"),
    "digits_lost": Variable(
        "decimal digits of the start that the motion has lost on the way", budget=math.inf
    ),
    "followed_time": Variable("time from the first impact to the last of those followed"),
    "times_stuck": Variable("contacts at which the ball stuck to the table, of those followed"),
    "first_lift_off": Variable(
        "time from the first impact to the end of the first contact at which the ball stuck"
    ),
    "end_velocity": Variable("velocity of the ball before that impact"),
    "exponent_sum": Variable("sum of both Lyapunov exponents per period of the table"),
    "second_exponent": Variable("smaller Lyapunov exponent per period of the table"),
    "followed": Variable("number of impacts for which a ball is followed"),
    "in_words": Variable("the kind of the motion, and how long the ball was followed"),
    "start": Variable("start of a ball at one amplitude"),
    "impact": Variable("impact of the motion on which the ball ends"),
    "impact_phase": Variable(
        "phase of the table at an impact of the motion on which the ball ends",
        symbol="φ",
        units="rad",
    ),
    "impact_speed": Variable(
        "speed of the ball towards the table at an impact of the motion on which it ends"
    ),
    "motion_kind": Variable("kind of one of the motions on which balls end"),
    "motion_periods": Variable("periods of the table after which one of the motions repeats"),
    "motion_impacts": Variable("impacts until one of the motions repeats"),
    "share_error": Variable("standard error of a share"),
}

MOST_BALLS = 20_000_000
"""Largest number of balls that are followed at the same time; they take some gigabytes."""
NEIGHBOURS = 32
"""Number of balls that start next to the end of a chaotic motion, to see whether they leave it."""
# Balls start again from the ends of balls that are this many amplitudes away.
_FURTHER = (1, 4)
# Families of orbits beside which balls start, and the difference between their phases.
_FAMILIES = (1, 2, 3)
_BESIDE = 1e-3
# The fractional parts of multiples of these two numbers cover a square evenly.
_EVEN = np.array([0.7548776662466927, 0.5698402909980532])


def motions(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, impacts: int
) -> xr.Dataset:
    """The motions on which a row of balls ends that start with the impacts (Λ, φ, z′_i).

    The variables are the fields of :class:`~bouncing_ball_beyond.motions.motions.Motions`, over
    the row, the dimension "case".

    Raises
    ------
    ModelError
        If there are too many balls, or a state is outside its range.
    """
    require_memory(amplitude.size, "balls", "starts", MOST_BALLS)
    return _in_words(final_motions(model, amplitude, phase, velocity, impacts=impacts))


def _in_words(found: Motions) -> xr.Dataset:
    words = np.array([found[k].in_words() for k in range(found.size)])
    data = _variables(found, (CASE,)) | {"in_words": (CASE, words)}
    return described(data, variables=VARIABLES)


def exponents(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, impacts: int
) -> xr.Dataset:
    """Both Lyapunov exponents of the motions of :func:`motions`, and the kinds of these motions;
    NaN for a motion that looks chaotic and may be a transient (:func:`may_be_transient`).

    Raises
    ------
    ModelError
        If there are too many balls, or a state is outside its range.
    """
    require_memory(NEIGHBOURS * amplitude.size, "balls", "starts", MOST_BALLS)
    found = final_motions(model, amplitude, phase, velocity, impacts=impacts)
    leaves = may_be_transient(model, amplitude, found, impacts)
    found = replace(
        found,
        kind=np.where(leaves, Kind.UNDECIDED, found.kind),
        reason=np.where(leaves, Reason.TRANSIENT, found.reason),
        exponent=np.where(leaves, np.nan, found.exponent),
        exponent_error=np.where(leaves, np.nan, found.exponent_error),
    )
    length = np.where(found.impacts > 0, found.impacts, impacts)
    whole = exponent_sum(model, amplitude, found.end_phase, found.end_velocity, length)
    # Where the ball forgets, both exponents are -∞.
    with np.errstate(invalid="ignore"):
        second = np.where(np.isneginf(found.exponent), found.exponent, whole - found.exponent)
    sums = {"exponent_sum": (CASE, whole), "second_exponent": (CASE, second)}
    names = ["lyapunov_exponent", "lyapunov_error", "kind", "reason", "followed", "in_words"]
    return describe(_in_words(found)[names].assign(sums), VARIABLES)


def may_be_transient(model: Any, amplitude: np.ndarray, found: Motions, impacts: int) -> np.ndarray:
    """Whether a ball leaves a motion that is called chaotic, of a row of motions.

    Balls start next to the last impact of each of these motions, and soon part on it. None of them
    may repeat a motion within as many impacts. In the restitution models none of them may stick to
    the table either, because the ball then starts again from the lift-off, whatever was before.

    Examples
    --------
    At Λ = 4 the elastic ball is chaotic, and at r = 0.8 and Λ = 3.5 balls come to rest in the end:

    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> model, lam = RestitutionModel(np.array([1.0, 0.8])), np.array([4.0, 3.5])
    >>> found = final_motions(model, lam, 0.0, -8.0, impacts=500)
    >>> found.kind.tolist(), may_be_transient(model, lam, found, 500).tolist()
    (['chaotic', 'chaotic'], [False, True])
    """
    (chaotic,) = np.nonzero(found.kind == Kind.CHAOTIC)
    which = np.repeat(chaotic, NEIGHBOURS)
    lam = amplitude[which]
    moved = NEAR * np.arange(1, NEIGHBOURS + 1) / NEIGHBOURS
    last = found.end_phase[which]
    phase = last + np.tile(moved, chaotic.size)
    # With the relative velocity of the last impact, so that no ball rises from the table.
    velocity = found.end_velocity[which] - table(last, lam)[0] + table(phase, lam)[0]
    row = model.flat(amplitude.shape).take(which)
    ends = final_motions(row, lam, phase, velocity, impacts=impacts)
    leaves = ~np.isin(ends.kind, [Kind.CHAOTIC, Kind.UNDECIDED])
    if row.dynamics(lam).forgets:
        leaves |= ends.times_stuck > 0
    transient = np.zeros(amplitude.shape, dtype=bool)
    transient[chaotic] = leaves.reshape(-1, NEIGHBOURS).any(axis=1)
    return transient


def _variables(found: Motions, dims: tuple[str, ...]) -> dict[str, Any]:
    """The fields of motions as the variables of a dataset over these dimensions."""
    renamed = {"exponent": "lyapunov_exponent", "exponent_error": "lyapunov_error"}
    return {renamed.get(name, name): (dims, values) for name, values in vars(found).items()}


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
    number = amplitude.size * balls * samples
    require_memory(number, "balls", "amplitudes, starts or samples", MOST_BALLS)
    lam = amplitude[:, np.newaxis]
    phase, speed = _first_starts(model, lam, starts)
    found = _ends(model, lam, phase, speed, impacts)
    phase, speed = _starts_from_neighbours(found, amplitude)
    swept = _ends(model, lam, phase, speed, impacts)
    found = _beside(found, swept)
    impact_phase, impact_speed = _impacts(model, lam, found, samples)
    dims = ("amplitude", "start")
    data = {
        **_variables(found, dims),
        "impact_phase": ((*dims, "impact"), impact_phase),
        "impact_speed": ((*dims, "impact"), impact_speed),
    }
    return described(data, {"amplitude": amplitude}, VARIABLES)


def _first_starts(model: Any, lam: np.ndarray, starts: int) -> tuple[np.ndarray, np.ndarray]:
    """Phases and speeds of impacts that cover their ranges evenly, and beside n-T orbits.

    Λ has the shape (amplitudes, 1), and the results the shape (amplitudes, balls).
    """
    even = np.mod(0.5 + np.arange(1, starts + 1)[:, np.newaxis] * _EVEN, 1.0)
    even_phase = 2 * np.pi * even[:, 0] - np.pi + 0 * lam
    even_speed = even[:, 1] * fastest(model, lam)
    # More balls start beside the orbits with one impact, which may attract few of the other balls.
    orbit = n_t.orbit(model, np.array(_FAMILIES), np.where(lam > 0, lam, np.nan))
    phase = np.concatenate([even_phase, orbit.phase + _BESIDE], axis=1)
    speed = np.concatenate([even_speed, -orbit.relative_impact_velocity], axis=1)
    return phase, speed


def _starts_from_neighbours(found: Motions, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Phases and speeds of the ends of the first balls at two lower and at two higher Λ."""
    steps = np.multiply.outer([-1, 1], _FURTHER).ravel()
    place = np.arange(amplitude.size)[:, np.newaxis] + steps
    place = np.clip(place, 0, amplitude.size - 1)
    phase = found.end_phase[place, 0]
    velocity = found.end_velocity[place, 0]
    return phase, amplitude[place] * np.cos(phase) - velocity


def _beside(found: Motions, more: Motions) -> Motions:
    """Two groups of motions side by side, along their second axis."""
    return Motions(
        **{
            name: np.concatenate([values, getattr(more, name)], axis=1)
            for name, values in vars(found).items()
        }
    )


def _ends(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, speed: np.ndarray, impacts: int
) -> Motions:
    """The motions of balls that start with impacts of given speeds.

    If the speed is not positive, for example for a ball on the table, the ball starts with speed 1.
    """
    phase = np.nan_to_num(phase)
    speed = np.where(speed > 0, speed, 1.0)
    velocity = amplitude * np.cos(phase) - speed
    return final_motions(model, amplitude, phase, velocity, impacts=impacts)


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
    number = np.expand_dims(np.arange(samples), tuple(range(1, length.ndim + 1)))
    return np.moveaxis(np.where(number >= length, np.nan, seen), 1, -1)


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
    require_memory(starts * starts, "balls", "starts", MOST_BALLS)
    found = basins_of(model, amplitude, starts, fast, impacts)
    share = found.share
    dims = ("start_speed", "start_phase")
    data = {
        "destination": (dims, found.which),
        "lyapunov_exponent": (dims, found.exponent),
        "motion_kind": ("motion", np.array([each.kind for each in found.motions])),
        "motion_periods": ("motion", np.array([each.periods for each in found.motions])),
        "motion_impacts": ("motion", np.array([each.impacts for each in found.motions])),
        "share": ("motion", share),
        "share_error": ("motion", np.sqrt(share * (1 - share) / found.which.size)),
    }
    coords = {"start_phase": found.phase, "start_speed": found.speed}
    return described(data, coords, VARIABLES)
