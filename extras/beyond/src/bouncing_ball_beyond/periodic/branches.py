"""Branches of orbits along one parameter, and curves of special orbits along two parameters."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from bouncing_ball_beyond.periodic.equations import (
    CHANGES,
    KINDS,
    SINGULAR,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
)
from bouncing_ball_beyond.periodic.march import (
    AT_GOAL,
    CLOSED,
    TOO_FAST,
    Start,
    ends_at,
    march,
    newton,
)
from bouncing_ball_beyond.periodic.search import single
from bouncing_ball_beyond.periodic.special_orbits import crossings_of, divided, halved_at, located
from bouncing_ball_beyond.periodic.switches import SWITCH, SWITCHED, beyond_switch, switch_of


@dataclass(frozen=True, eq=False, repr=False)
class FollowedBranch:
    """Branch of periodic orbits along a parameter, in the order in which they were followed.

    Parameters
    ----------
    equations : OrbitEquations
        Equations that the orbits solve.
    z : ndarray, shape (points, N)
        Unknowns of the orbits, one row for each.
    special : tuple of PeriodicOrbit
        Special orbits in their order on the branch. The special orbit at which the branch starts is
        left out.
    start, end : str
        Where the branch starts, and why it ends.
    """

    equations: OrbitEquations
    z: NDArray
    special: tuple[PeriodicOrbit, ...]
    start: str
    end: str

    def __repr__(self) -> str:
        first, last = self.values[[0, -1]]
        kind = self.equations.kind
        name = type(self).__name__ + (kind and f": {kind}")
        kinds = ", ".join(
            f"{special.kind} at {special.z[-1]:.8g}{_unfollowed(special)}"
            for special in self.special
        )
        rows = {
            "orbits": len(self),
            "impacts": self.impacts,
            "periods": self.periods,
            "along": f"{self.along}, {first:.6g} to {last:.6g}",
            "special orbits": kinds or "none",
            "start": self.start,
            "end": self.end,
        }
        return "\n".join([name, *(f"  {name:16}{row}" for name, row in rows.items())])

    def __len__(self) -> int:
        return len(self.z)

    @property
    def impacts(self) -> int:
        """Number k of impacts in one period of the orbits."""
        return self.equations.impacts

    @property
    def periods(self) -> int:
        """Number m of periods of the table in one period of the orbits."""
        return int(self.equations.periods)

    @property
    def along(self) -> str:
        """Name of the parameter that changes; for a curve, the names of both parameters."""
        return " and ".join(path.name for path in self.equations.along)

    @property
    def values(self) -> NDArray:
        """Values of the parameter that changes, shape (points,).

        For a curve these are the values of its second parameter.
        """
        return self.z[:, -1]

    @cached_property
    def orbits(self) -> tuple[PeriodicOrbit, ...]:
        """All orbits, each as a `PeriodicOrbit`."""
        return tuple(self.equations.orbit(row, self.equations.kind) for row in self.z)

    @cached_property
    def stable(self) -> NDArray:
        """Whether each orbit is stable, shape (points,)."""
        return self.equations.stable(self.equations.linearized(self.z))

    @cached_property
    def admissible(self) -> NDArray:
        """Whether a ball follows each orbit, shape (points,)."""
        return self.equations.admissible(self.z)

    def refined(self, spacing: float = 0.04) -> "FollowedBranch":
        """Return the branch with additional orbits. Lines through all orbits then look smooth.

        Parameters
        ----------
        spacing : float
            Maximum distance between neighbouring orbits. It combines two changes: the root mean
            square change of the times and speeds of the impacts, and the relative change of the
            parameter. At most 50 orbits are added in a step of the branch.
        """
        if len(self) < 2:
            return self
        units = self.equations.scales(self.z[:-1])
        chords = np.diff(self.z, axis=0)
        counts = np.ceil(np.linalg.norm(chords / units, axis=1) / spacing).astype(int).clip(1, 50)
        which = np.repeat(np.arange(len(chords)), counts)
        share = np.concatenate([np.arange(count) / count for count in counts])[:, np.newaxis]
        guess = self.z[which] + share * chords[which]
        solution = newton(self.equations, guess, (chords / units**2)[which])
        good = solution.converged | (share[:, 0] == 0)
        z = np.where(share == 0, guess, solution.z)[good]
        return replace(self, z=np.concatenate([z, self.z[-1:]]))

    def first(self, kind: str) -> PeriodicOrbit:
        """First special orbit of a kind, such as "saddle-node" or "period doubling".

        Spaces and hyphens are equivalent. Raises OrbitNotFound if there is no such orbit.
        """
        for special in self.special:
            if _plain(special.kind) == _plain(kind):
                return special
        others = ", ".join(dict.fromkeys(special.kind for special in self.special)) or "none"
        raise OrbitNotFound(f"no {kind} here; special orbits: {others}")

    def zeros(self, function: Callable[[PeriodicOrbit], float]) -> list[PeriodicOrbit]:
        """Find the orbits at which a function of the orbit is zero, in order.

        Parameters
        ----------
        function : callable
            Continuous function of an orbit, such as ``lambda orbit: orbit.max_height - 5.0``. A
            zero is found if its sign changes between two successive orbits of the branch.

        Examples
        --------
        >>> from bouncing_ball_beyond import Rigid, follow, orbit
        >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.1)
        >>> zeros = branch.zeros(lambda orbit: orbit.max_height - 5.5)
        >>> [round(zero.amplitude, 6) for zero in zeros]
        [1.189988]
        """
        values = np.array([function(orbit) for orbit in self.orbits])
        orbits = []
        for i in np.flatnonzero(np.diff(values >= 0)).tolist():
            share = brentq(lambda share, i=i: function(self._inside(i, share)), 0, 1, xtol=1e-14)
            orbits.append(self._inside(i, share))
        return orbits

    def _inside(self, i: int, share: float) -> PeriodicOrbit:
        """Orbit at a share of the step from orbit i to the next one."""
        chord = self.z[[i + 1]] - self.z[[i]]
        normal = chord / self.equations.scales(self.z[[i]]) ** 2
        solution = newton(self.equations, self.z[[i]] + share * chord, normal)
        return self.equations.orbit(solution.z[0], self.equations.kind)

    def with_special(self) -> list[PeriodicOrbit]:
        """All orbits and special orbits in order.

        Each special orbit is inserted into the step whose length increases least.
        """
        orbits = list(self.orbits)
        units = self.equations.scales(self.z)[0]
        points = self.z / units
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        for special in reversed(self.special):
            distance = np.linalg.norm(points - special.z / units, axis=1)
            place = int(np.argmin(distance[:-1] + distance[1:] - steps)) if len(steps) else 0
            orbits.insert(place + 1, special)
        return orbits


class SpecialCurve(FollowedBranch):
    """Curve of special orbits of one kind along two parameters."""

    @property
    def kind(self) -> str:
        """Kind of the special orbits."""
        return self.equations.kind


def _unfollowed(special: PeriodicOrbit) -> str:
    """Text on a special orbit that no ball follows; rounding would decide on one that grazes."""
    decided = special.kind in CHANGES and special.obstacle
    return f" ({special.obstacle})" if decided else ""


def _plain(kind: object) -> str:
    """Kind of a special orbit in small letters, without hyphens and dashes."""
    return str(kind).lower().replace("-", " ").replace("\N{EN DASH}", " ")


def joined(back: Any, forth: Any) -> Any:
    """Join two branches that leave one orbit in opposite directions.

    The joined branch has the direction of ``forth``.
    """
    if forth.end == CLOSED:
        return replace(forth, start=CLOSED)
    return replace(
        forth,
        z=np.concatenate([back.z[:0:-1], forth.z]),
        special=(*back.special[::-1], *forth.special),
        start=back.end,
    )


def followed(
    start: Start,
    window: NDArray,
    until: Sequence[str | None] | NDArray,
    points: int,
    own: str,
    grazings: bool = True,
) -> list[Any]:
    """Follow branches, and locate the special orbits on them.

    A special orbit of the kind ``own`` in the first step is the start of the branch, and is left
    out. Grazings of flights and releases take most of the time, and may be left out.
    """
    steps = [
        (divided(single(start.equations, i), path), end)
        for i, (path, end) in enumerate(march(start, window, until, points))
    ]
    row = np.repeat(np.arange(len(steps)), [len(points.z) for points, _ in steps])
    every = zip(*(points for points, _ in steps), strict=True)
    z, slopes, tests, _ = (np.concatenate(parts) for parts in every)
    crossings = crossings_of(start.equations, row, z, slopes, tests, grazings)
    z, is_located = np.empty((2, 0))
    if len(crossings.row):
        z, is_located = located(start.equations, crossings)
    branches: list[Any] = []
    switches: list[tuple] = []
    for i, (path, end) in enumerate(steps):
        equations = single(start.equations, i)
        stop = len(path.z) if end in (TOO_FAST, "lost release") else 0
        passed: list[tuple] = []
        for j in np.flatnonzero(crossings.row == i):
            kind = str(crossings.kind[j])
            number = crossings.number[j]
            here = z[j] if is_located[j] else None
            if kind == "period halving":
                here = None if equations.kind else halved_at(equations, crossings.ends[:, j])
            if here is not None and not (number == 0 and kind == own):
                place = crossings.slopes[0, j] @ (here - crossings.ends[0, j])
                # Special orbits at the same point have the order of `kinds`. For example, a flight
                # may vanish where an impact grazes and a release is lost.
                order = number, round(place, 6), [*equations.kinds, kind].index(kind)
                passed.append((order, equations.orbit(here, kind)))
        passed.sort(key=itemgetter(0))
        orbits = path.z
        kinds = [orbit.kind for _, orbit in passed]
        ends = [j for j, kind in enumerate(kinds) if ends_at(kind, until[i], equations.kind)]
        if ends:
            passed = passed[: ends[0] + 1]
            (number, *_), last = passed[-1]
            stop = number + 2 if last.kind == "lost release" else 0
            orbits = np.vstack([orbits[: number + 1], last.z])
            why = KINDS[last.kind].end if last.kind in KINDS else ""
            end = f"{last.kind} at {_place(equations, last.z)}" + (why and f": {why}")
        elif end in KINDS:
            # The special orbit is between the last two points, but Newton's method does not find
            # it, or the branch approaches it for ever.
            why = KINDS[end].end and f": {KINDS[end].end}"
            end = f"{end} near {_place(equations, orbits[-1], 7)}{why}"
            orbits = orbits[:-1]
            passed = [crossing for crossing in passed if crossing[0][0] + 1 < len(orbits)]
        else:
            end = _in_words(end, equations, orbits[-1], window[i], start.goal[i], passed)
        switch = switch_of(equations, path.z[:stop]) if stop else None
        if stop and not switch and equations.at_switch(path.z[[stop - 1]]):
            several = "curves and orbits with several impacts are not followed across it"
            end = f"{SWITCH} near {_place(equations, orbits[-1], 7)}: {several}"
        if switch:
            before, at, ahead = switch
            # Beyond the switch, the contacts of this part of the branch end too late.
            passed = [
                crossing
                for crossing in passed
                if crossing[0][0] + 1 < len(before)
                or equations.surface_share(crossing[1].z[np.newaxis])[0] > SWITCHED
            ]
            passed.append(((len(before),), equations.orbit(at, SWITCH)))
            orbits = np.vstack([before, at])
            end = f"{SWITCH} at {_place(equations, at)}"
            switches.append((i, at, ahead))
        special = tuple(orbit for _, orbit in passed)
        kind_of_branch = SpecialCurve if equations.kind else FollowedBranch
        branches.append(kind_of_branch(equations, orbits, special, "", end))
    for i, at, ahead in switches:
        first = branches[i]
        here = start.take([i])
        beyond = beyond_switch(here.equations, at, ahead, here.goal)
        if beyond.reasons[0] or len(first) + 2 > points:
            why = beyond.reasons[0] or f"the maximum of {points} points is reached"
            branches[i] = replace(first, end=f"{first.end}: {why}")
            continue
        (second,) = followed(beyond, window[[i]], [until[i]], points - len(first), "", grazings)
        special = first.special + second.special
        z = np.concatenate([first.z, second.z])
        branches[i] = replace(first, z=z, special=special, end=second.end)
    return branches


def _place(equations: OrbitEquations, z: NDArray, digits: int = 10) -> str:
    """Text with the values of the parameters that change."""
    values = zip(equations.along, z[equations.size :], strict=True)
    return ", ".join(f"{path.name} = {value:.{digits}g}" for path, value in values)


def _in_words(
    end: str,
    equations: OrbitEquations,
    z: NDArray,
    window: NDArray,
    goal: float,
    passed: list[tuple],
) -> str:
    """Text with the reason why a branch ends at an ordinary orbit."""
    if end == CLOSED:
        return end
    if end != AT_GOAL:
        last = equations.orbit(z)
        tests = equations.tests(z[np.newaxis], last._linear)[0, SINGULAR]
        nearest = equations.kinds[SINGULAR][int(np.abs(tests).argmin())]
        size = abs(last.multipliers[0])
        return (
            f"{end}; the last one, at {_place(equations, z)}, has a Floquet multiplier of modulus"
            f" {size:.3g}, and the next event of its impacts is a {nearest}"
        )
    values = z[equations.size :]
    j = np.flatnonzero((values == window).any(axis=0))[-1]
    name = equations.along[j].name
    here = f"{name} = {values[j]:.10g}"
    if len(values) > 1 or abs(values[j] - goal) <= 1e-12 * abs(goal):
        return f"{here} is reached"
    folds = [orbit.z[-1] for _, orbit in passed if orbit.kind == "saddle-node"]
    turned = f": {name} = {goal:.10g} is beyond the saddle-node at {folds[0]:.10g}" if folds else ""
    return f"{here} is reached, on the other side of the start than the goal{turned}"
