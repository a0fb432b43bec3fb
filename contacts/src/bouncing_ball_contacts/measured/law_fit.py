r"""A contact law fitted to measured restitution coefficients.

The parameter θ of the law (:mod:`bouncing_ball_contacts.measured.curves`) is fitted by least
squares, weighted if the uncertainties are given. Then the intervals are those of the normal
distribution, and χ² tests the fit. Otherwise the variance of the points is estimated from the fit
itself, up to the ratios of the errors if these are known, the intervals are Student's, and no test
of the fit follows from the points alone (:mod:`bouncing_ball_contacts.measured.verdicts` takes the
scatter about a smooth curve). The error of leaving out one point follows from the fit of all
points: ``(e_i - r(v_i))/(1 - h_i)``, h the diagonal of the hat matrix.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import (
    ModelError,
)
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.table import Table
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.measured.curves import LawCurve

# The probability of the intervals.
LEVEL = 0.95
# The least-squares fit ends in the rounding of a sum of squares, where θ has about half of the
# digits. The zero of its derivative has all; the secant starts with this step.
_SECANT = 1e-6
_SECANTS = 8
# How far the least-squares fit may be from it.
_NEXT = 1e-2
_POSITIVE = "a finite number > 0"
# Steps of the fixed point for the impact speed on a table, a contraction.
_SPEEDS = 60


@dataclass(frozen=True)
class MeasuredPoints:
    """Measured impacts, checked.

    Parameters
    ----------
    speeds, restitutions : ndarray, shape (n,)
        In m/s, and in (0, 1].
    covariance : ndarray, shape (n, n), or None
        Covariance of the restitution coefficients; None if their errors are independent and equal,
        of a size that is not known.
    is_relative : bool
        Whether the covariance is known up to a factor only.
    """

    speeds: np.ndarray
    restitutions: np.ndarray
    covariance: np.ndarray | None = None
    is_relative: bool = False

    @property
    def is_known(self) -> bool:
        """Whether the uncertainties are known; otherwise they follow from a scatter."""
        return self.covariance is not None and not self.is_relative

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations of the points, up to a factor if they are not known."""
        if self.covariance is None:
            return np.ones(self.size)
        return np.sqrt(np.diag(self.covariance))

    @property
    def size(self) -> int:
        """The number of points."""
        return self.speeds.size

    @property
    def reference(self) -> float:
        """v₀: the geometric mean of the speeds."""
        return float(np.exp(np.mean(np.log(self.speeds))))

    @property
    def whitening(self) -> np.ndarray:
        """The matrix that makes the errors of the points independent and of variance 1; without
        a covariance, the unit matrix.
        """
        if self.covariance is None:
            return np.eye(self.size)
        return np.linalg.inv(np.linalg.cholesky(self.covariance))

    def take(self, which: np.ndarray) -> "MeasuredPoints":
        """Some of the points, by a mask or by indices."""
        kept = None if self.covariance is None else self.covariance[which][:, which]
        return replace(
            self,
            speeds=self.speeds[which],
            restitutions=self.restitutions[which],
            covariance=kept,
        )


