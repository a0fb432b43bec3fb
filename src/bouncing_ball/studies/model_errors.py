"""The corrected restitution model against the exact contact (beyond the paper).

Errors are relative to the simple model as in Eqs. 37-38, ``|q_SD - q|/|q|`` with q of the
corrected model, or of the restitution model with the r that the contact really has, which
differs from the r of Eq. 16 for the force release. The first-order law is that of
:mod:`bouncing_ball.accuracy.error_law`.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Field

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import SIMPLE, errors
from bouncing_ball.accuracy.quantities import OF_IMPACTS, Quantity
from bouncing_ball.accuracy.thresholds import search
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import LossyRestitution, Samples, Seed
from bouncing_ball.studies.parameters import OrbitErrors
from bouncing_ball.studies.random_orbits import random_orbits


class Orders(OrbitErrors):
    """One orbit along ϖ with a tolerated error, and random orbits of the stable range."""

    restitution: LossyRestitution
    seed: Seed
    samples: Annotated[Samples, Field(description="random orbits whose orders are measured")]
    law_samples: Annotated[Samples, Field(description="random orbits on which the law is tested")]


_STIFF = 500.0
"""ϖ at which the corrected model's error is of second order, with no visible rounding."""


# Two ϖ for the order: below 100 higher orders contribute, above 10⁴ rounding does.
_TWO_STIFF = np.array([[1000.0], [2000.0]])


def _second_order(zeta: float, rule: Release, n, amplitude) -> np.ndarray:
    """C of each quantity: the corrected model's relative error is C/ϖ² + O(1/ϖ³).

    It is measured at two stiff contacts, and the third order is eliminated (Richardson).
    """
    ratios = np.array([_STIFF, 2 * _STIFF])
    once, twice = (errors(SpringDamper(ratios, zeta, rule), n, amplitude)[1] * ratios**2).T
    return 2 * twice - once


def _of_random_orbits(sample: Orders, release: Release) -> dict[str, tuple]:
    """Orders of both models, and the remainder of the restitution model's errors from the law."""
    n, zeta, lam, _ = random_orbits(sample.samples, sample.seed, release, (0.2, 0.95))
    once, twice = np.moveaxis(np.abs(errors(SpringDamper(_TWO_STIFF, zeta, release), n, lam)), 2, 0)
    n, zeta, lam, rng = random_orbits(sample.law_samples, sample.seed + 1, release)
    span = sample.frequency_ratio
    omega = np.exp(rng.uniform(*np.log([span.min, span.max]), sample.law_samples))
    contact = SpringDamper(omega, zeta, release)
    left = error_law.remainder(n, Signature(contact)(), lam, errors(contact, n, lam)[0])
    return {
        "order": (("model", "quantity", "sample"), np.log2(once / twice)),
        "law_remainder": (("quantity", "law_sample"), left.factor),
    }


def orders(parameters: Orders, release: Release) -> xr.Dataset:
    """Errors along ϖ for one orbit, their orders in 1/ϖ, and the error law.

    For the orbit the dataset has ``relative_error`` (model, quantity, ϖ), the modulus;
    ``coefficient`` K and ``second_order`` C (quantity,); ``error_threshold`` and
    ``threshold_status`` (model, quantity), ``law_threshold`` (quantity,), the ϖ for the tolerance
    exactly and by the law; ``error_zero`` (quantity,), the ϖ at which the restitution model's error
    changes its sign. ``permanent_coefficient``, ``permanent_law`` and ``permanent_threshold`` are
    the same numbers for the permanent contact, which has no impact to correct.

    For random orbits it has the measured ``order`` (model, quantity, sample);
    ``law_remainder`` (quantity, law_sample), which is |error - K/ϖ|/(S δ) and at most M by the law.
    M was fitted to other orbits (:data:`~bouncing_ball.accuracy.error_law.REMAINDER`).
    """
    n, lam, tolerance = parameters.n, parameters.amplitude, parameters.tolerance
    # ζ by Eq. 16; the restitution model has the r that a contact with this ζ really has.
    zeta = float(damping_ratio(parameters.restitution))
    ratios = parameters.frequency_ratio.grid()
    curves = np.abs(errors(SpringDamper(ratios, zeta, release), n, lam))
    found = search(zeta, release, n, lam, ratios, tolerance, tuple(Quantity))
    k = error_law.coefficients(n, zeta, lam, release)
    *law, still = error_law.law_thresholds(n, zeta, lam, release, tolerance).values()
    return described(
        {
            "relative_error": (("model", "quantity", "frequency_ratio"), curves),
            "coefficient": ("quantity", list(k.values())),
            "second_order": ("quantity", _second_order(zeta, release, n, lam)),
            "law_threshold": ("quantity", law),
            "error_threshold": (("model", "quantity"), found.threshold[:, :-1, 0]),
            "threshold_status": (("model", "quantity"), found.status[:, :-1, 0]),
            "error_zero": ("quantity", found.zero[:-1, 0]),
            "permanent_coefficient": error_law.permanent_contact_coefficient(zeta, release),
            "permanent_law": still,
            "permanent_threshold": found.threshold[0, -1, 0],
            **_of_random_orbits(parameters, release),
        },
        coords={"model": list(SIMPLE), "quantity": list(OF_IMPACTS), "frequency_ratio": ratios},
    )
