"""Branches and curves of periodic orbits as labelled datasets that iterate and draw themselves."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import xarray as xr

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.datasets.variables import SHARED, Variable, describe
from bouncing_ball.drawing.result import MADE_BY, Result
from bouncing_ball.errors import ModelError
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.branches import observables
from bouncing_ball.periodic.branches.following import Orbits
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.problem import PeriodicOrbits
from bouncing_ball.periodic.orbits.special import Special

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_AXES = {
    "point": Variable("number of the point, in order along the branch"),
    "impact": Variable("number of the impact within the orbit"),
}
_PHASES = ("phase", "release_phase", "special_phase")


class _Orbits(Result):
    """Orbits one after another; a part of them, such as ``found.isel(point=0)``, is plain data,
    which has no orbits.
    """

    __slots__ = ("_found",)

    @classmethod
    def of_orbits(cls, data: xr.Dataset, made_by: str, found: Orbits | None) -> Self:
        """The labelled result of a call; ``found`` are the orbits of a single branch or curve."""
        result = cls.of(data, made_by)
        result._found = found
        return result

    @property
    def _maker(self) -> str:
        return str(self.attrs.get(MADE_BY, "a call"))

    @property
    def _whole(self) -> Any:
        """The branch or curve of which these are the data.

        Raises
        ------
        ModelError
            If this is a part of a result, or several branches.
        """
        if not hasattr(self, "_found"):
            raise ModelError(
                f"a part of the result of {self._maker} is plain data, without orbits: "
                "call the method of the whole result"
            )
        if self._found is None:
            raise ModelError(
                "the branches of several balls are plain data, without orbits: "
                f"call {self._maker} for each ball"
            )
        return self._found

    def plot(self, path: str | Path | None = None) -> Figure:  # type: ignore[override]
        """As for every result; a part of the points, such as a slice, has the figure as well.

        Raises
        ------
        ModelError
            If a dimension has been selected away.
        """
        needed = ("point", "special", *(("impact",) if "impacts" in self.attrs else ()))
        missing = [name for name in needed if name not in self.dims]
        if missing and MADE_BY in self.attrs:
            raise ModelError(
                f"a part of the result of {self._maker} without the dimension {missing[0]!r} is "
                f"plain data, without a figure: select a list or a slice, or plot the whole result"
            )
        return super().plot(path)

    def states(self) -> Iterator[Orbit]:
        """The orbits, one after another."""
        return iter(self._whole)


class FollowedBranch(_Orbits):
    """A branch of orbits with k impacts in m periods along a parameter, or of n-T orbits over Λ.

    The figure shows the phases of the impacts over the parameter.
    """

    __slots__ = ()

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


def _attributes(problem: PeriodicOrbits) -> dict[str, Any]:
    """The values of the parameters that do not vary, and k and m."""
    values = problem.balls.values
    varied = {name: values[name] for name in problem.along}
    changing = varied.keys() | problem.balls.model.implied(varied).keys()
    fixed = {name: float(x) for name, x in values.items() if name not in changing}
    return {"impacts": problem.impacts, "periods": int(problem.periods), **fixed}


def labelled(found: Orbits) -> xr.Dataset:
    """The dataset of a branch or a curve, with phases in [-π, π]."""
    data = observables.branch_columns(found)
    turned = {name: data[name].copy(data=reduce_angle(data[name].values)) for name in _PHASES}
    along = found.problem.orbits.along
    known = {name: SHARED.get(name, Variable(name.replace("_", " "))) for name in along}
    names = {f"special_{n}": v._replace(long_name=f"{v.long_name} there") for n, v in known.items()}
    whole = describe(data.assign(turned), observables.VARIABLES | _AXES | known | names)
    return whole.assign_attrs(_attributes(found.problem.orbits))
