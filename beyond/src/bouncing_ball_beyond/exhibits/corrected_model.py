"""The corrected restitution model against the exact contact (beyond the paper).

On one orbit, the flights before and after a contact are continued until they meet, and errors are
computed along ϖ. Random orbits show their orders in 1/ϖ and the remainder of the error law. Errors
are relative to the simple model as in Eqs. 37-38, ``|q_SD - q|/|q|`` with q of the
corrected model, or of the restitution model with the r that the contact really has, which
differs from the r of Eq. 16 for the force release. The error law is that of
:mod:`bouncing_ball_beyond.accuracy.error_law`.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Field

from bouncing_ball_beyond.accuracy import error_law
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS
from bouncing_ball_beyond.accuracy.simple_models import SIMPLE, errors, search
from bouncing_ball_beyond.exhibits.orbit_parameters import OrbitErrors, OrbitOnContact
from bouncing_ball_beyond.exhibits.random_orbits import half_next_to_saddle_node, random_orbits
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.datasets.parameters import (
    LossyRestitution,
    Samples,
    Seed,
    number,
)
from bouncing_ball_beyond.inherited.datasets.variables import Variable, described
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.motion import contact_motion, contact_path, flight_path

VARIABLES = {
    "contact_force": Variable("force of the table over the weight", symbol="F"),
    "law_threshold": Variable("frequency ratio for the tolerance by the error law", symbol="ϖ"),
    "coefficient": Variable("relative error times the frequency ratio, to first order", symbol="K"),
    "second_order": Variable(
        "relative error of the corrected model times the squared frequency ratio",
        symbol="C",
        budget=1e-07,
    ),
    "error_zero": Variable(
        "frequency ratio at which the error passes through zero", symbol="ϖ", budget=1e-11
    ),
    "corrected_error_zero": Variable(
        "frequency ratio at which the corrected model's error passes through zero",
        symbol="ϖ",
        budget=1e-08,
    ),
    "permanent_coefficient": Variable(
        "relative error of the permanent contact times the squared frequency ratio", symbol="K₂"
    ),
    "permanent_law": Variable("frequency ratio for the tolerance by this law", symbol="√(|K₂|/ε)"),
    "permanent_threshold": Variable(
        "frequency ratio for the tolerance, permanent contact", symbol="ϖ_PC"
    ),
    "order": Variable(
        "order of convergence of the relative error in 1/ϖ", budget=0.0001, scale="1"
    ),
    "law_left": Variable("modulus of the error that the error law leaves", budget=1e-11),
    "law_order": Variable(
        "order of convergence in 1/ϖ of what the error law leaves", budget=0.001, scale="1"
    ),
    "node_error": Variable(
        "modulus of the relative error of the restitution model at its saddle-node", budget=1e-11
    ),
    "node_order": Variable("order of convergence in 1/ϖ of this error", budget=0.001, scale="1"),
    "place": Variable("the orbit, or the saddle-node of the restitution model"),
    "order_frequency_ratio": Variable(
        "two frequency ratios between which the orders are measured", symbol="ϖ"
    ),
    "pair": Variable("contact between which and another one the orders are measured"),
    "law_sample": Variable("random orbit on which the error law is tried"),
    "law_remainder": Variable(
        "remainder of the error law over its scale and small parameter",
        symbol="|e - E|/(S η)",
        budget=0.0001,
        scale="1",
    ),
    "flight_before": Variable("flight before the contact, continued", symbol="z"),
    "flight_after": Variable("flight after the contact, continued backwards", symbol="z"),
    "meeting_time": Variable("time at which the continued flights meet", symbol="t^*"),
    "meeting_height": Variable(
        "height at which the continued flights meet", symbol="z", budget=1e-12
    ),
    "delay": Variable("delay of the instant by the law's signature", symbol="t_c"),
}


class OneContact(OrbitOnContact):
    """An orbit on one contact, shown from before its contact until after it."""

    # Samples lie at equal steps over 2.2 times the duration of the contact.
    samples: Annotated[
        int,
        number(
            "number of samples; fewer than 11 do not show the contact, and more than 20001 are not "
            "visible in a figure",
            ge=11,
            le=20001,
        ),
    ]


def meeting_flights(parameters: OneContact, release: Release) -> xr.Dataset:
    """One contact, with the flights before and after it continued into it.

    The dataset has ``ball``, ``table``, ``flight_before``, ``flight_after`` and ``contact_force``
    over the weight, shape (time,), and numbers: ``contact_duration``, ``meeting_time`` and
    ``meeting_height`` of the two flights, and the ``delay`` by the signature of the contact.

    Raises
    ------
    NoOrbitError
        If the orbit does not exist.
    """
    contact = SpringDamper.from_restitution(
        parameters.restitution, parameters.frequency_ratio, release
    )
    orbit = n_t.require_orbit(ContactModel(contact), parameters.n, parameters.amplitude)
    end = float(orbit.contact_duration)
    time = np.linspace(-0.6 * end, 1.6 * end, parameters.samples)
    start, velocity = contact_path(orbit, np.zeros(()))
    before = start + (velocity - time / 2) * time
    after, _ = flight_path(orbit, time)
    force = contact.force(*-np.array(contact_motion(orbit, np.clip(time, 0, end))))
    # The meeting point of the two parabolas, exactly; the signature's is the delay.
    jump = float(orbit.bounce_velocity + end - orbit.impact_velocity)
    apart = float(orbit.bounce_height - (start + (velocity - end / 2) * end))
    meeting = end - apart / jump
    return described(
        {
            "ball": ("time", orbit.path(time)[0]),
            "table": ("time", orbit.amplitude * np.sin(orbit.phase + time)),
            "flight_before": ("time", before),
            "flight_after": ("time", after),
            "contact_force": ("time", np.where((time >= 0) & (time <= end), force, 0.0)),
            "contact_duration": ((), end),
            "meeting_time": ((), meeting),
            "meeting_height": ((), float(start + (velocity - meeting / 2) * meeting)),
            "delay": ((), float(Signature(contact)().delay)),
        },
        coords={"time": time},
        variables=VARIABLES,
    )


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
    _, corrected = errors(SpringDamper(ratios, zeta, rule), n, amplitude)
    once, twice = (corrected * ratios**2).T
    return 2 * twice - once


def _left_by_law(n, contact: SpringDamper, amplitude) -> tuple[np.ndarray, np.ndarray]:
    """Moduli of what the error law leaves, and of the restitution model's errors."""
    error, _ = errors(contact, n, amplitude)
    law = error_law.law_errors(n, Signature(contact)(), amplitude)
    return np.abs(error - np.stack(np.broadcast_arrays(*law.values()))), np.abs(error)


