"""Stage: errors of the restitution and of the corrected model, and what the error law leaves."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.errors import permanent_contact_error, threshold
from bouncing_ball_beyond.contacts.balls import Ball, Corrected, SpringDamper, damping_of
from bouncing_ball_beyond.errors.error_law import (
    QUANTITIES,
    error_thresholds,
    exact_errors,
    free_impact,
    law_coefficients,
    law_errors,
    law_thresholds,
)
from paper_replication.datasets import grid
from studies.orbits import last_zero, random_orbits

# What stands in place of a contact. Without a name of a class it is the restitution coefficient.
MODELS = {"restitution": None, "corrected": Corrected}

# At two such contacts the corrected model's error is of second order, with no visible rounding.
STIFF = np.array([500.0, 1000.0])

# Two ϖ for the orders: below 100 higher orders contribute, above 10⁴ rounding does.
TWO_STIFF = np.array([[1000.0], [2000.0]])

# At the saddle-node the error has a term of order 1/2 and one of order 1 with the other sign, whose
# sum passes through zero at ϖ up to some 10⁴.
TWO_STIFF_AT_NODE = np.array([[1e5], [2e5]])


def stacked(quantities: dict) -> NDArray:
    """The values of the quantities, shape (quantity, ...)."""
    return np.stack(np.broadcast_arrays(*quantities.values()))


def errors(ball: Ball, amplitude, n) -> NDArray:
    """Signed errors of both models, shape (model, quantity, ...)."""
    return np.stack(
        [
            stacked(exact_errors(ball, amplitude=amplitude, n=n, simple=simple))
            for simple in MODELS.values()
        ]
    )


def left_by_law(ball: Ball, amplitude, n) -> tuple[NDArray, NDArray]:
    """Moduli of what the error law leaves, and of the restitution model's errors."""
    error = stacked(exact_errors(ball, amplitude=amplitude, n=n))
    return np.abs(error - stacked(law_errors(ball, amplitude=amplitude, n=n))), np.abs(error)


def left_at_saddle_node(ball: Ball, n) -> tuple[NDArray, NDArray]:
    """The same at the saddle-node of the restitution model.

    Rounding must not put Λ below the saddle-node, and a root of the share added is small next to
    what the contact changes at ϖ up to 10⁴.
    """
    return left_by_law(ball, (1 + 1e-9) * free_impact(ball, n).line, n)


def of_the_orbit(parameters: dict, release: str) -> dict[str, tuple]:
    """Errors along ϖ on the orbit, with their zeros, and its numbers of the error law."""
    n = parameters["n"]
    amplitude = parameters["amplitude"]
    tolerance = parameters["tolerance"]
    span = parameters["frequency_ratio"]
    ratios = grid(span)
    ball = SpringDamper(
        ratios, damping_ratio=damping_of(parameters["restitution"]), release=release
    )
    relative_errors = errors(ball, amplitude, n)
    stiff = ball.at(frequency_ratio=STIFF)
    once, twice = (errors(stiff, amplitude, n)[1] * STIFF**2).T
    exact = stacked(exact_errors(stiff, amplitude=amplitude, n=n))
    by_law = stacked(law_errors(stiff, amplitude=amplitude, n=n))
    law_once, law_twice = ((exact - by_law) * STIFF**2).T
    left, _ = left_by_law(ball, amplitude, n)
    left_at_node, node_error = left_at_saddle_node(ball, n)
    unit = ball.at(frequency_ratio=1.0)
    law = {"amplitude": amplitude, "n": n}
    search = law | {"tolerance": tolerance, "low": span["min"], "high": span["max"]}
    thresholds = [
        error_thresholds(unit, simple=simple, samples=span["samples"], **search)
        for simple in MODELS.values()
    ]
    zeros = np.full(relative_errors.shape[:2], np.nan)
    for model, quantity in np.ndindex(zeros.shape):
        name = QUANTITIES[quantity]
        simple = list(MODELS.values())[model]

        def error(ratio, name=name, simple=simple):
            one = ball.at(frequency_ratio=ratio)
            return float(exact_errors(one, simple=simple, quantities=[name], **law)[name])

        zeros[model, quantity] = last_zero(ratios, relative_errors[model, quantity], error)
    both = ("model", "quantity")
    return {
        "relative_error": ((*both, "frequency_ratio"), np.abs(relative_errors)),
        "coefficient": ("quantity", stacked(law_coefficients(unit, **law))),
        # The error is C/ϖ² and terms of third order, which are eliminated (Richardson).
        "second_order": ("quantity", 2 * twice - once),
        "law_second_order": ("quantity", 2 * law_twice - law_once),
        "law_third_order": ("quantity", (law_once - law_twice) / np.subtract(*(1 / STIFF))),
        "law_threshold": ("quantity", stacked(law_thresholds(unit, tolerance=tolerance, **law))),
        "error_threshold": (
            both,
            [[threshold.ratio for threshold in by_name.values()] for by_name in thresholds],
        ),
        "threshold_status": (
            both,
            [[str(threshold.status) for threshold in by_name.values()] for by_name in thresholds],
        ),
        "law_left": (("place", "quantity", "frequency_ratio"), [left, left_at_node]),
        "node_error": (("quantity", "frequency_ratio"), node_error),
        "error_zero": ("quantity", zeros[0]),
        "corrected_error_zero": ("quantity", zeros[1]),
    }


