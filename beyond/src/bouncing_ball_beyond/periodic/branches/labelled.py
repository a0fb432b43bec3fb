"""Branches and curves of periodic orbits as labelled datasets that have their orbits and a figure.

A dataset iterates over the names of its variables; its orbits are those of ``states()``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.datasets.variables import SHARED, Variable
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball_beyond.drawing.result import MADE_BY, Result
from bouncing_ball_beyond.periodic.branches import observables
from bouncing_ball_beyond.periodic.branches.following import Followed
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.saved import KEPT, MOVED, fields_in
from bouncing_ball_beyond.periodic.orbits.special import Special

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_AXES = {"point": Variable("number of the point, in order along the branch")}
_PHASES = ("phase", "release_phase", "special_phase")


class _Orbits(Result):
    """Orbits one after another, with all that they need among the variables.

    A part of them, such as ``found.isel(point=0)``, a copy, a pickled one, and what
    :func:`bouncing_ball_beyond.read_orbits` reads from a netCDF file have their orbits as well.
    """

    __slots__ = ()

    @property
    def _maker(self) -> str:
        return str(self.attrs.get(MADE_BY, "a call"))

    def plot(  # type: ignore[override]
        self,
        path: str | Path | None = None,
        *,
        ax: Axes | Iterable[Axes] | None = None,
        size: tuple[float, float] | None = None,
        font_size: float | None = None,
    ) -> Figure:
        """As for every result; a part of the points, such as a slice, has the figure as well.

        Raises
        ------
        ModelError
            If a dimension has been selected away.
        """
        missing = [name for name in ("point", "special") if name not in self.dims]
        if missing and MADE_BY in self.attrs:
            raise ModelError(
                f"a part of the result of {self._maker} without the dimension {missing[0]!r} has "
                "no figure: select a list or a slice, or plot the whole result"
            )
        return super().plot(path, ax=ax, size=size, font_size=font_size)

    def states(self) -> Iterator[Orbit]:
        """The orbits, one after another.

        Raises
        ------
        ModelError
            If these are the branches of several balls, or if variables are missing.
        """
        return _one_by_one(Orbit(**fields_in(self)))

    def special_states(self) -> list[tuple[str, Orbit]]:
        """The special orbits with their kinds, in order.

        Raises
        ------
        ModelError
            If these are the branches of several balls, or if variables are missing.
        """
        orbits = list(_one_by_one(Orbit(**fields_in(self, "special_"))))
        kinds = [str(kind) for kind in np.ravel(self.special_kind.values)]
        # A branch beside others with more special orbits is filled with places without a kind.
        known = ((kind, orbit) for kind, orbit in zip(kinds, orbits, strict=True) if kind)
        return [(kind, replace(orbit, kind=kind)) for kind, orbit in known]


def _one_by_one(orbits: Orbit) -> Iterator[Orbit]:
    """The orbits of a row, or a single one."""
    if not orbits.shape:
        return iter([orbits])
    return (orbits[k] for k in range(orbits.size))


class FollowedBranch(_Orbits):
    """A branch of orbits with k impacts in m periods along a parameter, or of n-T orbits over Λ.

    The figure shows the phases of the impacts over the parameter.
    """

    __slots__ = ()

    def first(self, kind: str) -> Orbit:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If the branch has none.
        """
        name = chosen("kind", kind, [str(each) for each in Special])
        for here, orbit in self.special_states():
            if here == name:
                return orbit
        end = str(np.ravel(self.end_reason.values)[-1])
        raise NoOrbitError(f"the branch has no {kind}; it ends because {end}")


class SpecialCurve(_Orbits):
    """A curve of special orbits in two parameters; see :class:`FollowedBranch`.

    The orbits of :meth:`states` have the kind of the curve, so that each can be followed. The
    figure shows the curve in the plane of the parameters.
    """

    __slots__ = ()

    def states(self) -> Iterator[Orbit]:
        """The special orbits, one after another."""
        kind = str(self.attrs.get("curve_kind", ""))
        return _one_by_one(replace(Orbit(**fields_in(self)), kind=kind))


def _attributes(problem: OrbitEquations) -> dict[str, Any]:
    """The values of the parameters that do not vary, and k and m."""
    values = problem.balls.values
    changing = {*problem.along}.union(*map(problem.balls.moved_by, problem.along))
    fixed = {name: float(x) for name, x in values.items() if name not in changing}
    return {"impacts": problem.impacts, "periods": int(problem.periods), **fixed}


def labelled(found: Followed, made_by: str, **attributes: str) -> dict[str, Any]:
    """The variables, coordinates and attributes of a branch or a curve, with phases in [-π, π].

    They are the arguments of a dataset, which is made once, because that takes as long as some
    points of a branch.
    """
    variables = observables.branch_variables(found)
    for name in _PHASES:
        dims, values = variables[name]
        variables[name] = dims, reduce_angle(values)
    variables["phase"] = variables["phase"][0], found.with_special.phases[: len(found)]
    along = found.problem.equations.along
    changing = {*along, *(name for name in variables if f"special_{name}" in variables)}
    known = {name: SHARED.get(name, Variable(name.replace("_", " "))) for name in changing}
    names = {f"special_{n}": v._replace(long_name=f"{v.long_name} there") for n, v in known.items()}
    named = SHARED | known | names | observables.OF_BRANCHES | _AXES | KEPT
    data = {name: (*x, named[name].attributes()) for name, x in variables.items()}
    axes = {"point": len(found), "impact": found.problem.equations.impacts, "multiplier": 2}
    coords = {name: (name, np.arange(size)) for name, size in axes.items()}
    coords |= {name: data.pop(name) for name in ("special", "end")}
    of_ball = _attributes(found.problem.equations)
    remembered = found.problem.equations.remembered
    if remembered != along:
        attributes[MOVED] = ", ".join(remembered)
    return {
        "data_vars": data,
        "coords": {name: (*x[:2], named[name].attributes()) for name, x in coords.items()},
        "attrs": {**of_ball, "along": ", ".join(along), **attributes, MADE_BY: made_by},
    }