def _saddle_node(n, restitution) -> np.ndarray:
    """Λ at the saddle-node of the restitution model.

    Rounding must not put it below, and a root of the share added is small next to what the contact
    changes at ϖ up to 10⁴.
    """
    return (1 + 1e-9) * restitution_saddle_node(n, restitution)


def _of_random_orbits(sample: Orders, release: Release) -> dict[str, tuple]:
    """Orders of both models, and the remainder of the restitution model's errors from the law."""
    n, zeta, lam, _ = random_orbits(sample.samples, sample.seed, release, (0.2, 0.95))
    stiff = errors(SpringDamper(_TWO_STIFF, zeta, release), n, lam)
    once, twice = np.moveaxis(np.abs(stiff), 2, 0)
    at_orbit, _ = _left_by_law(n, SpringDamper(_TWO_STIFF, zeta, release), lam)
    node = _saddle_node(n, SpringDamper(1.0, zeta, release).restitution)
    at_node, error = _left_by_law(n, SpringDamper(_TWO_STIFF, zeta, release), node)
    n, zeta, lam, rng = random_orbits(sample.law_samples, sample.seed + 1, release)
    span = sample.frequency_ratio
    omega = np.exp(rng.uniform(np.log(span.min), np.log(span.max), sample.law_samples))
    contact = SpringDamper(omega, zeta, release)
    lam = half_next_to_saddle_node(n, contact.restitution, lam, rng)
    left, _ = _left_by_law(n, contact, lam)
    instant = Signature(contact)()
    bound = error_law.remainder_scale(n, instant, lam)
    small = error_law.small_parameter(n, instant, lam)
    return {
        "order": (("model", "quantity", "sample"), np.log2(once / twice)),
        "law_order": (
            ("place", "quantity", "sample"),
            np.log2([x[:, 0] / x[:, 1] for x in (at_orbit, at_node)]),
        ),
        "node_order": (("quantity", "sample"), np.log2(error[:, 0] / error[:, 1])),
        "order_frequency_ratio": ("pair", _TWO_STIFF.ravel()),
        "law_remainder": (("quantity", "law_sample"), left / ([*bound.values()] * small)),
    }


