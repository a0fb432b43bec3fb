"""Basins: the motions on which balls end that start from an even grid of first impacts.

The grid is over the phase of the table and the relative speed of the first impact, up to a speed
above which every impact slows the ball. All quantities are dimensionless, and phases are in
radians.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.motions.destination import IMPACTS, final_motions
from bouncing_ball_beyond.motions.motions import Kind


class MotionName(NamedTuple):
    """A motion by its kind, and by the periods and the impacts after which it repeats."""

    kind: Kind
    periods: int
    impacts: int


@dataclass(frozen=True)
class Basins:
    """The motions on which a grid of balls ends, in no particular order.

    ``which`` is the index of the motion of each start, shape (speed, phase), and ``exponent`` its
    Lyapunov exponent; ``share`` is the share of the starts of each motion.
    """

    phase: np.ndarray
    speed: np.ndarray
    motions: list[MotionName]
    which: np.ndarray
    exponent: np.ndarray
    share: np.ndarray


def fastest(model: Any, amplitude: Any) -> np.ndarray:
    """A speed above which every impact slows the ball, (1 + r) max(Λ, 1)/(1 - r), 1 - r ≥ 0.05.

    An impact changes the absolute speed v of the ball to r v + (1 + r) Λ at most, which is less
    than v above this value. r is that of a free impact with the speed 2π.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> float(fastest(RestitutionModel(0.5), 2.0))
    6.0
    """
    lam = np.asarray(amplitude, dtype=float)
    r = np.asarray(model.signature(2 * np.pi).restitution)
    return (1 + r) * np.maximum(lam, 1.0) / np.maximum(1 - r, 0.05)


def basins(
    model: Any, amplitude: float, starts: int, fast: float | None = None, impacts: int = IMPACTS
) -> Basins:
    """The motions on which ``starts`` by ``starts`` balls end.

    Parameters
    ----------
    model : Model
    amplitude : float
        Excitation amplitude Λ.
    starts : int
        Number of phases, and of speeds.
    fast : float, optional
        The largest relative speed; by default :func:`fastest`.
    impacts : int
        Number of impacts for which a ball is followed at most.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = basins(RestitutionModel(0.5), 0.5, starts=4)
    >>> [str(each.kind) for each in found.motions], found.share.tolist()
    (['permanent contact'], [1.0])
    """
    middle = (np.arange(starts) + 0.5) / starts
    phase = 2 * np.pi * middle - np.pi
    speed = (float(fastest(model, amplitude)) if fast is None else fast) * middle
    start_phase, start_speed = np.meshgrid(phase, speed)
    velocity = amplitude * np.cos(start_phase) - start_speed
    found = final_motions(model, amplitude, start_phase, velocity, impacts=impacts)
    kinds = list(Kind)
    kind_number = np.argmax(found.kind[..., np.newaxis] == np.array(kinds), axis=-1)
    keys = np.stack([kind_number, found.periods, found.impacts], axis=-1).reshape(-1, 3)
    known, which, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    return Basins(
        phase=phase,
        speed=speed,
        motions=[MotionName(kinds[k], int(periods), int(each)) for k, periods, each in known],
        which=which.reshape(found.shape),
        exponent=found.exponent,
        share=count / which.size,
    )
