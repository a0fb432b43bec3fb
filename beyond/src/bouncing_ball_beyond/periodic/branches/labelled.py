"""Branches and curves of periodic orbits as a user has them: records, and datasets when asked for.

:func:`~bouncing_ball_beyond.follow` makes a :class:`FollowedBranch`. Its labels, the stability and
the admissibility of its orbits cost as much as the branch, so that they are in a
:class:`BranchDataset`, made when one asks for it. A dataset iterates over the names of its
variables; its orbits are those of ``states()``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bouncing_ball_beyond.drawing.result import MADE_BY, Result
from bouncing_ball_beyond.inherited.datasets.arguments import chosen
from bouncing_ball_beyond.inherited.datasets.variables import SHARED, Variable
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.attributes import Suggesting
from bouncing_ball_beyond.periodic.branches import observables
from bouncing_ball_beyond.periodic.branches.following import Followed
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.saved import KEPT, MOVED, fields_in
from bouncing_ball_beyond.periodic.orbits.special import Degenerate, Special

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_AXES = {"point": Variable("number of the point, in order along the branch")}
_PHASES = ("phase", "release_phase", "special_phase")
CURVE = "curve_kind"
"""The attribute with the kind of the orbits of a curve."""


@dataclass(frozen=True, repr=False, eq=False)
class FollowedBranch(Suggesting):
    """Orbits with k impacts in m periods followed along a parameter, or special orbits along two.

    A start or an end at a value of the parameter has this value up to a rounding error.

    Its length is the number of its orbits. With two parameters it is a curve, whose orbits have
    their :attr:`kind`, so that each of them can be followed.

    Examples
    --------
    >>> import bouncing_ball_beyond as bb
    >>> found = bb.follow(bb.orbit(bb.rigid(restitution=0.85), amplitude=0.9), to=1.2)
    >>> found
    FollowedBranch
      orbits                5
      impacts               1
      periods               1
      along                 amplitude, 0.9 to 1.2
      special orbits        period doubling
      start                 starting point
      end                   amplitude = 1.2 is reached
    >>> found.orbits.is_stable().tolist()
    [True, True, True, False, False]
    """

    _found: Followed
    kind: str = ""

    _elsewhere = "; its orbits and its to_dataset() have the quantities of the orbits"

    def __len__(self) -> int:
        return len(self._found)

    def __repr__(self) -> str:
        equations = self._found.problem.equations
        ends = equations.values(self._found.branch.points[[0, -1]]).items()
        kinds = [kind for kind, _ in self.special_states()]
        rows = {
            "orbits": f"{len(self)} {self.kind}".strip(),
            "impacts": self.impacts,
            "periods": self.periods,
            "along": "; ".join(f"{name}, {x[0]:.6g} to {x[1]:.6g}" for name, x in ends),
            "special orbits": ", ".join(kinds) or "none",
            "start": self.start_reason,
            "end": self.end_reason,
        }
        return "\n".join([type(self).__name__, *(f"  {k:<22}{x}" for k, x in rows.items())])

    @property
    def impacts(self) -> int:
        """k, the number of impacts of each orbit."""
        return self._found.problem.equations.impacts

    @property
    def periods(self) -> int:
        """m, the number of periods of the table in which each orbit repeats."""
        return int(self._found.problem.equations.periods)

    @property
    def along(self) -> tuple[str, ...]:
        """The names of the one or two parameters."""
        return self._found.problem.equations.along

    @property
    def start_reason(self) -> str:
        """Why the branch begins where it does."""
        return str(self._found.branch.start)

    @property
    def end_reason(self) -> str:
        """Why the branch ends."""
        return str(self._found.branch.end)

    @cached_property
    def orbits(self) -> Orbit:
        """The orbits in order, as one row."""
        return replace(self._found.with_special[: len(self)], kind=self.kind)

    def states(self) -> Iterator[Orbit]:
        """The orbits, one after another."""
        return _one_by_one(self.orbits)

    def special_states(self) -> list[tuple[str, Orbit]]:
        """The special orbits with their kinds, in order."""
        kinds = [str(each.name) for each in self._found.special_points]
        orbits = _one_by_one(self._found.with_special[len(self) :])
        return [
            (kind, replace(orbit, kind=kind)) for kind, orbit in zip(kinds, orbits, strict=True)
        ]

    def first(self, kind: str) -> Orbit:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If the branch has none.
        """
        return _first(kind, self.special_states(), self.end_reason)

    def to_dataset(self) -> BranchDataset:
        """The orbits with their observables, stability and admissibility, as labelled data.

        They are the parameter at each ``point``, ``phase``, ``contact_duration`` and the other
        observables of :func:`bouncing_ball_beyond.branch` for each ``impact``, and whether the
        orbit is ``stable`` and ``admissible``; ``special_kind`` and the place of the special
        orbits; and ``end_reason`` for both ends.

        Examples
        --------
        >>> import bouncing_ball_beyond as bb
        >>> one = bb.orbit(bb.spring_damper(restitution=0.85, frequency_ratio=10.0), amplitude=1.0)
        >>> data = bb.follow(one, to=1.2).to_dataset()
        >>> data.special_amplitude.values.round(6).tolist()
        [1.037456]
        """
        return BranchDataset(**_labelled(self._found, self.kind))

    def plot(
        self,
        path: str | Path | None = None,
        *,
        ax: Axes | Iterable[Axes] | None = None,
        size: tuple[float, float] | None = None,
        font_size: float | None = None,
    ) -> Figure:
        """The phases of the impacts over the parameter, or a curve in the plane of its parameters;
        as for every result.
        """
        return self.to_dataset().plot(path, ax=ax, size=size, font_size=font_size)