@dataclass(frozen=True)
class LawFit:
    """A contact law that is fitted to measured impacts.

    Parameters
    ----------
    curve : LawCurve
        The law.
    speed : float
        v₀ in m/s, at which ``restitution`` and ``contact_time`` are given.
    theta, theta_error : float
        The parameter θ and its standard error; NaN if a single point determines it.
    quantile : float
        The standard errors on each side of θ in its 95 % interval.
    restitution : float
        r(v₀).
    interval : tuple of float
        95 % interval of r(v₀); NaN if it is not known.
    rms : float
        Root mean square of e - r(v).
    chi_square, p_value : float
        χ² of the fit, and the probability of a greater one; NaN without uncertainties.
    freedom : int
        The degrees of freedom ν of the fit.
    criterion : float
        Akaike's criterion with the correction for few points; NaN for fewer than four.
    left_out : float
        Root mean square of the errors of points that are left out; NaN for one point.
    contact_time : float
        T(v₀) in s; NaN if no contact time is known.
    time_interval : tuple of float
        95 % interval of T(v₀).
    mass : float or None
        Mass of the ball in kg.
    """

    curve: LawCurve
    speed: float
    theta: float
    theta_error: float
    quantile: float
    restitution: float
    interval: tuple[float, float]
    rms: float
    chi_square: float
    p_value: float
    freedom: int
    criterion: float
    left_out: float
    contact_time: float = np.nan
    time_interval: tuple[float, float] = (np.nan, np.nan)
    mass: float | None = None

    @property
    def law(self) -> str:
        """The name of the law."""
        return self.curve.name

    @property
    def has_stiffness(self) -> bool:
        """Whether a contact time determines the stiffness."""
        return bool(np.isfinite(self.contact_time))

    def restitution_at(self, speed: ArrayLike) -> np.ndarray:
        """r at impact speeds in m/s."""
        return self.curve.restitution(self.theta, np.asarray(speed, dtype=float) / self.speed)

    def trend_at(self, speed: ArrayLike) -> np.ndarray:
        """v dr/dv at impact speeds in m/s."""
        return self.curve.trend(self.theta, np.asarray(speed, dtype=float) / self.speed)

    def band(self, speed: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """The 95 % band of r at impact speeds in m/s; NaN if it is not known."""
        ratio = np.asarray(speed, dtype=float) / self.speed
        away = self.quantile * self.theta_error
        if not np.isfinite(away):
            return np.full(ratio.shape, np.nan), np.full(ratio.shape, np.nan)
        one, other = (self.curve.restitution(self.theta + s * away, ratio) for s in (-1, 1))
        return np.minimum(one, other), np.maximum(one, other)

    def interval_by_scatter(self, speed: float) -> tuple[float, float]:
        """95 % interval of r at an impact speed in m/s for a law that the points reject.

        It is that of a single impact, ``r ∓ t s`` with the scatter ``s² = Σ(e - r(v))²/ν`` about
        the law and Student's t, because at one speed a wrong law is wrong by about as much as the
        points are from it. More points do not narrow it, whereas the interval of θ holds under
        the law only. NaN for one point.

        Examples
        --------
        >>> from bouncing_ball_contacts.measured.curves import curve_named
        >>> v, e = np.array([1.0, 2.0, 3.0]), np.array([0.9, 0.8, 0.85])
        >>> one, more = (
        ...     fit_law(curve_named("tsuji"), MeasuredPoints(np.tile(v, k), np.tile(e, k)))
        ...     for k in (1, 100)
        ... )
        >>> [round(float(np.ptp(fit.interval)), 3) for fit in (one, more)]
        [0.248, 0.009]
        >>> [round(float(np.ptp(fit.interval_by_scatter(2.0))), 3) for fit in (one, more)]
        [0.365, 0.161]
        """
        if not self.freedom:
            return np.nan, np.nan
        spread = self.rms * np.sqrt((self.freedom + 1) / self.freedom)
        away = quantile_of(False, self.freedom) * spread
        r = float(self.restitution_at(speed))
        return float(max(r - away, 0.0)), float(min(r + away, 1.0))

    def duration_at(self, speed: ArrayLike) -> np.ndarray:
        """The contact time in s at impact speeds in m/s.

        Raises
        ------
        ModelError
            If no contact time is known.
        """
        self._require_stiffness()
        ratio = np.asarray(speed, dtype=float) / self.speed
        one = self.curve.duration(self.theta, 1.0)
        return self.contact_time * self.curve.duration(self.theta, ratio) / one

    def _require_stiffness(self) -> None:
        if not self.has_stiffness:
            raise ModelError(
                f"{self.law}: the stiffness is not identified by restitution coefficients: "
                "a contact time is needed"
            )

    def parameters(self) -> dict[str, float]:
        """The parameters of the law in SI units; per kg where they need a mass that is not known.

        Raises
        ------
        ModelError
            If no contact time is known.
        """
        self._require_stiffness()
        assert self.curve.kind is not None
        # In these units gravity is 1 and the unit of time a second.
        length = STANDARD_GRAVITY
        r = min(self.restitution, 1.0)
        law = law_of_impact(self.curve.kind, r, self.contact_time, self.speed / length)
        return law.in_si(self.mass or 1.0, length, 1.0)

    @property
    def units(self) -> dict[str, str]:
        """The names of the units of the parameters of the law."""
        kind = self.curve.kind
        return {} if kind is None else {name: unit.name for name, unit in kind.units.items()}

    def contact(self, speed: float | None = None, mass: Any = None) -> Contact:
        """The contact of this law, for ``assess_contact``.

        ``write_contact`` takes it for the engines that have the law; for all engines see
        :meth:`linear_contact`.

        Parameters
        ----------
        speed : float, optional
            Impact speed in m/s at which the contact has the r and the contact time of the law; by
            default v₀. For a table see :meth:`contact_on`.
        mass
            Mass of the ball, if it is not known from the experiment.

        Raises
        ------
        ModelError
            If the mass is not known.
        """
        contact = self.linear_contact(speed, mass)
        return replace(contact, law=self.law) if self.has_stiffness else contact

    def linear_contact(self, speed: float | None = None, mass: Any = None) -> Contact:
        """The spring and damper with the r and the contact time of this law at one impact speed,
        for ``write_contact`` and all engines. At other speeds the law has another r.

        Parameters
        ----------
        speed : float, optional
            Impact speed in m/s, by default v₀.
        mass
            Mass of the ball, if it is not known from the experiment.

        Raises
        ------
        ModelError
            If the mass is not known.
        """
        v = self.speed if speed is None else speed
        weight = self.mass if mass is None else mass
        r = float(self.restitution_at(v))
        time = float(self.duration_at(v)) if self.has_stiffness else None
        return Contact(mass=weight, contact_time=time, measured_restitution=r)

    def speed_on(self, table: Table, n: int = 1) -> float:
        """Impact speed in m/s of the n-T orbit on a table, 2πn/(1 + r(v)) g/Ω."""
        return orbit_speed(table, self.restitution_at, n)

    def contact_on(self, table: Table, n: int = 1, mass: Any = None) -> Contact:
        """The contact at the impact speed of the n-T orbit on a table."""
        return self.contact(self.speed_on(table, n), mass)


def orbit_speed(table: Table, restitution: Callable[[float], Any], n: int = 1) -> float:
    """Impact speed in m/s of the n-T orbit on a table, 2πn/(1 + r(v)) g/Ω, with r as a function of
    the speed in m/s.

    Examples
    --------
    >>> v = orbit_speed(Table(frequency=1.0, acceleration=20.0, gravity=10.0), lambda v: 0.6)
    >>> round(v * 1.6, 12)
    10.0
    """
    motion = table.motion
    unit = motion.gravity / motion.angular_frequency
    v = unit
    for _ in range(_SPEEDS):
        v = float(rigid_speed(n, restitution(v))) * unit
    return v


def fit_law(curve: LawCurve, points: MeasuredPoints) -> LawFit:
    """One law fitted to the restitution coefficients.

    Examples
    --------
    >>> from bouncing_ball_contacts.measured.curves import curve_named
    >>> points = MeasuredPoints(np.array([1.0, 2.0]), np.array([0.9, 0.8]))
    >>> round(fit_law(curve_named("tsuji"), points).restitution, 9)
    0.85
    """
    v0 = points.reference
    ratio = points.speeds / v0
    whiten = points.whitening

    def residuals(theta: Sequence[float]) -> np.ndarray:
        return whiten @ (points.restitutions - curve.restitution(float(theta[0]), ratio))

    def jacobian(theta: Sequence[float]) -> np.ndarray:
        return -(whiten @ curve.slope(float(theta[0]), ratio))[:, np.newaxis]

    start = curve.parameter(float(np.median(points.restitutions)))
    found = scipy.optimize.least_squares(residuals, [start], jac=jacobian)
    theta = float(found.x[0])
    if not curve.is_constant:
        theta = _polished(lambda x: float(jacobian([x])[:, 0] @ residuals([x])), theta)
    slope = curve.slope(theta, ratio)
    weight = float(np.sum((whiten @ slope) ** 2))
    left = residuals([theta])
    plain = points.restitutions - curve.restitution(theta, ratio)
    freedom = points.size - 1
    is_known = points.is_known
    square = float(left @ left)
    variance = 1.0 if is_known else (square / freedom if freedom else np.nan)
    # Where r is so close to 1 that it does not depend on θ, nothing determines θ.
    error = float(np.sqrt(variance / weight)) if weight > 0 else np.nan
    quantile = float(quantile_of(is_known, freedom))
    away = quantile * error
    interval = (np.nan, np.nan)
    if np.isfinite(away):
        low, high = sorted(float(curve.restitution(theta + s * away, 1.0)) for s in (-1, 1))
        interval = (low, high)
    return LawFit(
        curve=curve,
        speed=v0,
        theta=theta,
        theta_error=error,
        quantile=quantile,
        restitution=float(curve.restitution(theta, 1.0)),
        interval=interval,
        rms=float(np.sqrt(np.mean(plain**2))),
        chi_square=square if is_known else np.nan,
        p_value=float(scipy.stats.chi2.sf(square, freedom)) if is_known and freedom else np.nan,
        freedom=freedom,
        criterion=_criterion(square, points.size, is_known),
        left_out=_left_out(plain, slope, points),
    )


def _polished(derivative: Callable[[float], float], theta: float) -> float:
    """The zero of the derivative of the sum of squares next to θ; θ if there is none."""
    now = theta
    before = theta + _SECANT
    old = derivative(before)
    for _ in range(_SECANTS):
        value = derivative(now)
        if value == old:
            break
        step = value * (now - before) / (value - old)
        if not abs(now - step - theta) < _NEXT:
            return theta
        before = now
        now = now - step
        old = value
    return now


def quantile_of(is_known: bool, freedom: int) -> float:
    """The quantile of the two-sided interval."""
    share = 0.5 + LEVEL / 2
    if is_known:
        return scipy.stats.norm.ppf(share)
    return scipy.stats.t.ppf(share, freedom) if freedom else np.nan


def _criterion(square: float, size: int, is_known: bool) -> float:
    """AICc, with one parameter of the law, and the variance as another if it is not known."""
    count = 1 if is_known else 2
    if size < count + 2:
        return np.nan
    deviance = square if is_known else size * np.log(max(square, np.finfo(float).tiny) / size)
    return float(deviance + 2 * count + 2 * count * (count + 1) / (size - count - 1))


def _left_out(plain: np.ndarray, slope: np.ndarray, points: MeasuredPoints) -> float:
    """Root mean square of the errors at points that are left out of the fit."""
    if points.size < 2:
        return np.nan
    weights = 1 / points.deviations**2
    hat = weights * slope**2 / np.sum(weights * slope**2)
    return float(np.sqrt(np.mean((plain / (1 - hat)) ** 2)))
