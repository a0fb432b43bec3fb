"""Samples of the motions on which balls end: what several stages share.

These are the types of their parameters, the three models that they compare, and estimates with
confidence intervals from samples of balls or of places in the plane of (Λ, r).

If a motion is chaotic, or lies next to the boundary of a basin, rounding errors decide its course
after some tens of impacts. Datasets therefore contain kinds of motions, and means over many
impacts, but no single impacts. How fine the boundaries are is measured by the uncertainty exponent:
the share of starts, or of parameters, whose result changes if they are changed by ε is proportional
to ε^α, where α = 2 - D for a boundary of dimension D in a plane (C. Grebogi, S. W. McDonald, E. Ott
and J. A. Yorke, 1983).
"""

from typing import Annotated, NamedTuple

import numpy as np
import scipy
from pydantic import Field

from bouncing_ball.accuracy.simple_models import SIMPLE, exact_and_simple_models
from bouncing_ball.datasets.parameters import (
    Amplitude,
    AmplitudeMax,
    FrequencyRatio,
    Interval,
    LossyRestitution,
    Many,
    Sharded,
    number,
)
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper

Confidence = Annotated[float, number("level of the confidence intervals", gt=0.5, lt=1)]
MostImpacts = Annotated[
    int,
    number(
        "number of impacts after which the search for a repetition ends; an exponent with "
        "its error needs some hundreds",
        ge=200,
        le=100000,
    ),
]


class Even(Interval):
    """Equally spaced values of a parameter, both ends included."""

    samples: Annotated[int, number("number of values, both ends included", ge=2, le=2001)]

    def grid(self) -> np.ndarray:
        """The values, shape (samples,)."""
        return np.linspace(self.min, self.max, self.samples)


class Amplitudes(Even):
    """Equally spaced amplitudes Λ > 0 of the table's acceleration, at most 100 g."""

    min: Annotated[Amplitude, Field(description="smallest Λ")]
    max: Annotated[AmplitudeMax, Field(description="largest Λ, above min")]


class Restitutions(Even):
    """Equally spaced restitution coefficients r, of which none is elastic."""

    min: Annotated[LossyRestitution, Field(description="smallest r")]
    max: Annotated[LossyRestitution, Field(description="largest r, above min")]


class PlaneNodes(Sharded):
    """A grid over the plane of (Λ, r)."""

    amplitude: Amplitudes
    restitution: Restitutions
    confidence: Confidence

    def places(self) -> np.ndarray:
        """r and Λ of all nodes, those with one r after each other, shape (2, nodes)."""
        r, lam = np.meshgrid(self.restitution.grid(), self.amplitude.grid(), indexing="ij")
        return np.stack([r.ravel(), lam.ravel()])

    def unfolded(self, values: np.ndarray) -> np.ndarray:
        """Values over all nodes, their last axis, over (restitution, amplitude)."""
        leading = values.shape[:-1]
        return values.reshape((*leading, self.restitution.samples, self.amplitude.samples))


class ParameterPlane(PlaneNodes):
    """A grid over the plane of (Λ, r), and contacts at several ϖ."""

    frequency_ratio: Many[FrequencyRatio]
    impacts: MostImpacts


MODELS = (*SIMPLE, "spring-damper")
LEAST_ERROR = 1e-5
"""Smallest error that is given for a Lyapunov exponent. A motion repeats within 1e-6 of its state,
so that the error of its multipliers is about 1e-6 times the curvature of the map, which is of order
one to ten."""
LIMITS = ("", "_low", "_high")
"""Suffixes of the names of an estimate and of the two limits of its interval."""


class ThreeModels(NamedTuple):
    """The models of one contact, in the order of :data:`MODELS`."""

    restitution: RestitutionModel
    corrected: CorrectedModel
    contact: ContactModel