class BranchDataset(Result):
    """Orbits one after another, with all that they need among the variables.

    A part of them, such as ``found.isel(point=0)``, a copy, a pickled one, and what
    :func:`bouncing_ball_beyond.read_orbits` reads from a netCDF file have their orbits as well.
    """

    __slots__ = ()

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
                f"a part of the result of {self.attrs[MADE_BY]} without the dimension "
                f"{missing[0]!r} has no figure: select a list or a slice, or plot the whole result"
            )
        return super().plot(path, ax=ax, size=size, font_size=font_size)

    def states(self) -> Iterator[Orbit]:
        """The orbits, one after another; those of a curve have its kind.

        Raises
        ------
        ModelError
            If these are the branches of several balls, or if variables are missing.
        """
        kind = str(self.attrs.get(CURVE, ""))
        return _one_by_one(replace(Orbit(**fields_in(self)), kind=kind))

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

    def first(self, kind: str) -> Orbit:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If the branch has none.
        """
        end = str(np.ravel(self.end_reason.values)[-1])
        return _first(kind, self.special_states(), end)


def _one_by_one(orbits: Orbit) -> Iterator[Orbit]:
    """The orbits of a row, or a single one."""
    if not orbits.shape:
        return iter([orbits])
    return (orbits[k] for k in range(orbits.size))


def _first(kind: str, special: list[tuple[str, Orbit]], end: str) -> Orbit:
    """The first special orbit of a kind on a branch that ends for a reason."""
    name = chosen("kind", kind, [*map(str, (*Special, *Degenerate))])
    for here, orbit in special:
        if here == name:
            return orbit
    raise NoOrbitError(f"the branch has no {kind}; it ends because {end}")


def _attributes(problem: OrbitEquations) -> dict[str, Any]:
    """The values of the parameters that do not vary, and k and m."""
    values = problem.balls.values
    changing = {*problem.along}.union(*map(problem.balls.moved_by, problem.along))
    fixed = {name: float(x) for name, x in values.items() if name not in changing}
    return {"impacts": problem.impacts, "periods": int(problem.periods), **fixed}


def _labelled(found: Followed, curve_kind: str) -> dict[str, Any]:
    """The variables, coordinates and attributes of a branch, or of a curve of special orbits of a
    kind, with phases in [-π, π].

    They are the arguments of a dataset, which is made once, because that takes as long as some
    points of a branch.
    """
    attributes = {MADE_BY: "curve", CURVE: curve_kind} if curve_kind else {MADE_BY: "follow"}
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
        "attrs": {**of_ball, "along": ", ".join(along), **attributes},
    }
