"""How well the error law holds over all orbits, as a distribution.

The errors of many random orbits over the values that the law predicts, and how
many are off it by more than the remainder that it states. The numbers are a
sample's: too long for every run, so that the pipeline makes them on request.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import REMAINDER, STATED, remainder
from bouncing_ball.accuracy.errors import errors
from bouncing_ball.accuracy.quantities import OF_IMPACTS, Quantity
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.parameters import Span
from bouncing_ball.studies.random_orbits import random_orbits

BATCH = 5000
"""Orbits at a time: the scan for their bifurcations takes the memory."""
DECADES = (1.0, 10.0, 100.0, 1000.0, 10000.0)
_SHARES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
HEADER = [
    "release",
    "quantity",
    "from",
    "to",
    "orbits",
    "stated",
    "exceed",
    "exceed elsewhere",
    "largest M",
    *(f"{100 * share:g} %" for share in _SHARES),
    "within 10 %",
    "corrected nearer",
]
"""``orbits`` exist in the exact model, ``stated`` are those with δ below the law's bound; of
these ``exceed`` are beyond the remainder, of the others ``exceed elsewhere``. Quantiles are of
error over predicted value, of all that exist; the last two columns are shares of these."""


def law_errors(size: int, seed: int | Sequence[int], span: Span, release: Release) -> xr.Dataset:
    """Errors of random orbits of the whole stable range, ϖ even in its logarithm.

    Signed relative errors of both simple models, what the law K/ϖ says of the first, and
    |error - K/ϖ|/(S δ), which the law states to be below M, shape (quantity, orbit); ϖ and δ
    of each orbit.
    """
    n, zeta, lam, rng = random_orbits(size, seed, release)
    omega = np.exp(rng.uniform(np.log(span.min), np.log(span.max), size))
    contact = SpringDamper(omega, zeta, release)
    restitution, corrected = errors(contact, n, lam)
    left = remainder(n, Signature(contact)(), lam, restitution)
    shown = {"restitution": restitution, "corrected": corrected}
    shown |= {"law": left.law, "remainder": left.factor}
    return xr.Dataset(
        {
            **{name: (("quantity", "orbit"), values) for name, values in shown.items()},
            "small_parameter": ("orbit", left.small),
            "frequency_ratio": ("orbit", omega),
        }
    )


def sample(size: int, seed: int, span: Span, release: Release) -> xr.Dataset:
    """The errors of ``size`` random orbits, drawn in batches."""
    counts = [min(BATCH, size - start) for start in range(0, size, BATCH)]
    parts = [law_errors(count, (seed, k), span, release) for k, count in enumerate(counts)]
    return xr.concat(parts, "orbit")


def summary(drawn: xr.Dataset, release: Release) -> Iterator[list[str]]:
    """One row for each quantity and range of ϖ, the whole range first."""
    ranges = [(DECADES[0], DECADES[-1]), *pairwise(DECADES)]
    for k, quantity in enumerate(OF_IMPACTS):
        own = drawn.isel(quantity=k)
        for low, high in ranges:
            ratio = own.frequency_ratio
            there = (ratio >= low) & (ratio <= high) & np.isfinite(own.restitution)
            chosen = own.isel(orbit=there.values)
            yield [release, quantity, f"{low:g}", f"{high:g}", *_cells(chosen, quantity)]


def _cells(chosen: xr.Dataset, quantity: Quantity) -> list[str]:
    """Counts, quantiles and shares of one quantity of the orbits chosen."""
    error, left = chosen.restitution.values, chosen.remainder.values
    stated, beyond = chosen.small_parameter.values < STATED, left > REMAINDER[quantity]
    # Without an orbit of its own the corrected model is not nearer.
    nearer = np.abs(chosen.corrected.fillna(np.inf).values) < np.abs(error)
    ratio = error / chosen.law.values
    counts = (error.size, stated.sum(), (beyond & stated).sum(), (beyond & ~stated).sum())
    shares = (np.mean(np.abs(ratio - 1) < 0.1), np.mean(nearer))
    return [
        *(str(int(count)) for count in counts),
        f"{left[stated].max(initial=0.0):.2f}",
        *(f"{value:.4g}" for value in np.quantile(ratio, _SHARES)),
        *(f"{share:.4f}" for share in shares),
    ]
