r"""The corrected restitution model against the exact contact (beyond the paper).

Errors are relative to the exact contact's model as in Eqs. 37-38,
``|q_SD - q|/|q|`` with q of the restitution model *of the contact's own r*, or
of the corrected one. The law of the first order is that of
:mod:`bouncing_ball.accuracy.error_law`.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Field

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import SIMPLE, errors
from bouncing_ball.accuracy.quantities import OF_IMPACTS, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus, search
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.parameters import (
    Family,
    LossyRestitution,
    Many,
    OwnRestitution,
    Parameters,
    Samples,
    Seed,
    Span,
    Tolerance,
    number,
)
from bouncing_ball.studies.law_distribution import law_errors
from bouncing_ball.studies.parameters import (
    MotionRatio,
    OrbitErrors,
    OrbitParameters,
    OrbitsAlongRatio,
)
from bouncing_ball.studies.random_orbits import random_orbits


class ErrorLaw(OrbitErrors):
    """One orbit, and the error tolerated."""

    restitution: LossyRestitution


class Sample(Parameters):
    """Random orbits of the whole stable range."""

    seed: Seed
    samples: Annotated[Samples, Field(description="random orbits whose orders are measured")]
    stiff_frequency_ratio: Annotated[
        float,
        number(
            "ϖ of the softer of two contacts for the order, the other having twice as much; below "
            "100 further orders show, beyond 10⁴ rounding",
            ge=100,
            le=1e4,
        ),
    ]
    law_samples: Annotated[Samples, Field(description="random orbits on which the law is tried")]


class Orders(OrbitsAlongRatio):
    """One orbit along ϖ, and random ones."""

    restitution: LossyRestitution
    random: Sample


class Validity(Parameters):
    """Orbits over n, Λ/Λ_SN and r, and the error tolerated."""

    n: Many[Family]
    restitution: Many[OwnRestitution]
    amplitude_ratio: Many[
        Annotated[
            float, number("amplitude over that of the saddle-node, above 1", ge=1.001, le=100)
        ]
    ]
    tolerance: Tolerance
    frequency_ratio: Span


class Meeting(OrbitParameters):
    """One contact of one orbit."""

    frequency_ratio: MotionRatio
    samples: Samples


_STIFF = 500.0
"""ϖ at which the second order is all of the corrected model's error, and rounding none of it."""


def _second_order(zeta: float, rule: Release, n, amplitude) -> np.ndarray:
    """C of each quantity: the corrected model's relative error is C/ϖ² + O(1/ϖ³).

    Measured at two stiff contacts, and the third order taken off (Richardson).
    """
    ratios = np.array([_STIFF, 2 * _STIFF])
    once, twice = (errors(SpringDamper(ratios, zeta, rule), n, amplitude)[1] * ratios**2).T
    return 2 * twice - once


def error_law_table(parameters: ErrorLaw, release: Release) -> xr.Dataset:
    """K, and the ϖ for a tolerance: exact, by the law, corrected; shape (model, quantity)."""
    n, lam, tolerance = parameters.n, parameters.amplitude, parameters.tolerance
    # ζ of Eq. 16; the restitution model has the r that this contact really has.
    zeta = float(damping_ratio(parameters.restitution))
    ratios = parameters.frequency_ratio.grid()
    found = search(zeta, release, n, lam, ratios, tolerance, tuple(Quantity))
    k = [float(x) for x in error_law.coefficients(n, zeta, lam, release).values()]
    law = error_law.law_thresholds(n, zeta, lam, release, tolerance)
    still = float(error_law.permanent_contact_coefficient(zeta, release))
    return described(
        {
            "coefficient": ("quantity", k),
            "law_threshold": ("quantity", [float(law[q]) for q in OF_IMPACTS]),
            "error_threshold": (("model", "quantity"), found.threshold[:, :-1, 0]),
            "threshold_status": (("model", "quantity"), found.status[:, :-1, 0]),
            "error_zero": ("quantity", found.zero[:-1, 0]),
            "second_order": ("quantity", _second_order(zeta, release, n, lam)),
            "permanent_coefficient": ((), still),
            "permanent_law": ((), float(law[Quantity.PERMANENT_CONTACT])),
            "permanent_threshold": ((), found.threshold[0, -1, 0]),
        },
        coords={"model": list(SIMPLE), "quantity": list(OF_IMPACTS)},
    )


