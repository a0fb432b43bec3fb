r"""The corrected restitution model against the exact contact (beyond the paper).

Errors are relative to the exact contact's model as in Eqs. 37-38,
``|q_SD - q|/|q|`` with q of the restitution model *of the contact's own r*, or
of the corrected one. The law of the first order is that of
:mod:`bouncing_ball.orbits.error_law`.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits import error_law
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.orbit import OBSERVABLES
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation, Side
from bouncing_ball.studies.error_thresholds import (
    Quantity,
    ThresholdStatus,
    excess,
    relative_error,
    status,
    thresholds,
    values,
)
from bouncing_ball.studies.last_crossing import last_crossing
from bouncing_ball.studies.parameters import grid

QUANTITIES = tuple(error_law.FirstOrder._fields)
"""Those that have a corrected value; permanent contact has no impact to repair."""
SIMPLE = ("restitution", "corrected")
"""The models that are compared with the exact one."""


def models(contact: SpringDamper) -> tuple[SpringDamperModel, RestitutionModel, CorrectedModel]:
    """The exact model of a contact, and the simple ones with the contact's own r."""
    return (
        SpringDamperModel(contact),
        RestitutionModel(contact.restitution),
        CorrectedModel.of_contact(contact),
    )


def errors(contact: SpringDamper, n, amplitude, quantities=QUANTITIES) -> np.ndarray:
    """Signed relative errors, exact over simple model minus one; (model, quantity, ...)."""
    shape = np.broadcast_shapes(contact.shape, np.shape(n), np.shape(amplitude))
    exact, *simple = (
        np.stack([np.broadcast_to(q, shape) for q in values(quantities, model, n, amplitude)])
        for model in models(contact)
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([exact / q - 1 for q in simple])


class Search(NamedTuple):
    """From which ϖ on each model is right, of several orbits; (model, quantity, orbit)."""

    threshold: np.ndarray
    """NaN where the status is not ``FOUND``."""
    status: np.ndarray
    zero: np.ndarray
    """Where the restitution model's error passes through zero by accident, the largest ϖ;
    (quantity, orbit), NaN if it does not."""


def search(
    zeta,
    rule: Release,
    n,
    amplitude,
    ratios: np.ndarray,
    tolerance: float,
    quantities: Sequence[str] = QUANTITIES,
) -> Search:
    """Thresholds and zeros of the errors, on a grid and then to the last digit.

    ``zeta``, ``n`` and ``amplitude`` are those of the orbits, one-dimensional.
    """
    zeta, n, lam = np.broadcast_arrays(zeta, n, amplitude)
    shape = len(SIMPLE), len(quantities), lam.size

    # Those of the orbit together, as one search finds it; the bifurcations each alone.
    orbital = [k for k, name in enumerate(quantities) if name in OBSERVABLES]
    groups = [orbital, *([k] for k in range(len(quantities)) if k not in orbital)]
    count, simplest = np.prod(shape), lam.size * len(quantities)

    def error(ratio: np.ndarray, number: np.ndarray) -> np.ndarray:
        """Signed errors of numbered (model, quantity, orbit), each at its own ϖ."""
        model, quantity, orbit = np.unravel_index(number, shape)
        found = np.empty(len(number))
        for group in groups:
            at = np.flatnonzero(np.isin(quantity, group))
            if at.size:
                contact = SpringDamper(ratio[at], zeta[orbit[at]], rule)
                names = [quantities[k] for k in group]
                both = errors(contact, n[orbit[at]], lam[orbit[at]], names)
                place = np.searchsorted(group, quantity[at])
                found[at] = both[model[at], place, np.arange(at.size)]
        return found

    def crossing(ratio: np.ndarray, number: np.ndarray) -> np.ndarray:
        """What changes sign at a threshold; numbers beyond are for the zeros of the errors."""
        signed = error(ratio, number % count)
        return np.where(number < count, excess(_finite(signed), tolerance), signed)

    signed = errors(SpringDamper(ratios[:, np.newaxis], zeta, rule), n, lam, quantities)
    scanned = np.moveaxis(signed, 2, -1).reshape(-1, ratios.size)
    outside = _finite(scanned) > tolerance
    # The restitution model's errors come first.
    scan = np.concatenate([excess(_finite(scanned), tolerance), scanned[:simplest]])
    threshold, zero = np.split(last_crossing(crossing, ratios, scan), [count])
    return Search(
        np.where(outside[:, -1], np.nan, threshold).reshape(shape),
        np.array([str(status(row)) for row in outside]).reshape(shape),
        zero.reshape(shape[1:]),
    )


_STIFF = 500.0
"""ϖ at which the second order is all of the corrected model's error, and rounding none of it."""


def _second_order(zeta: float, rule: Release, n, amplitude) -> np.ndarray:
    """C of each quantity: the corrected model's relative error is C/ϖ² + O(1/ϖ³).

    Measured at two stiff contacts, and the third order taken off (Richardson).
    """
    ratios = np.array([_STIFF, 2 * _STIFF])
    once, twice = (errors(SpringDamper(ratios, zeta, rule), n, amplitude)[1] * ratios**2).T
    return 2 * twice - once


def _finite(error: np.ndarray) -> np.ndarray:
    """The modulus, infinite where one of the models lacks the quantity."""
    return np.where(np.isnan(error), np.inf, np.abs(error))


def error_law_table(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """K, and the frequency ratio for a tolerance: exact, by the law, corrected."""
    n, lam, tolerance = (parameters[k] for k in ("n", "amplitude", "tolerance"))
    ratios, rule = grid(parameters["frequency_ratio"]), Release.of(release)
    # ζ of Eq. 16; the restitution model has the r that this contact really has.
    one = SpringDamper.from_restitution(parameters["restitution"], 1.0, rule)
    zeta = float(one.damping_ratio)

    found = search([zeta], rule, n, lam, ratios, tolerance)
    k = np.array(error_law.coefficients(n, zeta, lam, rule), dtype=float)
    still = float(error_law.permanent_contact_coefficient(zeta, rule))
    permanent, _ = thresholds(
        lambda ratio: relative_error(
            Quantity.PERMANENT_CONTACT,
            SpringDamperModel(SpringDamper(ratio, zeta, rule)),
            RestitutionModel(1.0),
            n,
            lam,
        ),
        [tolerance],
        ratios,
    )
    return described(
        {
            "coefficient": ("quantity", k),
            "law_threshold": ("quantity", np.abs(k) / tolerance),
            "error_threshold": (("model", "quantity"), found.threshold[..., 0]),
            "threshold_status": (("model", "quantity"), found.status[..., 0]),
            "error_zero": ("quantity", found.zero[:, 0]),
            "second_order": ("quantity", _second_order(zeta, rule, n, lam)),
            "permanent_coefficient": ((), still),
            "permanent_law": ((), float(np.sqrt(abs(still) / tolerance))),
            "permanent_threshold": ((), float(permanent[0])),
        },
        coords={"model": list(SIMPLE), "quantity": list(QUANTITIES)},
    )


def random_orbits(
    size: int, seed: int | Sequence[int], release: str, places: tuple[float, float] = (0.0, 1.0)
):
    """Random (n, ζ, Λ) in the stable range of the restitution model, ``places`` of it.

    r is even from 0.05 to 0.98, from 0.15 with the force release, whose linear
    contacts go down to e⁻² only; n from 1 to 5.
    """
    rng, rule = np.random.default_rng(seed), Release.of(release)
    lowest = 0.15 if rule is Release.FORCE else 0.05
    r = rng.uniform(lowest, 0.98, size)
    n, model = rng.integers(1, 6, size), RestitutionModel(r)
    low, high = model.saddle_node(n).amplitude, model.period_doubling(n).amplitude
    lam = low + rng.uniform(*places, size) * (high - low)
    zeta = SpringDamper.from_restitution(r, 1.0, rule, measured=True).damping_ratio
    return n, zeta, lam, rng


class LawErrors(NamedTuple):
    """Errors of random orbits beside the error law; rows are the quantities."""

    frequency_ratio: np.ndarray
    restitution: np.ndarray
    """Signed relative error of the restitution model."""
    corrected: np.ndarray
    law: np.ndarray
    """K/ϖ, what the law says of the first."""
    remainder: np.ndarray
    """|error - K/ϖ|/(S δ), which the law states to be below M."""
    small_parameter: np.ndarray
    """δ of each orbit."""


def law_errors(
    size: int, seed: int | Sequence[int], span: Mapping[str, Any], release: str
) -> LawErrors:
    """Errors of random orbits of the whole stable range, ϖ even in its logarithm."""
    n, zeta, lam, rng = random_orbits(size, seed, release)
    omega = np.exp(rng.uniform(np.log(span["min"]), np.log(span["max"]), size))
    contact = SpringDamper(omega, zeta, Release.of(release))
    instant = LinearSignature(contact)()
    small = error_law.small_parameter(n, instant, lam)
    law = np.array(error_law.first_order(n, instant, lam))
    restitution, corrected = errors(contact, n, lam)
    remainder = np.abs(restitution - law) / (np.array(error_law.scale(n, instant, lam)) * small)
    return LawErrors(omega, restitution, corrected, law, remainder, small)


def orders(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Errors along ϖ for one orbit, and the orders of convergence of random ones."""
    ratios, rule = grid(parameters["frequency_ratio"]), Release.of(release)
    one = SpringDamper.from_restitution(parameters["restitution"], ratios, rule)
    curves = np.abs(errors(one, parameters["n"], parameters["amplitude"]))
    sample = parameters["random"]
    n, zeta, lam, _ = random_orbits(sample["samples"], sample["seed"], release, (0.2, 0.95))
    stiff = sample["stiff_frequency_ratio"]
    pair = [
        np.abs(errors(SpringDamper(np.full(lam.shape, k * stiff), zeta, rule), n, lam))
        for k in (1.0, 2.0)
    ]
    span = parameters["frequency_ratio"]
    law = law_errors(sample["law_samples"], sample["seed"] + 1, span, release)
    return described(
        {
            "relative_error": (("model", "quantity", "frequency_ratio"), curves),
            "order": (("model", "quantity", "sample"), np.log2(pair[0] / pair[1])),
            "law_remainder": (("quantity", "law_sample"), law.remainder),
            "small_parameter": ("law_sample", law.small_parameter),
            "stated_below": ((), error_law.STATED),
        },
        coords={
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "frequency_ratio": ratios,
            "sample": np.arange(sample["samples"]),
            "law_sample": np.arange(sample["law_samples"]),
        },
    )


def validity(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """The ϖ from which each simple model is right, over r, n and Λ/Λ_SN.

    Beside it, where the restitution model's error passes through zero by accident.
    """
    ratios, rule = grid(parameters["frequency_ratio"]), Release.of(release)
    axes = [np.array(parameters[k]) for k in ("n", "amplitude_ratio", "restitution")]
    n, places, r = np.meshgrid(*axes, indexing="ij")
    model = RestitutionModel(r)
    lam = places * model.saddle_node(n).amplitude
    # Outside the stable range of the restitution model there is nothing to be right about.
    there = lam <= model.period_doubling(n).amplitude
    zeta = np.asarray(SpringDamper.from_restitution(r, 1.0, rule, measured=True).damping_ratio)
    found = search(zeta[there], rule, n[there], lam[there], ratios, parameters["tolerance"])
    threshold = np.full((len(SIMPLE), len(QUANTITIES), *r.shape), np.nan)
    zero = np.full(threshold.shape[1:], np.nan)
    always = found.status == ThresholdStatus.ALWAYS_WITHIN
    threshold[..., there] = np.where(always, ratios[0], found.threshold)
    zero[..., there] = found.zero
    dims = ("quantity", "n", "amplitude_ratio", "restitution")
    return described(
        {
            "error_threshold": (("model", *dims), threshold),
            "error_zero": (dims, zero),
        },
        coords={
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "n": axes[0],
            "amplitude_ratio": axes[1],
            "restitution": axes[2],
        },
    )


def height(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Greatest height along ϖ in all three models (Fig. 14 with a third curve)."""
    n, lam, ratios = parameters["n"], parameters["amplitude"], grid(parameters["frequency_ratio"])
    r = parameters["restitution"]
    contact = SpringDamper.from_restitution(r, ratios, Release.of(release))
    exact, simple, corrected = (m.orbit(n, lam) for m in models(contact))
    return described(
        {
            "max_height": ("frequency_ratio", exact.max_height),
            "admissible": ("frequency_ratio", exact.is_admissible()),
            "corrected_max_height": ("frequency_ratio", corrected.max_height),
            "restitution_max_height": ((), simple.max_height.flat[0]),
        },
        coords={"frequency_ratio": ratios},
    )


def domains(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Phase against Λ in all three models (Fig. 15 with a third curve)."""
    n, top = parameters["n"], parameters["amplitude_max"]
    contact = SpringDamper.from_restitution(
        parameters["restitution"], parameters["frequency_ratio"], Release.of(release)
    )
    names = ("spring-damper", *SIMPLE)
    # Towards the fold by squares: the phase depends on Λ there by a root.
    share = np.linspace(0.0, 1.0, parameters["points"])[1:] ** 2
    amplitude, phase, stable, ends = [], [], [], []
    for model in models(contact):
        fold, flip = model.saddle_node(n), model.period_doubling(n)
        low = float(fold.amplitude)
        lam = low + share * (top - low)
        left, right = (model.orbit(n, lam, side) for side in (Side.UNSTABLE, Side.STABLE))
        amplitude.append(np.concatenate([lam[::-1], [low], lam]))
        phase.append(np.concatenate([left.phase[::-1], [float(fold.phase)], right.phase]))
        # At the fold a multiplier is 1.
        stable.append(np.concatenate([left.is_stable()[::-1], [False], right.is_stable()]))
        ends.append([[float(x.amplitude), float(x.phase)] for x in (fold, flip)])
    bounds = np.array(ends)
    dims = ("model", "point")
    return described(
        {
            "amplitude": (dims, np.array(amplitude)),
            "phase": (dims, np.array(phase)),
            "stable": (dims, np.array(stable)),
            "bifurcation_amplitude": (("model", "bound"), bounds[..., 0]),
            "bifurcation_phase": (("model", "bound"), bounds[..., 1]),
        },
        coords={
            "model": list(names),
            "point": np.arange(2 * len(share) + 1),
            "bound": list(Bifurcation),
        },
    )


def meeting_flights(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """One contact, and the flights before and after it, continued into it."""
    contact = SpringDamper.from_restitution(
        parameters["restitution"], parameters["frequency_ratio"], Release.of(release)
    )
    orbit = SpringDamperModel(contact).require_orbit(parameters["n"], parameters["amplitude"])
    end = float(orbit.contact_duration)
    time = np.linspace(-0.6 * end, 1.6 * end, parameters["samples"])
    start = orbit.contact_path(np.zeros(()))
    before = start[0] + (start[1] - time / 2) * time
    after, _ = orbit.flight_path(time)
    inside = (time >= 0) & (time <= end)
    touching, rate = orbit.contact_path(np.clip(time, 0, end))
    table = orbit.amplitude * np.sin(orbit.phase + time)
    gap, closing = touching - table, rate - orbit.amplitude * np.cos(orbit.phase + time)
    zeta, omega = contact.damping_ratio, contact.frequency_ratio
    force = np.where(inside, -(2 * zeta * omega * closing + omega**2 * gap), 0.0)
    # The meeting point of the two parabolas, exact; and where the signature has it.
    jump = float(orbit.bounce_velocity + end - orbit.impact_velocity)
    apart = float(orbit.bounce_height - (start[0] + (start[1] - end / 2) * end))
    meeting = end - apart / jump
    return described(
        {
            "ball": ("time", np.where(time < 0, before, np.where(inside, touching, after))),
            "table": ("time", table),
            "flight_before": ("time", before),
            "flight_after": ("time", after),
            "contact_force": ("time", force),
            "contact_duration": ((), end),
            "meeting_time": ((), meeting),
            "meeting_height": ((), float(start[0] + (start[1] - meeting / 2) * meeting)),
            "delay": ((), float(LinearSignature(contact)().delay)),
        },
        coords={"time": time},
    )
