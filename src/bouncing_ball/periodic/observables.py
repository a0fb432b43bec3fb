"""Quantities of orbits, and of branches with their special orbits and ends, as datasets have them.

The variables of a branch are the observables along it, over the dimension ``point``, and the place
of each special orbit, over ``special``: its bifurcations, and the grazing orbits, at which the
orbits become inadmissible.
"""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets import GRAZING
from bouncing_ball.datasets.variables import Variable
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.numerics.continuation import resample
from bouncing_ball.periodic.branch import WholeBranch
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.stability import Bifurcation

VARIABLES = {
    "special": Variable("special point of the branch, in order of arclength"),
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("excitation amplitude at the special point", symbol="Λ"),
    "special_phase": Variable(
        "phase at the special point", symbol="φ", units="rad", equation="Eq. 21"
    ),
    "special_contact_duration": Variable(
        "contact duration at the special point", symbol="τ_b", equation="Eq. 23", budget=1e-12
    ),
    "special_arclength": Variable(
        "arclength of the branch up to the special point, over that of the whole branch",
        budget=1e-4,
        scale="1",
    ),
    "special_residual": Variable(
        "residual of the extended system at the special point", budget=1e-12, scale="1"
    ),
    "multiplier": Variable("Floquet multiplier, the larger modulus first", symbol="μ"),
    "multiplier_real": Variable("real part of the Floquet multiplier", symbol="Re μ"),
    "multiplier_imag": Variable("imaginary part of the Floquet multiplier", symbol="Im μ"),
    "residual": Variable(
        "largest defect of the orbit equations", equation="Eqs. 21-26", budget=1e-12, scale="1"
    ),
    "end": Variable("end of the branch"),
    "end_reason": Variable("why the branch ends there"),
}

OBSERVED = (
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
)
"""The quantities of orbits along a branch or along ϖ."""

PLACE = ("amplitude", "phase", "contact_duration")
"""The quantities of special orbits that the datasets contain."""


def columns(orbit: Orbit, *names: str) -> dict[str, np.ndarray]:
    """The named quantities of orbits, with the stability and the admissibility of the orbits.

    Every array has the shape of the orbits.

    Examples
    --------
    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> found = columns(Orbit.of(RestitutionModel(1.0), 1, 0.5, np.pi / 2), "phase")
    >>> found
    {'phase': 1.5707963267948966, 'stable': False, 'admissible': True}
    """
    judged = {"stable": orbit.is_stable(), "admissible": orbit.is_admissible()}
    return {name: getattr(orbit, name) for name in names} | judged


def branch_columns(found: WholeBranch, count: int) -> xr.Dataset:
    """A branch at ``count`` points with equal steps of arclength, and its special orbits.

    The variables are those of :func:`orbits_in_columns`, and ``special_arclength``, the place of
    each special orbit among the points; grazing orbits are found between the points.

    Raises
    ------
    ContinuationError
        If the steps along the branch were too long for it to be resampled.
    """
    branch = found.branch
    y = resample(found.problem, branch, count)
    points = []
    kinds = []
    for special in branch.special:
        if special.name in list(Bifurcation):
            points.append(special.point)
            kinds.append(str(special.name))
    for point in found.problem.grazing(y):
        points.append(point)
        kinds.append(GRAZING)
    special = np.array(points).reshape(-1, y.shape[-1])
    place = _places(special, y)
    order = np.argsort(place)
    special_orbits = found.orbit(special[order])
    ends = [str(branch.start), str(branch.end)]
    columns = orbits_in_columns(found.orbit(y), special_orbits, [kinds[k] for k in order], ends)
    return columns.assign(special_arclength=("special", place[order]))


def _places(special: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The places of special points among the points of a branch, which have equal steps, as shares
    of its arclength.

    A special point lies between the two neighbours to which it makes the smallest detour.

    Examples
    --------
    >>> y = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    >>> _places(np.array([[0.5, 0.0], [1.0, 1.0]]), y).tolist()
    [0.25, 1.0]
    """
    distance = np.linalg.norm(special[:, np.newaxis] - y, axis=-1)
    step = np.linalg.norm(np.diff(y, axis=0), axis=-1)
    before = np.argmin(distance[:, :-1] + distance[:, 1:] - step, axis=-1)
    row = np.arange(len(special))
    behind = distance[row, before]
    ahead = distance[row, before + 1]
    return (before + behind / (behind + ahead)) / (len(y) - 1)


def orbits_in_columns(
    orbit: Orbit, special: Orbit, kinds: list[str], ends: list[str]
) -> xr.Dataset:
    """Orbits along a branch, its special orbits with their kinds, and the reasons for its two ends.

    Over ``point``, the dataset has the observables of the orbits, with phases in rad, and
    ``amplitude``, ``stable``, ``admissible`` and ``residual``. The multipliers are over (point,
    multiplier), ``special_…`` over ``special``, and ``end_reason`` over ``end``, where the end of
    the unstable side comes first.
    """
    along = columns(orbit, "amplitude", *OBSERVED) | {"residual": orbit.defect()}
    data: dict[str, Any] = {name: ("point", values) for name, values in along.items()}
    floquet = orbit.multipliers()
    data["multiplier_real"] = ("point", "multiplier"), floquet.real
    data["multiplier_imag"] = ("point", "multiplier"), floquet.imag
    data["special_kind"] = "special", np.array(kinds, dtype=object)
    for name in PLACE:
        data[f"special_{name}"] = "special", getattr(special, name)
    data["special_residual"] = "special", special.defect()
    data["end_reason"] = "end", ends
    # Numbers, so that branches with different numbers of special points are aligned.
    coords = {"special": np.arange(len(kinds)), "end": ["unstable side", "stable side"]}
    return xr.Dataset(data, coords)


def no_branch(count: int, error: Exception) -> xr.Dataset:
    """A dataset like that of :func:`branch_columns`, of NaN, with the error as its end reasons."""
    none = Orbit.of(RestitutionModel(1.0), 1, np.full(count, np.nan), np.nan)
    found = orbits_in_columns(none, none[:0], [], [str(error)] * 2)
    return found.assign(special_arclength=("special", np.empty(0)))


def joined(branches: list[xr.Dataset], dim: str) -> xr.Dataset:
    """Branches along a new dimension; those with fewer special orbits are filled with NaN."""
    whole = xr.concat(branches, dim, join="outer")
    return whole.assign(special_kind=whole.special_kind.fillna("").astype(str))