def orders(parameters: Orders, release: Release) -> xr.Dataset:
    """Errors along ϖ for one orbit, shape (model, quantity, ϖ), and the orders of random ones."""
    span, sample = parameters.frequency_ratio, parameters.random
    exact = parameters.exact(span.grid(), release)
    curves = np.abs(errors(exact.contact, parameters.n, parameters.amplitude))
    n, zeta, lam, _ = random_orbits(sample.samples, sample.seed, release, (0.2, 0.95))
    stiff = sample.stiff_frequency_ratio * np.array([[1.0], [2.0]])
    once, twice = np.moveaxis(np.abs(errors(SpringDamper(stiff, zeta, release), n, lam)), 2, 0)
    law = law_errors(sample.law_samples, sample.seed + 1, span, release)
    return described(
        {
            "relative_error": (("model", "quantity", "frequency_ratio"), curves),
            "order": (("model", "quantity", "sample"), np.log2(once / twice)),
            "law_remainder": (("quantity", "law_sample"), law.remainder.values),
            "small_parameter": ("law_sample", law.small_parameter.values),
            "stated_below": ((), error_law.STATED),
        },
        coords={
            "model": list(SIMPLE),
            "quantity": list(OF_IMPACTS),
            "frequency_ratio": span.grid(),
        },
    )


def validity(parameters: Validity, release: Release) -> xr.Dataset:
    """The ϖ from which each simple model is right, over n, Λ/Λ_SN and r.

    Shape (model, quantity, n, Λ/Λ_SN, r); NaN where the restitution model has no stable orbit,
    or the error is too large at the largest ϖ. Beside it, where the restitution model's error
    passes through zero by accident.
    """
    ratios, names = parameters.frequency_ratio.grid(), ("n", "amplitude_ratio", "restitution")
    axes = {name: np.array(getattr(parameters, name)) for name in names}
    n, places, r = np.meshgrid(*axes.values(), indexing="ij")
    model = RestitutionModel(r)
    lam = places * model.saddle_node(n).amplitude
    # Outside the stable range of the restitution model there is nothing to be right about.
    there = lam <= model.period_doubling(n).amplitude
    zeta = SpringDamper.from_restitution(r[there], 1.0, release, measured=True).damping_ratio
    found = search(zeta, release, n[there], lam[there], ratios, parameters.tolerance)
    threshold = np.full((len(SIMPLE), len(OF_IMPACTS), *r.shape), np.nan)
    zero = np.full(threshold.shape[1:], np.nan)
    always = found.status == ThresholdStatus.ALWAYS_WITHIN
    threshold[..., there] = np.where(always, ratios[0], found.threshold)
    zero[..., there] = found.zero
    return described(
        {
            "error_threshold": (("model", "quantity", *names), threshold),
            "error_zero": (("quantity", *names), zero),
        },
        coords={"model": list(SIMPLE), "quantity": list(OF_IMPACTS), **axes},
    )


def meeting_flights(parameters: Meeting, release: Release) -> xr.Dataset:
    """One contact, and the flights before and after it, continued into it; shape (time,).

    Raises
    ------
    NoOrbitError
        If the orbit does not exist.
    """
    exact = parameters.exact(parameters.frequency_ratio, release)
    orbit = exact.require_orbit(parameters.n, parameters.amplitude)
    end = float(orbit.contact_duration)
    time = np.linspace(-0.6 * end, 1.6 * end, parameters.samples)
    inside, within = (time >= 0) & (time <= end), np.clip(time, 0, end)
    start, velocity = orbit.contact_path(np.zeros(()))
    before, (after, _) = start + (velocity - time / 2) * time, orbit.flight_path(time)
    touching, _ = orbit.contact_path(within)
    force = exact.contact.force(*-np.array(orbit.contact_motion(within)))
    # The meeting point of the two parabolas, exact; and where the signature has it.
    jump = float(orbit.bounce_velocity + end - orbit.impact_velocity)
    apart = float(orbit.bounce_height - (start + (velocity - end / 2) * end))
    meeting = end - apart / jump
    return described(
        {
            "ball": ("time", np.where(time < 0, before, np.where(inside, touching, after))),
            "table": ("time", orbit.amplitude * np.sin(orbit.phase + time)),
            "flight_before": ("time", before),
            "flight_after": ("time", after),
            "contact_force": ("time", inside * force),
            "contact_duration": ((), end),
            "meeting_time": ((), meeting),
            "meeting_height": ((), float(start + (velocity - meeting / 2) * meeting)),
            "delay": ((), float(Signature(exact.contact)().delay)),
        },
        coords={"time": time},
    )
