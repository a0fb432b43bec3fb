"""How well the error law holds over all orbits, as a distribution.

The errors of many random orbits over the values that the law predicts, and how
many are off it by more than the remainder that it states. The numbers are a
sample's: too long for every run, so that the pipeline makes them on request.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from bouncing_ball.accuracy.error_law import REMAINDER, STATED, remainder
from bouncing_ball.accuracy.errors import errors
from bouncing_ball.accuracy.quantities import OF_IMPACTS
from bouncing_ball.contacts.signature import LinearSignature
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


def law_errors(size: int, seed: int | Sequence[int], span: Span, release: Release) -> LawErrors:
    """Errors of random orbits of the whole stable range, ϖ even in its logarithm."""
    n, zeta, lam, rng = random_orbits(size, seed, release)
    omega = np.exp(rng.uniform(np.log(span.min), np.log(span.max), size))
    contact = SpringDamper(omega, zeta, release)
    instant = LinearSignature(contact)()
    restitution, corrected = errors(contact, n, lam)
    left = remainder(n, instant, lam, restitution)
    return LawErrors(omega, restitution, corrected, left.law, left.factor, left.small)


def sample(size: int, seed: int, span: Span, release: Release) -> LawErrors:
    """The errors of ``size`` random orbits, drawn in batches."""
    counts = [min(BATCH, size - start) for start in range(0, size, BATCH)]
    parts = [law_errors(count, (seed, k), span, release) for k, count in enumerate(counts)]
    return LawErrors(*(np.concatenate(part, axis=-1) for part in zip(*parts, strict=True)))


def summary(drawn: LawErrors, release: Release) -> Iterator[list[str]]:
    """One row for each quantity and range of ϖ, the whole range first."""
    ranges = [(DECADES[0], DECADES[-1]), *pairwise(DECADES)]
    for k, quantity in enumerate(OF_IMPACTS):
        for low, high in ranges:
            inside = (drawn.frequency_ratio >= low) & (drawn.frequency_ratio <= high)
            there = inside & np.isfinite(drawn.restitution[k])
            yield [release, quantity, f"{low:g}", f"{high:g}", *_cells(drawn, k, there)]


def _cells(drawn: LawErrors, k: int, there: np.ndarray) -> list[str]:
    """Counts, quantiles and shares of one quantity of the orbits chosen."""
    error, law = drawn.restitution[k, there], drawn.law[k, there]
    left, stated = drawn.remainder[k, there], drawn.small_parameter[there] < STATED
    beyond = left > REMAINDER[OF_IMPACTS[k]]
    corrected = drawn.corrected[k, there]
    # Without an orbit of its own the corrected model is not nearer.
    nearer = np.abs(np.where(np.isfinite(corrected), corrected, np.inf)) < np.abs(error)
    ratio = error / law
    counts = (there.sum(), stated.sum(), (beyond & stated).sum(), (beyond & ~stated).sum())
    shares = (np.mean(np.abs(ratio - 1) < 0.1), np.mean(nearer))
    return [
        *(str(int(count)) for count in counts),
        f"{left[stated].max(initial=0.0):.2f}",
        *(f"{value:.4g}" for value in np.quantile(ratio, _SHARES)),
        *(f"{share:.4f}" for share in shares),
    ]
