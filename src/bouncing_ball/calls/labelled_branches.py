"""Branches and curves of periodic orbits as labelled datasets that iterate and draw themselves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Self

import numpy as np
import xarray as xr

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.datasets.variables import SHARED, Variable, described
from bouncing_ball.drawing.result import Result
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic import observables, stability
from bouncing_ball.periodic.curves import Curve
from bouncing_ball.periodic.family import AMPLITUDE as LAMBDA
from bouncing_ball.periodic.following import Followed, State
from bouncing_ball.periodic.problem import PeriodicOrbits
from bouncing_ball.periodic.simulation import is_admissible
from bouncing_ball.periodic.special import Special

VARIABLES = {
    "special_point": Variable("number of the last point of the branch before the special orbit"),
}
_IMPACT = {"impact": Variable("number of the impact within the orbit")}
_ALL = observables.VARIABLES | VARIABLES | _IMPACT


class _Orbits(Result):
    """Orbits one after another; a part of them, such as ``found.isel(point=0)``, has no states."""

    __slots__ = ("_found",)

    @classmethod
    def of_orbits(cls, found: Followed | Curve, made_by: str, **attributes: str) -> Self:
        """The labelled result of a branch or a curve."""
        data = _columns(found).assign_attrs(_attributes(found.orbits) | attributes)
        result = cls.of(data, made_by)
        result._found = found
        return result

    def states(self) -> Iterator[State]:
        """The orbits, one after another."""
        return iter(self._found)


class FollowedBranch(_Orbits):
    """A branch of orbits with k impacts in m periods along a parameter.

    The figure shows the phases of the impacts over the parameter.
    """

    __slots__ = ()

    def special_states(self) -> list[tuple[str, State]]:
        """The special orbits with their kinds, in order."""
        return [(str(kind), state) for kind, state in self._found.special]

    def first(self, kind: str) -> State:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If the branch has none.
        """
        name = chosen("kind", kind, [str(each) for each in Special])
        return self._found.first(Special(name))


class SpecialCurve(_Orbits):
    """A curve of special orbits in two parameters; see :class:`FollowedBranch`.

    The figure shows the curve in the plane of the parameters.
    """

    __slots__ = ()


def _before(points: np.ndarray, special: np.ndarray) -> int:
    """The number of the last point of a branch before a special orbit, which makes the shortest
    detour from this point to the next.
    """
    lengths = np.linalg.norm(points - special, axis=1)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    detours = lengths[:-1] + lengths[1:] - chords
    return int(np.argmin(detours)) if detours.size else 0


def _attributes(orbits: Any) -> dict[str, Any]:
    """The values of the parameters that do not vary, and k and m."""
    family = orbits.family
    varied = {name: family.values[name] for name in orbits.along}
    changing = varied.keys() | family.implied(varied).keys()
    fixed = {name: x for name, x in family.values.items() if name not in changing}
    return {"impacts": orbits.impacts, "periods": int(orbits.periods), **fixed}


def _of_impacts(orbits: PeriodicOrbits, y: np.ndarray) -> dict[str, np.ndarray]:
    """The quantities of :data:`.observables.OBSERVED` at each impact, shape (..., k)."""
    legs = orbits.legs(y)
    if not y.size:
        return dict.fromkeys(observables.OBSERVED, legs.duration)
    lam = np.repeat(_amplitude(orbits, y), orbits.impacts)
    flight = legs.departure.flight
    phase = legs.impact.phase
    release_phase = legs.departure.phase
    found = {
        "phase": reduce_angle(phase),
        "contact_duration": legs.duration,
        "release_phase": reduce_angle(release_phase),
        "impact_velocity": legs.impact.velocity + lam * np.cos(phase),
        "bounce_velocity": flight.velocity + lam * np.cos(release_phase),
        "apparent_restitution": -flight.velocity / legs.impact.velocity,
    }
    return {name: np.reshape(values, legs.duration.shape) for name, values in found.items()}


def _amplitude(orbits: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """Λ of orbits in a row."""
    lam = orbits.values(y).get(LAMBDA, orbits.family.values[LAMBDA])
    return np.broadcast_to(lam, y.shape[:-1])


def _columns(found: Followed | Curve) -> xr.Dataset:
    """The orbits along a branch or a curve, its special orbits, and the reasons of its two ends."""
    orbits = found.orbits
    along = orbits.along
    special = found.special
    y = found.branch.points
    trace, determinant = orbits.trace_and_determinant(y)
    floquet = stability.multipliers(trace, determinant)
    values = orbits.values(y)
    data: dict[str, Any] = {name: ("point", values[name]) for name in along}
    impacts = _of_impacts(orbits, y)
    data |= {name: (("point", "impact"), impacts[name]) for name in observables.OBSERVED}
    data["stable"] = "point", stability.is_stable(trace, determinant)
    data["admissible"] = "point", is_admissible(orbits, y)
    data["multiplier_real"] = ("point", "multiplier"), floquet.real
    data["multiplier_imag"] = ("point", "multiplier"), floquet.imag
    data["residual"] = "point", np.abs(orbits.residual(y)).max(axis=-1)
    data["special_kind"] = "special", np.array([str(kind) for kind, _ in special], dtype=str)
    for name in along:
        places = [state.parameters[name] for _, state in special]
        data[f"special_{name}"] = "special", np.array(places, dtype=float)
    points = np.array([state.y for _, state in special]).reshape(len(special), y.shape[1])
    impacts = _of_impacts(orbits, points)
    for name in ("phase", "contact_duration"):
        data[f"special_{name}"] = ("special", "impact"), impacts[name]
    data["special_point"] = "special", np.array([_before(y, each) for each in points], dtype=int)
    data["end_reason"] = "end", [str(found.branch.start), str(found.branch.end)]
    known = {name: SHARED.get(name, Variable(name.replace("_", " "))) for name in along}
    places = {
        f"special_{n}": v._replace(long_name=f"{v.long_name} there") for n, v in known.items()
    }
    coords = {"special": np.arange(len(special)), "end": ["start", "end"]}
    return described(data, coords, variables=_ALL | known | places)