def of_permanent_contact(parameters: dict, release: str) -> dict[str, float]:
    """The error of the threshold of permanent contact, which is K₂/ϖ² and terms of fourth order."""
    zeta = float(damping_of(parameters["restitution"]))
    ratios = grid(parameters["frequency_ratio"])
    tolerance = parameters["tolerance"]
    coefficient = 2 * zeta**2 - 1 if release == "displacement" else -1.0
    error = permanent_contact_error(ratios, zeta, release)
    return {
        "permanent_coefficient": coefficient,
        "permanent_law": np.sqrt(abs(coefficient) / tolerance),
        "permanent_threshold": threshold(ratios, error, tolerance).ratio,
    }


def of_random_orbits(parameters: dict, release: str) -> dict[str, tuple]:
    """Orders of both models' errors in 1/ϖ, and of what the error law leaves."""
    seed = parameters["seed"]
    n, zeta, amplitude, _ = random_orbits(parameters["samples"], seed, release, (0.2, 0.95))
    stiff = SpringDamper(TWO_STIFF, damping_ratio=zeta, release=release)
    once, twice = np.moveaxis(np.abs(errors(stiff, amplitude, n)), 2, 0)
    left, _ = left_by_law(stiff, amplitude, n)
    stiffer = stiff.at(frequency_ratio=TWO_STIFF_AT_NODE)
    left_at_node, error = left_at_saddle_node(stiffer, n)
    return {
        "order": (("model", "quantity", "sample"), np.log2(once / twice)),
        "law_order": (
            ("place", "quantity", "sample"),
            [np.log2(remainder[:, 0] / remainder[:, 1]) for remainder in (left, left_at_node)],
        ),
        "node_order": (("quantity", "sample"), np.log2(error[:, 0] / error[:, 1])),
        "order_frequency_ratio": ("pair", TWO_STIFF.ravel()),
        "node_order_frequency_ratio": ("pair", TWO_STIFF_AT_NODE.ravel()),
    }


def ext_orders(parameters: dict, release: str) -> xr.Dataset:
    """Errors along ϖ for one orbit, their orders in 1/ϖ, and the error law.

    ζ follows from r by Eq. 16, and the restitution model has the r that the contact really has.
    What the law leaves is also computed at the saddle-node of the restitution model.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        variables = of_the_orbit(parameters, release) | of_random_orbits(parameters, release)
    return xr.Dataset(
        variables | of_permanent_contact(parameters, release),
        {
            "model": list(MODELS),
            "place": ["orbit", "saddle-node"],
            "quantity": list(QUANTITIES),
            "frequency_ratio": grid(parameters["frequency_ratio"]),
        },
    )


STAGE = {"ext_orders": ext_orders}
