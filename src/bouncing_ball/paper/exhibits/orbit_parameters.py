"""Types of parameters that require an orbit: amplitudes at which an orbit exists.

A type reads the parameters ``n`` and ``restitution``, which are declared before it in its class.
Those of frequency ratios read the amplitude and the release rule of the run as well.
"""

from collections.abc import Callable, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from pydantic import AfterValidator, ValidationInfo

from bouncing_ball.datasets.parameters import (
    Amplitude,
    AmplitudeMax,
    Family,
    FrequencyRatio,
    Many,
    Parameters,
    Restitution,
    Span,
    Tolerance,
    number,
)
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import Release
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Side
from bouncing_ball.periodic.restitution_branch import restitution_saddle_node

# The next frequency ratio that has an orbit is sought among so many, up to the largest, and then
# so many times between two of them, which gives six digits.
_STIFFER = 60
_REFINED = 4
_LARGEST = 1e6
# The amplitudes at which the orbits of a branch are sought, over the largest.
_ON_BRANCH = np.linspace(0.1, 1.0, 10)


def require_amplitude(amplitude: float, n: int, restitution: float) -> float:
    """The amplitude Λ itself, if the restitution model has its n-T orbit there (Eq. 7).

    Raises
    ------
    ValueError
        One line that gives the lowest amplitude.
    ModelError
        Unless n is a positive integer and 0 < r ≤ 1.

    Examples
    --------
    >>> require_amplitude(1.0, 1, 0.85)
    1.0
    """
    lowest = float(restitution_saddle_node(n, restitution))
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


class OrbitsOfContacts(NamedTuple):
    """n-T orbits at some of the amplitudes, on contacts of one r and one release rule.

    On either side of the branch, or on the stable side and admissible.
    """

    n: int
    restitution: float
    amplitudes: np.ndarray
    release: Release
    admissible: bool = False

    def exists(self, ratios: ArrayLike) -> np.ndarray:
        """Whether contacts of the ratios ϖ have an orbit at one of the amplitudes, shape (k,).

        Examples
        --------
        >>> orbits = OrbitsOfContacts(1, 0.85, np.array([1.0]), Release.DISPLACEMENT)
        >>> orbits.exists([0.1, 10.0]).tolist()
        [False, True]
        """
        column = np.asarray(ratios)[:, np.newaxis]
        contacts = SpringDamper.from_restitution(self.restitution, column, self.release)
        branch = explicit_branch(contacts)
        stable = branch.orbit(self.n, self.amplitudes)
        found = stable.admissible if self.admissible else stable.exists
        there = found.any(axis=-1)
        if self.admissible or there.all():
            return there
        return there | branch.orbit(self.n, self.amplitudes, Side.UNSTABLE).exists.any(axis=-1)

    def next_stiffer(self, ratio: float) -> float:
        """The smallest ϖ above this one, on which there is none, that has one; or infinity."""
        low = ratio
        high = _LARGEST
        for _ in range(_REFINED):
            stiffer = np.geomspace(low, high, _STIFFER)
            there = np.flatnonzero(self.exists(stiffer[1:]))
            if not there.size:
                return np.inf
            low, high = stiffer[there[0] : there[0] + 2]
        return float(high)

    def require(self, ratios: Sequence[float]) -> None:
        """Raise an error if there is no orbit on any of these contacts.

        Raises
        ------
        ValueError
            One line that gives the next larger ϖ at which there is one.
        """
        if self.exists(ratios).any():
            return
        at = "=" if self.amplitudes.size == 1 else "up to"
        limit = self.next_stiffer(max(ratios))
        known = f"the next that has one is {limit:.6g}" if np.isfinite(limit) else "no larger has"
        raise ValueError(
            f"must be the ϖ of a contact with a {self.n}-T orbit at r = {self.restitution:g} and "
            f"Λ {at} {self.amplitudes.max():g}: {known}"
        )


def _orbits(info: ValidationInfo, amplitude: str, share: np.ndarray) -> OrbitsOfContacts | None:
    """The orbits that parameters ask for at shares of an amplitude; None if the release rule of
    the run is not known, or if a parameter is missing or wrong, which is reported instead.
    """
    run: Any = info.context or {}
    rule = run.get("release")
    given = info.data
    if not {"n", "restitution", amplitude} <= given.keys() or rule not in [*map(str, Release)]:
        return None
    return OrbitsOfContacts(
        given["n"], given["restitution"], given[amplitude] * share, Release(rule)
    )


def _on_contact(ratio: float, info: ValidationInfo) -> float:
    if orbit := _orbits(info, "amplitude", np.ones(1)):
        orbit._replace(admissible=True).require([ratio])
    return ratio


def _on_branch(ratio: float, info: ValidationInfo) -> float:
    if branch := _orbits(info, "amplitude_max", _ON_BRANCH):
        branch.require([ratio])
    return ratio


def _on_some_branch(ratios: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
    # A contact without a branch is named in the figure of the others.
    if branch := _orbits(info, "amplitude_max", _ON_BRANCH):
        branch.require(ratios)
    return ratios


ContactRatio = Annotated[FrequencyRatio, AfterValidator(_on_contact)]
"""ϖ of a contact that has an orbit of the family at Λ."""
BranchRatio = Annotated[FrequencyRatio, AfterValidator(_on_branch)]
"""ϖ of a contact that has orbits of the family up to the largest Λ."""
BranchRatios = Annotated[Many[FrequencyRatio], AfterValidator(_on_some_branch)]
"""ϖ of contacts of which at least one has such orbits."""


def _has_orbits(families: Callable[[np.ndarray], int]) -> AfterValidator:
    def check(amplitude: float, info: ValidationInfo) -> float:
        # If n or r is missing or wrong, that mistake is reported instead.
        if {"n", "restitution"} <= info.data.keys():
            n = families(np.atleast_1d(info.data["n"]))
            require_amplitude(amplitude, n, info.data["restitution"])
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
    """One orbit along ϖ, and the tolerated relative error of the restitution model."""

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
