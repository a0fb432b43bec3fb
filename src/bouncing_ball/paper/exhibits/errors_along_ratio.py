"""Errors of the restitution model along ϖ with their thresholds, as a dataset (Figs. 14 and 16)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.errors import Quantity, modulus
from bouncing_ball.accuracy.thresholds import search
from bouncing_ball.models.damping import Release, damping_ratio


def errors_along_ratio(
    restitution: float,
    release: Release,
    *,
    n: int,
    amplitude: float,
    ratios: np.ndarray,
    quantities: Sequence[Quantity],
    tolerances: Sequence[float],
) -> xr.Dataset:
    """Errors of the restitution model along ϖ, and the thresholds of tolerances.

    Parameters
    ----------
    restitution : float
        r, from which the damping of the contact follows by Eq. 16.
    release : Release
    n, amplitude : int, float
        Index of the family and Λ of the orbit.
    ratios : ndarray
        Increasing grid of ϖ.
    quantities : sequence of Quantity
    tolerances : sequence of float

    Returns
    -------
    Dataset
        ``relative_error`` (quantity, ϖ), moduli, infinite where a model lacks the quantity;
        ``error_threshold`` in ϖ and ``threshold_status``, both (quantity, tolerance).
    """
    found = search(
        damping_ratio(restitution),
        release,
        restitution,
        n,
        amplitude,
        ratios=ratios,
        tolerances=tolerances,
        quantities=quantities,
    )
    dims = ("quantity", "tolerance")
    return xr.Dataset(
        {
            "relative_error": (("quantity", "frequency_ratio"), modulus(found.error[:, 0])),
            "error_threshold": (dims, found.threshold[:, 0]),
            "threshold_status": (dims, found.status[:, 0]),
        },
        coords={
            "quantity": [str(quantity) for quantity in quantities],
            "frequency_ratio": ratios,
            "tolerance": list(tolerances),
        },
    )
