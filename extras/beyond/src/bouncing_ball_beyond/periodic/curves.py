"""Curves of special orbits in two parameters.

A curve solves the equations of an orbit and one more equation, which sets the test function of the
kind to zero (docs/equations.md).

Source: Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, chapter 9.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import brief
from bouncing_ball_beyond.periodic.branches import SpecialCurve, followed, joined
from bouncing_ball_beyond.periodic.equations import (
    KINDS,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
)
from bouncing_ball_beyond.periodic.forms import SUCH
from bouncing_ball_beyond.periodic.march import Start, newton, unit
from bouncing_ball_beyond.periodic.paths import path_of, usual_range
from bouncing_ball_beyond.periodic.switches import SWITCH

OTHER = 1e-3
"""Largest change that Newton's method may make to a start, relative to 1 + max |z|.

A larger change means that the start was not a special orbit of the kind.
"""


def special_curve(
    special: PeriodicOrbit,
    *,
    along: tuple[str, str] = ("amplitude", "restitution"),
    ranges: Mapping[str, tuple[float, float]] | None = None,
    points: int = 400,
) -> SpecialCurve:
    """Follow a special orbit along two parameters, in both directions.

    Parameters
    ----------
    special : PeriodicOrbit
        Special orbit of a branch, such as ``branch.first("saddle-node")``. A period halving is
        followed as the period doubling of the orbit of half the period.
    along : tuple of two names
        Two parameters as in `follow`, but not amplitude and frequency, which both change Λ.
    ranges : mapping of names to (low, high), optional
        Values of the parameters at which the curve ends. The default values of ``low`` and ``high``
        are a tenth of the value at the start, and the larger of 10 and ten times this value. The
        default range of a phase is half a turn in each direction.
    points : int
        Maximum number of orbits in each direction.

    Raises
    ------
    OrbitNotFound
        If no curve starts at the orbit.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, follow, orbit
    >>> doubling = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8).first("period doubling")
    >>> curve = special_curve(doubling, ranges={"amplitude": (0.5, 3.0), "restitution": (0.1, 1.0)})
    >>> curve.end
    'restitution = 1 is reached'
    """
    equations, z = _start(special, along)
    window = _limits(equations, z, special, ranges)
    first = newton(equations, z[np.newaxis])
    if not first.converged[0]:
        raise OrbitNotFound(f"no {equations.kind} is found: Newton's method does not converge")
    if not np.abs(first.z - z).max() < OTHER * (1 + np.abs(z).max()):
        raise OrbitNotFound(
            f"the orbit is not a {equations.kind}: Newton's method finds another orbit"
        )
    directions = unit(first.tangent) * [[-1], [1]]
    nothing = np.full(2, np.nan), np.full(2, "")
    both = Start(equations, np.tile(first.z, (2, 1)), directions, *nothing)
    return joined(*followed(both, np.array([window, window]), [None, None], points, ""))


def _start(special: Any, along: Any) -> tuple[OrbitEquations, NDArray]:
    """Equations of the special orbits on the curve, and the special orbit at its start."""
    if not isinstance(special, PeriodicOrbit):
        raise ValueError(f"special = {brief(special)}: must be a special orbit of a branch, {SUCH}")
    if (
        not isinstance(along, tuple | list)
        or len(along) != 2
        or along[0] == along[1]
        or {*map(str, along)} == {"amplitude", "frequency"}
    ):
        raise ValueError(
            f"along = {brief(along)}: must be the names of two different parameters, such as"
            " ('amplitude', 'restitution'); 'frequency' already changes the amplitude"
        )
    # The equations of a curve are singular where branches end, and at a switch of a release.
    allowed = {kind for kind in KINDS if not KINDS[kind].end} - {SWITCH} | {"period halving"}
    if special.kind not in allowed:
        raise OrbitNotFound(
            f"kind = {special.kind!r}: a curve must start at a special orbit of a branch:"
            f" {', '.join(sorted(allowed, key=str.lower))}"
        )
    paths = tuple(path_of(name, special.ball, special.table) for name in along)
    equations, z = special.on(*paths)
    if special.kind == "period halving":
        half, rows = equations.halved(z[np.newaxis])
        return replace(half, kind="period doubling"), rows[0]
    return replace(equations, kind=special.kind), z


def _limits(equations: OrbitEquations, z: NDArray, special: PeriodicOrbit, ranges: Any) -> NDArray:
    """Minima and maxima of both parameters, shape (2, 2). The first row has the minima."""
    wanted = {} if ranges is None else ranges
    if not isinstance(wanted, Mapping) or any(
        np.size(limits) != 2 or np.asarray(limits).dtype.kind not in "iuf"
        for limits in wanted.values()
    ):
        raise ValueError(
            f"ranges = {brief(ranges)}: must be a mapping of names to (low, high), such as"
            " {'amplitude': (0.5, 3.0)}"
        )
    wanted = dict(wanted)
    ends = []
    for path, value in zip(equations.along, z[equations.size :], strict=True):
        least, greatest = path.limits(special.ball, special.amplitude)
        usual = usual_range(path, value, least, greatest)
        low, high = wanted.pop(path.name, usual)
        if not max(low, least) <= value <= min(high, greatest):
            raise ValueError(f"{path.name} = {value:.10g} is not in its range, [{low:g}, {high:g}]")
        ends.append((max(low, least), min(high, greatest)))
    if wanted:
        names = " and ".join(path.name for path in equations.along)
        raise ValueError(f"ranges: {', '.join(wanted)}: the parameters of the curve are {names}")
    return np.array(ends).T