def three_models(
    restitution: np.ndarray, ratio: float | np.ndarray, release: Release
) -> ThreeModels:
    """Restitution, corrected and spring-damper model with the r of a free impact on the contact.

    Parameters
    ----------
    restitution, ratio : array_like
        r by Eq. 16, which gives the contact its ζ, and ϖ. They broadcast.
    release : Release
        The rule that ends the contact.

    Returns
    -------
    ThreeModels
        The restitution model has the shape of r, the others that to
        which r and ϖ broadcast.
    """
    contact = SpringDamper.from_restitution(restitution, ratio, release)
    exact, simple, corrected = exact_and_simple_models(contact)
    return ThreeModels(restitution=simple, corrected=corrected, contact=exact)


def share(chosen: np.ndarray, confidence: float) -> tuple[float, float, float, float]:
    """The number of truth values, the share of those that are true, and its Wilson limits.

    The limits hold for independent values. The share and its limits are NaN if there are no values.

    Parameters
    ----------
    chosen : array of bool
        Of any shape.
    confidence : float
        The probability with which the interval contains the share, in (0, 1).

    Returns
    -------
    tuple of float
        Number, share, lower limit and upper limit.

    Examples
    --------
    >>> count, found, low, high = share(np.array([True, False, True, False]), 0.95)
    >>> count, found, round(float(low + high), 12)
    (4, 0.5, 1.0)
    """
    if not chosen.size:
        return 0, np.nan, np.nan, np.nan
    tested = scipy.stats.binomtest(int(chosen.sum()), chosen.size)
    low, high = tested.proportion_ci(confidence, "wilson")
    return chosen.size, tested.statistic, low, high


def share_with_limits(chosen: np.ndarray, confidence: float) -> tuple[float, float, float]:
    """The share of the truth values that are true, and its limits, see :func:`share`."""
    _, found, low, high = share(chosen, confidence)
    return found, low, high


def with_limits(estimates: dict[str, tuple]) -> dict[str, tuple]:
    """The variables of estimates and of their limits, under names with the suffixes :data:`LIMITS`.

    The values of ``estimates`` are pairs of dimensions and arrays, whose last axis holds an
    estimate, its lower limit and its upper limit.

    Examples
    --------
    >>> found = with_limits({"share": ("case", [[0.5, 0.4, 0.6]])})
    >>> {name: values.tolist() for name, (dims, values) in found.items()}
    {'share': [0.5], 'share_low': [0.4], 'share_high': [0.6]}
    """
    return {
        f"{name}{end}": (dims, np.array(values)[..., k])
        for name, (dims, values) in estimates.items()
        for k, end in enumerate(LIMITS)
    }


# Number of samples of the bootstrap, and the seed of its random numbers.
_RESAMPLED = 400
_SEED = 1


def uncertainty_exponent(changes: np.ndarray, size: np.ndarray, confidence: float) -> np.ndarray:
    """α with its lower and upper limit, from independent results that change or do not change.

    α is the slope of the least-squares line of the logarithm of the share over ln ε, weighted with
    the number of changes, because the variance of the logarithm of a small count is about the
    inverse of the count. Its interval is that of a bootstrap. A share of 0 counts as half a change.

    Parameters
    ----------
    changes : array of bool, shape (results, sizes)
        Whether each result changes with each size ε of the change.
    size : array, shape (sizes,)
        At least two different ε > 0.
    confidence : float
        The probability with which the interval contains α, in (0, 1).

    Returns
    -------
    array, shape (3,)
        α, its lower limit and its upper limit.

    Examples
    --------
    >>> changes = np.arange(1000)[:, np.newaxis] < [100, 10]
    >>> alpha, low, high = uncertainty_exponent(changes, np.array([1e-2, 1e-4]), 0.95)
    >>> round(float(alpha), 9)
    0.5
    """
    count = len(changes)
    drawn = np.random.default_rng(_SEED).integers(count, size=(_RESAMPLED, count))
    # The first sample is the original one.
    drawn[0] = np.arange(count)
    shares = np.maximum(changes[drawn].mean(axis=1), 0.5 / count)
    slopes, _ = np.polyfit(np.log(size), np.log(shares).T, 1, w=np.sqrt(shares[0]))
    low, high = np.quantile(slopes, [(1 - confidence) / 2, (1 + confidence) / 2])
    return np.array([slopes[0], low, high])
