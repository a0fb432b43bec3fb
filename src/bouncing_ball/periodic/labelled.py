"""Branches and curves of periodic orbits as labelled datasets that iterate and draw themselves."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
import xarray as xr

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.datasets.variables import SHARED, Variable, described
from bouncing_ball.drawing.result import MADE_BY, Result
from bouncing_ball.errors import ModelError
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic import observables, stability
from bouncing_ball.periodic.curves import Curve
from bouncing_ball.periodic.following import Followed
from bouncing_ball.periodic.orbit import Orbit, orbit_at
from bouncing_ball.periodic.problem import PeriodicOrbits
from bouncing_ball.periodic.simulation import is_admissible
from bouncing_ball.periodic.special import Special

if TYPE_CHECKING:
    from matplotlib.figure import Figure

VARIABLES = {
    "special_point": Variable("number of the last point of the branch before the special orbit"),
}
_IMPACT = {"impact": Variable("number of the impact within the orbit")}
_ALL = observables.VARIABLES | VARIABLES | _IMPACT


class _Orbits(Result):
    """Orbits one after another; a part of them, such as ``found.isel(point=0)``, is plain data,
    which has no orbits.
    """

    __slots__ = ("_found",)

    maker: ClassVar[str]

    @classmethod
    def of_orbits(cls, found: Followed | Curve, **attributes: str) -> Self:
        """The labelled result of a branch or a curve."""
        data = _columns(found).assign_attrs(_attributes(found.problem) | attributes)
        result = cls.of(data, cls.maker)
        result._found = found
        return result

    @property
    def _whole(self) -> Any:
        """The branch or curve of which these are the data.

        Raises
        ------
        ModelError
            If this is a part of a result.
        """
        found = getattr(self, "_found", None)
        if found is None:
            raise ModelError(
                f"a part of the result of {self.maker} is plain data, without orbits: "
                "call the method of the whole result"
            )
        return found

    def plot(self, path: str | Path | None = None) -> Figure:  # type: ignore[override]
        """As for every result; a part of the points, such as a slice, has the figure as well.

        Raises
        ------
        ModelError
            If a dimension has been selected away.
        """
        missing = [name for name in ("point", "special", "impact") if name not in self.dims]
        if missing and MADE_BY in self.attrs:
            raise ModelError(
                f"a part of the result of {self.maker} without the dimension {missing[0]!r} is "
                f"plain data, without a figure: select a list or a slice, or plot the whole result"
            )
        return super().plot(path)

    def states(self) -> Iterator[Orbit]:
        """The orbits, one after another."""
        return iter(self._whole)


class FollowedBranch(_Orbits):
    """A branch of orbits with k impacts in m periods along a parameter.

    The figure shows the phases of the impacts over the parameter.
    """

    __slots__ = ()

    maker = "follow"

    def special_states(self) -> list[tuple[str, Orbit]]:
        """The special orbits with their kinds, in order."""
        return [(orbit.kind, orbit) for orbit in self._whole.special]

    def first(self, kind: str) -> Orbit:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If the branch has none.
        """
        name = chosen("kind", kind, [str(each) for each in Special])
        return self._whole.first(Special(name))


class SpecialCurve(_Orbits):
    """A curve of special orbits in two parameters; see :class:`FollowedBranch`.

    The figure shows the curve in the plane of the parameters.
    """

    __slots__ = ()

    maker = "curve"


def _before(points: np.ndarray, special: np.ndarray) -> int:
    """The number of the last point of a branch before a special orbit, which makes the shortest
    detour from this point to the next.
    """
    lengths = np.linalg.norm(points - special, axis=1)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    detours = lengths[:-1] + lengths[1:] - chords
    return int(np.argmin(detours)) if detours.size else 0


def _attributes(problem: PeriodicOrbits) -> dict[str, Any]:
    """The values of the parameters that do not vary, and k and m."""
    values = problem.balls.values
    varied = {name: values[name] for name in problem.along}
    changing = varied.keys() | problem.balls.model.implied(varied).keys()
    fixed = {name: float(x) for name, x in values.items() if name not in changing}
    return {"impacts": problem.impacts, "periods": int(problem.periods), **fixed}


def _of_impacts(problem: PeriodicOrbits, y: np.ndarray) -> dict[str, np.ndarray]:
    """The quantities of :data:`.observables.OBSERVED` at each impact, shape (..., k)."""
    shape = (*y.shape[:-1], problem.impacts)
    if not y.size:
        return {name: np.empty(shape) for name in observables.OBSERVED}
    orbits = orbit_at(problem, y)
    found = {name: np.reshape(getattr(orbits, name), shape) for name in observables.OBSERVED}
    for name in ("phase", "release_phase"):
        found[name] = reduce_angle(found[name])
    return found


def _columns(found: Followed | Curve) -> xr.Dataset:
    """The orbits along a branch or a curve, its special orbits, and the reasons of its two ends."""
    problem = found.problem
    along = problem.along
    special = found.special_points
    y = found.branch.points
    trace, determinant = problem.trace_and_determinant(y)
    floquet = stability.multipliers(trace, determinant)
    values = problem.values(y)
    data: dict[str, Any] = {name: ("point", values[name]) for name in along}
    impacts = _of_impacts(problem, y)
    data |= {name: (("point", "impact"), impacts[name]) for name in observables.OBSERVED}
    data["stable"] = "point", stability.is_stable(trace, determinant)
    data["admissible"] = "point", is_admissible(problem, y)
    data["multiplier_real"] = ("point", "multiplier"), floquet.real
    data["multiplier_imag"] = ("point", "multiplier"), floquet.imag
    data["residual"] = "point", np.abs(problem.residual(y)).max(axis=-1)
    data["special_kind"] = "special", np.array([str(each.name) for each in special], dtype=str)
    points = np.array([each.point for each in special]).reshape(len(special), y.shape[1])
    places = problem.values(points)
    for name in along:
        data[f"special_{name}"] = "special", places[name]
    impacts = _of_impacts(problem, points)
    for name in ("phase", "contact_duration"):
        data[f"special_{name}"] = ("special", "impact"), impacts[name]
    data["special_point"] = "special", np.array([_before(y, each) for each in points], dtype=int)
    data["end_reason"] = "end", [str(found.branch.start), str(found.branch.end)]
    known = {name: SHARED.get(name, Variable(name.replace("_", " "))) for name in along}
    names = {f"special_{n}": v._replace(long_name=f"{v.long_name} there") for n, v in known.items()}
    coords = {"special": np.arange(len(special)), "end": ["start", "end"]}
    return described(data, coords, variables=_ALL | known | names)
