r"""Is a contact law compatible with an experiment? By points that the fit has not seen.

Two tests, each against the experiment's uncertainty:

* *left out*: each point against the fit to all others. The sum of the squares of these errors is a
  quadratic form of the errors of the points, whose distribution is taken as a multiple of χ² with
  its first two moments;
* *extrapolated*: the faster half of the points against the fit to the slower half, with the
  uncertainty of this fit.

The uncertainty is the one given, or the scatter about the parabola in ln v of least squares, which
no law restricts; it takes five points. A law is *incompatible* if one of the tests has a
probability below half of the level 0.01 (Bonferroni); *compatible* if both have one above 0.05 and
the same points reject another law; otherwise *undecided*, because an experiment that rejects no law
cannot confirm one.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from bouncing_ball.measured.curves import Curve
from bouncing_ball.measured.fit import ContactFit, Points, fit_law

REJECTED = 0.01
ACCEPTED = 0.05
# A parabola and as many further points as its variance needs.
_SMOOTH = 3
_FEWEST = 5


class Verdict(StrEnum):
    """Whether a law is compatible with an experiment."""

    COMPATIBLE = "compatible"
    INCOMPATIBLE = "incompatible"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Judgement:
    """The verdict on one law.

    Parameters
    ----------
    verdict : Verdict
    left_out, extrapolated : float
        The probabilities of the two tests; NaN if there are too few points.
    extrapolation : float
        Root mean square of the errors at the faster half, of the fit to the slower half.
    """

    verdict: Verdict
    left_out: float
    extrapolated: float
    extrapolation: float


def noise(points: Points) -> tuple[float, float]:
    """The variance of the errors of the whitened points, and its degrees of freedom.

    NaN if it is not known.

    Examples
    --------
    >>> noise(Points(np.array([1.0]), np.array([0.5]), np.array([[1e-4]])))
    (1.0, inf)
    """
    if points.covariance is not None:
        return 1.0, np.inf
    if points.size < _FEWEST or np.unique(points.speeds).size < _SMOOTH + 1:
        return np.nan, np.nan
    x = np.log(points.speeds / points.reference)
    smooth = np.polynomial.Polynomial.fit(x, points.restitutions, _SMOOTH - 1)
    freedom = points.size - _SMOOTH
    return float(np.sum((points.restitutions - smooth(x)) ** 2) / freedom), float(freedom)


def _tail(statistic: float, first: float, second: float) -> float:
    """P(F > x), or P(χ²/f > x) if the variance is known."""
    if np.isinf(second):
        return float(scipy.stats.chi2.sf(statistic * first, first))
    return float(scipy.stats.f.sf(statistic, first, second))


def left_out(curve: Curve, points: Points) -> float:
    """The probability of errors at left-out points that are at least as large."""
    variance, freedom = noise(points)
    if points.size < 3 or not np.isfinite(variance):
        return np.nan
    fit = fit_law(curve, points)
    ratio = points.speeds / fit.speed
    whiten = points.whitening
    errors = whiten @ (points.restitutions - curve.restitution(fit.theta, ratio))
    slope = whiten @ curve.slope(fit.theta, ratio)
    hat = np.outer(slope, slope) / (slope @ slope)
    scale = 1 / (1 - np.diag(hat))
    spread = np.linalg.eigvalsh((np.eye(points.size) - hat) * np.outer(scale, scale))
    total = spread.sum()
    square = (spread**2).sum()
    statistic = np.sum((scale * errors) ** 2) / (variance * total)
    return _tail(float(statistic), float(total**2 / square), freedom)


def extrapolated(curve: Curve, points: Points) -> tuple[float, float]:
    """The probability of errors at the faster half that are at least as large, and their root mean
    square.
    """
    order = np.argsort(points.speeds, kind="stable")
    half = points.size // 2
    if half < 2 or np.ptp(points.speeds) == 0:
        return np.nan, np.nan
    slow = points.take(order[:half])
    fast = points.take(order[half:])
    fit = fit_law(curve, slow)
    errors = fast.restitutions - fit.restitution_at(fast.speeds)
    size = float(np.sqrt(np.mean(errors**2)))
    variance, freedom = noise(points)
    if not np.isfinite(variance):
        return np.nan, size
    steep = slow.whitening @ curve.slope(fit.theta, slow.speeds / fit.speed)
    ahead = fast.whitening @ curve.slope(fit.theta, fast.speeds / fit.speed)
    spread = np.eye(fast.size) + np.outer(ahead, ahead) / (steep @ steep)
    white = fast.whitening @ errors
    statistic = white @ np.linalg.solve(spread, white) / (variance * fast.size)
    return _tail(float(statistic), float(fast.size), freedom), size


def judge(fit: ContactFit) -> dict[str, Judgement]:
    """The verdicts on all laws of a fit, by the name of the law."""
    tests = {
        each.law: (left_out(each.curve, fit.points), *extrapolated(each.curve, fit.points))
        for each in fit.laws
    }
    least = {name: np.nanmin([a, b, np.inf]) for name, (a, b, _) in tests.items()}
    rejected = {name for name, p in least.items() if p < REJECTED / 2}
    found = {}
    for name, (one, other, size) in tests.items():
        if name in rejected:
            verdict = Verdict.INCOMPATIBLE
        elif rejected and one > ACCEPTED and other > ACCEPTED:
            verdict = Verdict.COMPATIBLE
        else:
            verdict = Verdict.UNDECIDED
        found[name] = Judgement(verdict, one, other, size)
    return found
