"""Orbits and bifurcations as the datasets of figures and tables show them.

Whatever the dimensions of a dataset are, its orbits come out in one row, each
with its own law of the impact, and without the entries that are NaN.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits.model import ImpactModel, Route
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation


class Shown(NamedTuple):
    """Orbits of one model and one n, in a row.

    ``made`` is the route that they come from, ``admissible`` what the dataset
    says of each; where it says nothing the orbits are those of the ball.
    """

    model: ImpactModel
    orbit: Orbit
    admissible: np.ndarray
    made: Route

    def chosen(self, which: np.ndarray) -> "Shown":
        """Some of them."""
        return Shown(self.model[which], self.orbit[which], self.admissible[which], self.made)

    def name(self, k: int) -> str:
        """What an orbit is called in messages."""
        lam = self.orbit[k].amplitude
        model = self.model[k]
        return f"{self.orbit.n}-T orbit at Λ = {lam:.6g}, {model.label}, {model.name} model"


class ShownLimits(NamedTuple):
    """Bifurcations of one kind in a row, each with its model and n.

    Where a dataset shows Λ alone, phase and contact duration are NaN.
    """

    kind: str
    model: ImpactModel
    n: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray
    contact_duration: np.ndarray
    made: Route

    def chosen(self, which: np.ndarray) -> "ShownLimits":
        """Some of them."""
        n, lam, phase, duration = (
            column[which] for column in (self.n, self.amplitude, self.phase, self.contact_duration)
        )
        return ShownLimits(self.kind, self.model[which], n, lam, phase, duration, self.made)

    def name(self, k: int) -> str:
        """What a bifurcation is called in messages."""
        model = self.model[k]
        where = f"Λ = {self.amplitude[k]:.6g}, {model.label}, {model.name} model"
        return f"{self.kind} of the {self.n[k]}-T orbits at {where}"


def _of(data: xr.Dataset, name: str) -> xr.DataArray:
    """A variable, or the parameter of that name."""
    return data[name] if name in data else xr.DataArray(data.attrs[name])


def _row(*columns: xr.DataArray) -> list[np.ndarray]:
    """Columns that belong together, in one row, without the NaN entries of the first."""
    flat = [column.values.ravel() for column in xr.broadcast(*columns)]
    there = np.isfinite(flat[0])
    return [column[there] for column in flat]


def _made(data: xr.Dataset) -> Route:
    return Route.CONTINUATION if "special_kind" in data else Route.FORMULA


def contact_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the spring-damper model in a dataset."""
    if "contact_duration" not in data:
        return
    admissible = data["admissible"] if "admissible" in data else xr.DataArray(True)
    duration, r, omega, lam, phase, velocity, admissible = _row(
        data.contact_duration,
        _of(data, "restitution"),
        data.frequency_ratio,
        _of(data, "amplitude"),
        data.phase,
        data.impact_velocity,
        admissible,
    )
    model = SpringDamperModel(SpringDamper.from_restitution(r, omega, data.attrs["release"]))
    orbit = model.orbit_of(int(data.attrs["n"]), lam, phase, duration, velocity)
    yield Shown(model, orbit, admissible.astype(bool), _made(data))


def restitution_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the restitution model in a dataset, family by family."""
    r = data.attrs.get("restitution")
    if "restitution_amplitude" in data:
        names = "restitution_amplitude", "restitution_phase", "restitution_admissible"
        families = {int(data.attrs["n"]): data}
    elif "release" in data.attrs or "phase" not in data:
        return
    else:
        names = "amplitude", "phase", "admissible"
        families = (
            {int(n): data.sel(n=n) for n in data.n.values}
            if "n" in data.dims
            else {int(data.attrs["n"]): data}
        )
    for n, family in families.items():
        allowed = family[names[2]] if names[2] in family else xr.DataArray(True)
        lam, phase, admissible = _row(_of(family, names[0]), family[names[1]], allowed)
        # At Λ = 0 (r = 1) the table is at rest, and φ means nothing.
        there = lam > 0
        model = RestitutionModel(np.full(int(there.sum()), r))
        orbit = model.orbit_of(n, lam[there], phase[there])
        yield Shown(model, orbit, admissible[there].astype(bool), Route.FORMULA)


def _located(data: xr.Dataset) -> Iterator[ShownLimits]:
    """Bifurcations that a continuation located: along branches, or in Table 1."""
    if "special_kind" in data:
        kinds, amplitudes = data.special_kind, data.special_amplitude
        rows = {kind: amplitudes.where(kinds == kind) for kind in Bifurcation}
        families = xr.DataArray(data.attrs["n"])
    else:
        rows = {kind: data.computed.sel(bound=kind) for kind in Bifurcation}
        families = data.n
    for kind, amplitudes in rows.items():
        place = data[["special_phase", "special_contact_duration"]]
        place = place.sel(bound=kind) if "bound" in place.dims else place
        lam, omega, n, phase, duration = _row(
            amplitudes,
            data.frequency_ratio,
            families,
            place.special_phase,
            place.special_contact_duration,
        )
        contact = SpringDamper.from_restitution(
            data.attrs["restitution"], omega, data.attrs["release"]
        )
        model = SpringDamperModel(contact)
        yield ShownLimits(kind, model, n.astype(int), lam, phase, duration, Route.CONTINUATION)


def _along_frequency_ratio(data: xr.Dataset) -> Iterator[ShownLimits]:
    """Bifurcations of the formula, under each rule that ends a contact."""
    for rule in data.release.values:
        for kind in Bifurcation:
            shown = data.bifurcation_amplitude.sel(release=rule, bound=kind)
            lam, omega, n = _row(shown, data.frequency_ratio, data.n)
            contact = SpringDamper(omega, float(data.damping_ratio), Release(str(rule)))
            unknown = np.full_like(lam, np.nan)
            model = SpringDamperModel(contact)
            yield ShownLimits(kind, model, n.astype(int), lam, unknown, unknown, Route.FORMULA)


def _of_restitution(data: xr.Dataset, families: list[int]) -> Iterator[ShownLimits]:
    """Both bifurcations of each family; at r = 1 the saddle-node is at Λ = 0."""
    r = data.attrs["restitution"]
    if r == 1:
        return
    n = np.array(families)
    model = RestitutionModel(np.full(len(n), r))
    for kind, name in zip(Bifurcation, ("saddle_node", "period_doubling"), strict=True):
        orbit = getattr(model, name)(n)
        lam, phase = orbit.amplitude, np.broadcast_to(orbit.phase, n.shape)
        if f"{name}_amplitude" in data:
            shown = data[[f"{name}_amplitude", f"{name}_phase"]]
            shown = shown.sel(impact_map="exact") if "impact_map" in shown.dims else shown
            lam, phase = (np.atleast_1d(shown[part].values) for part in shown)
        yield ShownLimits(kind, model, n, lam, phase, np.zeros_like(lam), Route.FORMULA)


def orbits(data: xr.Dataset) -> Iterator[Shown]:
    """All orbits of a dataset, model by model and family by family."""
    yield from contact_orbits(data)
    yield from restitution_orbits(data)


def limits(data: xr.Dataset) -> Iterator[ShownLimits]:
    """All bifurcations of a dataset."""
    if "bifurcation_amplitude" in data:
        yield from _along_frequency_ratio(data)
    if "special_phase" in data:
        yield from _located(data)
    families = [int(shown.orbit.n) for shown in restitution_orbits(data)]
    if families:
        yield from _of_restitution(data, families)
