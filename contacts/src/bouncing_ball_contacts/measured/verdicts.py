r"""Is a contact law compatible with an experiment? By points that the fit has not seen.

Two tests, each against the errors of the points:

* *left out*: each point against the fit to all others. The sum of the squares of these errors is a
  quadratic form of the errors of the points, whose distribution is taken as a multiple of χ² with
  its first two moments;
* *extrapolated*: the faster half of the points against the fit to the slower half, with the
  uncertainty of this fit.

If the experiment gives no uncertainties the size of the errors is that of the scatter about the
parabola in ln v of least squares, which no law restricts; it takes five points. A law is *rejected*
if one of the tests has a probability below half of the level 0.01 (Bonferroni). It is then
*incompatible* if the uncertainties are given. If only the scatter is known the law *deviates*: a
systematic error of the measurement, which changes smoothly with the speed, is not in the scatter.
How large it has to be is another number, the size of the errors with which both tests would pass. A
law is *compatible* if both probabilities are above 0.05 and the same points reject another law;
otherwise it is *undecided*, because an experiment that rejects no law cannot confirm one.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from bouncing_ball_contacts.measured.curves import LawCurve
from bouncing_ball_contacts.measured.fit import ContactFit
from bouncing_ball_contacts.measured.law_fit import MeasuredPoints, fit_law, quantile_of

REJECTED = 0.01
ACCEPTED = 0.05
# A parabola and as many further points as its variance needs.
_SMOOTH = 3
_FEWEST = 5


class Compatibility(StrEnum):
    """Whether a law is compatible with an experiment."""

    COMPATIBLE = "compatible"
    INCOMPATIBLE = "incompatible"
    DEVIATES = "deviates"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class JudgedLaw:
    """The verdict on one law.

    Parameters
    ----------
    verdict : Compatibility
    left_out, extrapolated : float
        The probabilities of the two tests; NaN if there are too few points.
    extrapolation : float
        Root mean square of the errors at the faster half, of the fit to the slower half.
    needed : float
        The least size of the errors of the points, root mean square of their standard deviations,
        with which the law would not be rejected.
    interval : tuple of float
        95 % interval of r(v₀); of a rejected law by the scatter about it
        (:meth:`.law_fit.LawFit.interval_by_scatter`).
    """

    verdict: Compatibility
    left_out: float
    extrapolated: float
    extrapolation: float
    needed: float
    interval: tuple[float, float]

    @property
    def is_rejected(self) -> bool:
        """Whether the law is incompatible or deviates."""
        return self.verdict in (Compatibility.INCOMPATIBLE, Compatibility.DEVIATES)


@dataclass(frozen=True)
class Unseen:
    """Errors of points that a fit has not seen, against their expected size.

    Parameters
    ----------
    square : float
        Sum of the squares of the errors over its expectation if the errors of the points have the
        standard deviations of :attr:`MeasuredPoints.deviations`.
    freedom : float
        Degrees of freedom of the sum.
    size : float
        Root mean square of the errors.
    """

    square: float
    freedom: float
    size: float = np.nan

    def probability(self, variance: float, freedom: float) -> float:
        """P of errors that are at least as large, if the variance of the points is known with these
        degrees of freedom.
        """
        statistic = self.square / variance
        if np.isinf(freedom):
            return float(scipy.stats.chi2.sf(statistic * self.freedom, self.freedom))
        return float(scipy.stats.f.sf(statistic, self.freedom, freedom))

    @property
    def passed_by(self) -> float:
        """The least factor by which the deviations of the points have to be multiplied, so that
        the test has a probability of half of the level.
        """
        bound = scipy.stats.chi2.isf(REJECTED / 2, self.freedom) / self.freedom
        return float(np.sqrt(self.square / bound))


_NONE = Unseen(np.nan, 1.0)


def smooth(points: MeasuredPoints, speeds: np.ndarray) -> np.ndarray:
    """r at speeds in m/s by the parabola in ln v of least squares through the points.

    NaN if there are fewer than five points or four speeds.

    Examples
    --------
    >>> measured = np.geomspace(1.0, 4.0, 5)
    >>> points = MeasuredPoints(measured, 0.8 - 0.1 * np.log(measured))
    >>> found = smooth(points, np.array([2.0]))
    >>> bool(np.abs(found - (0.8 - 0.1 * np.log(2.0))).max() < 1e-12)
    True
    """
    if points.size < _FEWEST or np.unique(points.speeds).size < _SMOOTH + 1:
        return np.full(np.shape(speeds), np.nan)
    whiten = points.whitening
    best = np.linalg.lstsq(
        whiten @ _powers(points, points.speeds), whiten @ points.restitutions, rcond=None
    )[0]
    return _powers(points, speeds) @ best


def smooth_interval(points: MeasuredPoints, speed: float) -> tuple[float, float]:
    """95 % interval of a single impact about :func:`smooth`, at a speed in m/s among those of the
    points; NaN where there is no curve.

    It is Student's with the scatter about the parabola, or with the given uncertainties if these
    are larger. The scatter of an impact is part of it, because no law says that the parabola is
    right between the points.

    Examples
    --------
    >>> measured = np.geomspace(1.0, 4.0, 8)
    >>> e = 0.8 - 0.1 * np.log(measured) + 0.01 * np.resize([1, -1], 8)
    >>> low, high = smooth_interval(MeasuredPoints(measured, e), 2.0)
    >>> bool(low < 0.8 - 0.1 * np.log(2.0) < high)
    True
    """
    variance, freedom = scatter(points)
    if np.isnan(variance):
        return np.nan, np.nan
    if points.is_known:
        variance = max(variance, 1.0)
    rows = points.whitening @ _powers(points, points.speeds)
    at = _powers(points, np.array([speed]))[0]
    order = np.argsort(points.speeds)
    deviation = np.interp(speed, points.speeds[order], points.deviations[order])
    error = np.sqrt(variance * (deviation**2 + at @ np.linalg.solve(rows.T @ rows, at)))
    away = quantile_of(False, int(freedom)) * error
    r = float(smooth(points, np.array([speed]))[0])
    return float(r - away), float(r + away)


def _powers(points: MeasuredPoints, speeds: np.ndarray) -> np.ndarray:
    """The powers of ln v of the parabola."""
    return np.vander(np.log(speeds / points.reference), _SMOOTH)


def _about_a_parabola(points: MeasuredPoints) -> np.ndarray:
    """The whitened points minus their parabola in ln v; NaN if there are too few."""
    return points.whitening @ (points.restitutions - smooth(points, points.speeds))


def scatter(points: MeasuredPoints) -> tuple[float, float]:
    """The variance of the whitened points about the parabola in ln v of least squares, and its
    degrees of freedom; NaN if there are fewer than five points or four speeds.

    Examples
    --------
    >>> speeds = np.geomspace(1.0, 4.0, 5)
    >>> scatter(MeasuredPoints(speeds, 0.8 - 0.1 * np.log(speeds)))[1]
    2.0
    """
    left = _about_a_parabola(points)
    freedom = points.size - _SMOOTH
    variance = float(left @ left / freedom) if freedom > 0 else np.nan
    return variance, float(freedom) if np.isfinite(variance) else np.nan


def noise(points: MeasuredPoints) -> tuple[float, float]:
    """The variance of the errors of the whitened points, and its degrees of freedom.

    NaN if it is not known.

    Examples
    --------
    >>> noise(MeasuredPoints(np.array([1.0]), np.array([0.5]), np.array([[1e-4]])))
    (1.0, inf)
    """
    return (1.0, np.inf) if points.is_known else scatter(points)


def error_size(points: MeasuredPoints) -> float:
    """Root mean square of the standard deviations of the points, those given or those by the
    scatter; NaN if neither is known.

    Examples
    --------
    >>> error_size(MeasuredPoints(np.array([1.0]), np.array([0.5]), np.array([[1e-4]])))
    0.01
    """
    return float(np.sqrt(noise(points)[0] * np.mean(points.deviations**2)))


def trend_of_scatter(points: MeasuredPoints) -> float:
    """Probability of a trend of the scatter with ln v that is at least as strong, if the errors of
    the points have the ratios of their covariance; NaN if there are too few points.

    The score test of a variance ``exp(a + b ln v)`` against b = 0, with the limit of many points
    for the distribution of its statistic, which is half of the explained sum of squares of the
    squared residuals over their mean (Cook and Weisberg, Biometrika 70, 1983; from memory).

    Examples
    --------
    >>> speeds = np.geomspace(1.0, 8.0, 40)
    >>> signs = np.resize([1, -1], 40)
    >>> growing, equal = (
    ...     MeasuredPoints(speeds, 0.8 + 0.01 * signs * speeds**b) for b in (1, 0)
    ... )
    >>> trend_of_scatter(growing) < 1e-2, trend_of_scatter(equal) > 0.9
    (True, True)
    """
    square = _about_a_parabola(points) ** 2
    if not np.any(square > 0):
        return np.nan
    x = np.log(points.speeds)
    trend = x - x.mean()
    slope = trend @ (square / square.mean())
    return float(scipy.stats.chi2.sf(slope**2 / (2 * trend @ trend), 1))


def left_out(curve: LawCurve, points: MeasuredPoints) -> Unseen:
    """The errors at points that are left out of the fit."""
    if points.size < 3:
        return _NONE
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
    return Unseen(float(np.sum((scale * errors) ** 2) / total), float(total**2 / square))


def extrapolation_errors(curve: LawCurve, points: MeasuredPoints) -> Unseen:
    """The errors at the faster half of the points, of a fit to the slower half."""
    order = np.argsort(points.speeds, kind="stable")
    half = points.size // 2
    if half < 2 or np.ptp(points.speeds) == 0:
        return _NONE
    slow = points.take(order[:half])
    fast = points.take(order[half:])
    fit = fit_law(curve, slow)
    errors = fast.restitutions - fit.restitution_at(fast.speeds)
    steep = slow.whitening @ curve.slope(fit.theta, slow.speeds / fit.speed)
    ahead = fast.whitening @ curve.slope(fit.theta, fast.speeds / fit.speed)
    spread = np.eye(fast.size) + np.outer(ahead, ahead) / (steep @ steep)
    white = fast.whitening @ errors
    return Unseen(
        square=float(white @ np.linalg.solve(spread, white) / fast.size),
        freedom=float(fast.size),
        size=float(np.sqrt(np.mean(errors**2))),
    )


def judge(fit: ContactFit) -> dict[str, JudgedLaw]:
    """The verdicts on all laws of a fit, by the name of the law."""
    points = fit.points
    variance = noise(points)
    tests = {
        each.law: (left_out(each.curve, points), extrapolation_errors(each.curve, points))
        for each in fit.laws
    }
    found = {
        name: (one.probability(*variance), other.probability(*variance))
        for name, (one, other) in tests.items()
    }
    rejected = {name for name, both in found.items() if np.nanmin([*both, np.inf]) < REJECTED / 2}
    size = float(np.sqrt(np.mean(points.deviations**2)))
    judged = {}
    for each in fit.laws:
        one, other = tests[each.law]
        verdict = _verdict(points, each.law in rejected, bool(rejected), found[each.law])
        judged[each.law] = JudgedLaw(
            verdict=verdict,
            left_out=found[each.law][0],
            extrapolated=found[each.law][1],
            extrapolation=other.size,
            needed=size * float(np.fmax(one.passed_by, other.passed_by)),
            interval=(
                each.interval_by_scatter(each.speed) if each.law in rejected else each.interval
            ),
        )
    return judged


def _verdict(
    points: MeasuredPoints, is_rejected: bool, is_decisive: bool, found: tuple[float, float]
) -> Compatibility:
    if is_rejected:
        return Compatibility.INCOMPATIBLE if points.is_known else Compatibility.DEVIATES
    if is_decisive and all(p > ACCEPTED for p in found):
        return Compatibility.COMPATIBLE
    return Compatibility.UNDECIDED


@dataclass(frozen=True)
class RestitutionAtSpeed:
    """The restitution coefficient at one impact speed, and where it is from.

    Parameters
    ----------
    restitution : float
    interval : tuple of float
        95 % interval; NaN if it is not known.
    law : str or None
        The law that it is from; None for the smooth curve (:func:`smooth`).
    is_of_a_law_that_fits : bool
        False if the points reject each law.
    """

    restitution: float
    interval: tuple[float, float]
    law: str | None
    is_of_a_law_that_fits: bool


def restitution_at_speed(
    fit: ContactFit, judged: Mapping[str, JudgedLaw], speed: float
) -> RestitutionAtSpeed:
    """r at an impact speed in m/s: of the best law or, if the points reject all laws, of the smooth
    curve through them.

    Where there is no such curve, because it takes five points, and the speed is not beyond them, r
    is that of the law with the smallest rms, with its interval by the scatter.

    Examples
    --------
    >>> from bouncing_ball_contacts.measured.fit import fit_contact
    >>> v = np.geomspace(0.5, 6.0, 12)
    >>> fit = fit_contact(v, 0.9 - 0.03 * v, uncertainties=1e-3)
    >>> found = restitution_at_speed(fit, judge(fit), 3.0)
    >>> found.law is None, abs(found.restitution - 0.81) < 0.01
    (True, True)
    """
    if not all(each.is_rejected for each in judged.values()):
        low, high = (float(end) for end in fit.best.band(speed))
        r = float(fit.best.restitution_at(speed))
        return RestitutionAtSpeed(r, (low, high), fit.best.law, True)
    points = fit.points
    between = float(smooth(points, np.array([speed]))[0])
    if points.speeds.min() <= speed <= points.speeds.max() and 0 < between <= 1:
        return RestitutionAtSpeed(between, smooth_interval(points, speed), None, False)
    least = min(fit.laws, key=lambda each: each.rms)
    r = float(least.restitution_at(speed))
    return RestitutionAtSpeed(r, least.interval_by_scatter(speed), least.law, False)
