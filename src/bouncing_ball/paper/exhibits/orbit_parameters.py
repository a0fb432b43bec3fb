"""Types of parameters that require an orbit: amplitudes at which an orbit exists.

A type reads the parameters ``n`` and ``restitution``, which are declared before it in its class.
"""

from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from pydantic import AfterValidator, ValidationInfo

from bouncing_ball.datasets.parameters import (
    Amplitude,
    AmplitudeMax,
    Family,
    Many,
    Parameters,
    Restitution,
    Span,
    Tolerance,
    number,
)
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.periodic.one_impact.restitution_branch import saddle_node


def require_orbit(amplitude: float, n: int, restitution: float) -> float:
    """The amplitude Λ itself, if the restitution model has its n-T orbit there (Eq. 7).

    Raises
    ------
    ValueError
        One line that gives the lowest amplitude.
    ModelError
        Unless n is a positive integer and 0 < r ≤ 1.

    Examples
    --------
    >>> require_orbit(1.0, 1, 0.85)
    1.0
    """
    lowest = float(saddle_node(n, restitution))
    if amplitude < lowest:
        raise ValueError(
            f"must be at least {lowest:.6g}, the saddle-node of the {n}-T restitution orbit at "
            f"r = {restitution:g} (Eq. 7)"
        )
    return amplitude


def require_any_orbit(exists: np.ndarray, n: int, amplitude: ArrayLike, ratios: np.ndarray) -> None:
    """Raise an error if none of the orbits along the frequency ratios exists.

    Raises
    ------
    NoOrbitError
        One line with the amplitudes and the range of ϖ.

    Examples
    --------
    >>> require_any_orbit(np.array([False]), 1, [0.6, 1.0], np.array([0.1, 0.2]))
    Traceback (most recent call last):
    bouncing_ball.errors.NoOrbitError: nothing to draw: no 1-T orbit at Λ = 0.6, 1 for any ϖ from \
0.1 to 0.2; stiffer contacts, of a larger ϖ, have one
    """
    if not np.any(exists):
        levels = ", ".join(f"{x:g}" for x in np.unique(amplitude))
        raise NoOrbitError(
            f"nothing to draw: no {n}-T orbit at Λ = {levels} for any ϖ from {ratios[0]:g} to "
            f"{ratios[-1]:g}; stiffer contacts, of a larger ϖ, have one"
        )


def _has_orbits(families: Callable[[np.ndarray], int]) -> AfterValidator:
    def check(amplitude: float, info: ValidationInfo) -> float:
        # If n or r is missing or wrong, that mistake is reported instead.
        if {"n", "restitution"} <= info.data.keys():
            n = families(np.atleast_1d(info.data["n"]))
            require_orbit(amplitude, n, info.data["restitution"])
        return amplitude

    return AfterValidator(check)


OrbitAmplitude = Annotated[Amplitude, _has_orbits(min)]
"""Λ at which the family, or the lowest of several families, has an orbit."""


class OrbitParameters(Parameters):
    """One orbit by its family, r and Λ, at which the restitution model has an orbit too."""

    n: Family
    restitution: Restitution
    amplitude: OrbitAmplitude


class OrbitsAlongRatio(OrbitParameters):
    """One orbit of the restitution model, on contacts along a grid of ϖ."""

    frequency_ratio: Span


class OrbitErrors(OrbitsAlongRatio):
    """One orbit along ϖ, and the tolerated relative error of a simple model."""

    tolerance: Tolerance


BranchEnd = Annotated[AmplitudeMax, _has_orbits(max)]
"""Λ up to which branches are followed, at or above the saddle-node of the highest family."""

BranchPoints = Annotated[
    int,
    number(
        "number of points along each branch; fewer than 11 do not show its shape", ge=11, le=20001
    ),
]


class FamilyBranches(Parameters):
    """Several families, followed along Λ."""

    n: Many[Family]
    restitution: Restitution
    amplitude_max: BranchEnd
    points: BranchPoints