def orders(parameters: Orders, release: Release) -> xr.Dataset:
    """Errors along ϖ for one orbit, their orders in 1/ϖ, and the error law.

    For the orbit the dataset has ``relative_error`` (model, quantity, ϖ), the modulus;
    ``coefficient`` K and ``second_order`` C (quantity,); ``error_threshold`` and
    ``threshold_status`` (model, quantity), ``law_threshold`` (quantity,), the ϖ for the tolerance
    exactly and by the law; ``error_zero`` (quantity,), the ϖ at which the restitution model's error
    changes its sign, and ``corrected_error_zero`` for the corrected model's.
    ``permanent_coefficient``, ``permanent_law`` and ``permanent_threshold`` are the same numbers
    for the permanent contact, which has no impact to correct.

    ``law_left`` (place, quantity, ϖ) is the modulus of the error that the error law leaves, on the
    orbit and at the saddle-node of the restitution model, whose ``node_error`` (quantity, ϖ) is its
    error there. It is NaN for the phase, because that of the restitution model is 0.

    For random orbits it has the measured ``order`` (model, quantity, sample) between the two ϖ in
    ``order_frequency_ratio`` (pair,); ``law_order`` (place, quantity, sample) of what the law
    leaves, and ``node_order`` (quantity, sample) of ``node_error``; and ``law_remainder``
    (quantity, law_sample), which is |error - law|/(S η) and at most 1 by the law. Half of these
    orbits are next to the saddle-node (:func:`.half_next_to_saddle_node`).
    The bound was fitted to other orbits (:mod:`~bouncing_ball_beyond.accuracy.error_law`).
    """
    n = parameters.n
    lam = parameters.amplitude
    tolerance = parameters.tolerance
    # ζ by Eq. 16; the restitution model has the r that a contact with this ζ really has.
    zeta = float(damping_ratio(parameters.restitution))
    ratios = parameters.frequency_ratio.grid()
    found = search(
        zeta,
        release,
        n,
        lam,
        ratios=ratios,
        tolerance=tolerance,
        quantities=tuple(Quantity),
    )
    k = error_law.coefficients(n, zeta, lam, release)
    allowed = -tolerance, tolerance
    contact = SpringDamper(ratios, zeta, release)
    left, _ = _left_by_law(n, contact, lam)
    left_at_node, node_error = _left_by_law(n, contact, _saddle_node(n, contact.restitution))
    unit = Signature(SpringDamper(1.0, zeta, release))()
    law = error_law.law_thresholds(n, unit, lam, allowed)
    return described(
        {
            "relative_error": (
                ("model", "quantity", "frequency_ratio"),
                np.abs(found.error[:, :-1, 0]),
            ),
            "coefficient": ("quantity", list(k.values())),
            "second_order": ("quantity", _second_order(zeta, release, n, lam)),
            "law_threshold": ("quantity", list(law.values())),
            "error_threshold": (("model", "quantity"), found.threshold[:, :-1, 0]),
            "threshold_status": (("model", "quantity"), found.status[:, :-1, 0]),
            "law_left": (("place", "quantity", "frequency_ratio"), [left, left_at_node]),
            "node_error": (("quantity", "frequency_ratio"), node_error),
            "error_zero": ("quantity", found.zero[0, :-1, 0]),
            "corrected_error_zero": ("quantity", found.zero[1, :-1, 0]),
            "permanent_coefficient": error_law.permanent_contact_coefficient(zeta, release),
            "permanent_law": error_law.permanent_contact_ratio(zeta, release, allowed),
            "permanent_threshold": found.threshold[0, -1, 0],
            **_of_random_orbits(parameters, release),
        },
        coords={
            "model": list(SIMPLE),
            "place": ["orbit", "saddle-node"],
            "quantity": list(OF_IMPACTS),
            "frequency_ratio": ratios,
        },
        variables=VARIABLES,
    )
