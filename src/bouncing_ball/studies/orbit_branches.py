"""Existence and stability of n-T orbits by continuation along Λ (Figs. 8 and 9)."""

from typing import Annotated

import xarray as xr

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.continuation.branch import Branch, ContinuationError
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.columns import branch_columns, joined, no_branch, whole_branch
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.system import OrbitSystem
from bouncing_ball.parameters import (
    Family,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    listed,
)
from bouncing_ball.studies.parameters import BranchEnd, Points


class Continuation(Parameters):
    """Settings of the continuation for the whole run."""

    largest_step: Annotated[float, listed("largest_step")]


class Branches(Parameters):
    """One family of orbits, which is followed along Λ."""

    n: Family
    restitution: LossyRestitution
    amplitude_max: BranchEnd
    points: Points


class Domains(Branches):
    """One family, followed along Λ on several contacts."""

    frequency_ratio: Many[FrequencyRatio]


class Ranges(Parameters):
    """Several families on several contacts, whose ranges of stability in Λ are computed."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd


def followed(
    n: int, ratio: float, given: Branches, release: Release, continuation: Continuation
) -> tuple[OrbitSystem, Branch]:
    """The equations of one contact, and their solutions from the unstable to the stable side.

    Raises
    ------
    NoOrbitError, ContinuationError
        As :func:`~bouncing_ball.orbits.columns.whole_branch`.
    """
    model = SpringDamperModel(SpringDamper.from_restitution(given.restitution, ratio, release))
    found = whole_branch(model, n, given.amplitude_max, continuation.largest_step)
    return model.system(n), found


def _branch(
    ratio: float, parameters: Branches, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    try:
        branch = followed(parameters.n, ratio, parameters, release, continuation)
        found = branch_columns(*branch, parameters.points)
    except (NoOrbitError, ContinuationError) as error:
        found = no_branch(parameters.points, error)
    return found.assign_coords(frequency_ratio=ratio)


def orbit_branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ (Figs. 8 and 9).

    The dataset has ``amplitude``, the observables of the orbits with phases in rad, ``stable``,
    ``admissible`` and ``residual`` (ϖ, point), at equal steps of arclength from the unstable to the
    stable side; ``multiplier_real`` and ``multiplier_imag`` (ϖ, point, multiplier);
    ``special_kind`` and further ``special_…`` variables of the saddle-nodes, period doublings and
    grazing orbits (ϖ, special); and ``end_reason`` (ϖ, end), why the branch ends. Where a branch
    cannot be followed its values are NaN and ``end_reason`` is the error.
    """
    ratios = parameters.frequency_ratio
    rows = [_branch(ratio, parameters, release, continuation) for ratio in ratios]
    return describe(joined(rows, "frequency_ratio"))
