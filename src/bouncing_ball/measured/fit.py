r"""The parameters of contact laws from measured restitution coefficients and contact times.

Of each law the parameter θ (:mod:`bouncing_ball.measured.curves`) is fitted to the restitution
coefficients by least squares, weighted if their uncertainties are given; the time scale τ follows
from the contact times. Contact times tell nothing of the loss, and restitution coefficients nothing
of the stiffness, so that the two fits are separate.

With given uncertainties the intervals are those of the normal distribution, and χ² tests the fit.
Otherwise the variance of the points is estimated from the fit itself, up to the ratios of the
errors if these are known, the intervals are Student's, and no test of the fit follows from the
points alone (:mod:`bouncing_ball.measured.verdicts` takes the scatter about a smooth curve). The
laws are ranked by Akaike's criterion with the correction for
few points, and by the error of leaving out one point, which follows from the fit of all points:
``(e_i - r(v_i))/(1 - h_i)``, h the diagonal of the hat matrix.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.quantities import STANDARD_GRAVITY, quantities
from bouncing_ball.contacts.table import Table
from bouncing_ball.contacts.units import in_si
from bouncing_ball.errors import (
    ModelError,
    NoOrbitError,
    ParameterError,
    require,
    shortened,
    suggesting,
)
from bouncing_ball.measured.curves import CURVES, Curve, curve_named
from bouncing_ball.models.laws.law_of_impact import law_of_impact
from bouncing_ball.numerics.arrays import as_numbers
from bouncing_ball.periodic.one_impact.restitution_branch import rigid_speed

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
class Points:
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

    def take(self, which: np.ndarray) -> "Points":
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
    curve : Curve
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

    curve: Curve
    speed: float
    theta: float
    theta_error: float
    quantile: float
    restitution: float
    interval: tuple[float, float]
    rms: float
    chi_square: float
    p_value: float
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
        """The contact for ``assess_contact``, ``write_contact`` and the engines.

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
        v = self.speed if speed is None else speed
        weight = self.mass if mass is None else mass
        r = float(self.restitution_at(v))
        if not self.has_stiffness:
            return Contact(mass=weight, measured_restitution=r)
        return Contact(
            mass=weight,
            contact_time=float(self.duration_at(v)),
            measured_restitution=r,
            law=self.law,
        )

    def speed_on(self, table: Table, n: int = 1) -> float:
        """Impact speed in m/s of the n-T orbit on a table, 2πn/(1 + r(v)) g/Ω."""
        motion = table.motion
        unit = motion.gravity / motion.angular_frequency
        v = unit
        for _ in range(_SPEEDS):
            v = float(rigid_speed(n, self.restitution_at(v))) * unit
        return v

    def contact_on(self, table: Table, n: int = 1, mass: Any = None) -> Contact:
        """The contact at the impact speed of the n-T orbit on a table."""
        return self.contact(self.speed_on(table, n), mass)


@dataclass(frozen=True)
class ContactFit:
    """All laws fitted to measured impacts, the best one first.

    Parameters
    ----------
    points : Points
    laws : tuple of LawFit
    notes : tuple of str
        What the points do not determine, and how large neglected effects are.
    """

    points: Points
    laws: tuple[LawFit, ...]
    notes: tuple[str, ...]

    @property
    def best(self) -> LawFit:
        """The first law of the ranking that has a contact."""
        return next(each for each in self.laws if each.curve.kind is not None)

    def law(self, name: str) -> LawFit:
        """The fit of the law with this name.

        Raises
        ------
        NoOrbitError
            If it was not fitted.
        """
        for each in self.laws:
            if each.law == name:
                return each
        raise NoOrbitError(f"{name} was not fitted: {', '.join(each.law for each in self.laws)}")


def fit_law(curve: Curve, points: Points) -> LawFit:
    """One law fitted to the restitution coefficients.

    Examples
    --------
    >>> from bouncing_ball.measured.curves import curve_named
    >>> points = Points(np.array([1.0, 2.0]), np.array([0.9, 0.8]))
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
    quantile = float(_quantile(is_known, freedom))
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


def _quantile(is_known: bool, freedom: int) -> float:
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


def _left_out(plain: np.ndarray, slope: np.ndarray, points: Points) -> float:
    """Root mean square of the errors at points that are left out of the fit."""
    if points.size < 2:
        return np.nan
    weights = 1 / points.deviations**2
    hat = weights * slope**2 / np.sum(weights * slope**2)
    return float(np.sqrt(np.mean((plain / (1 - hat)) ** 2)))


@suggesting
def fit_contact(
    speeds: ArrayLike,
    restitutions: ArrayLike,
    durations: ArrayLike | None = None,
    *,
    uncertainties: ArrayLike | None = None,
    absolute_uncertainties: bool = True,
    duration_uncertainties: ArrayLike | None = None,
    mass: Any = None,
    laws: Sequence[str] | None = None,
) -> ContactFit:
    """The contact laws that are fitted to measured impacts, ranked.

    Parameters
    ----------
    speeds : array_like
        Impact speeds in m/s.
    restitutions : array_like
        Restitution coefficients in (0, 1], one for each speed.
    durations : float or array_like, optional
        Contact times in s, one for each speed, NaN where there is none. A single one belongs to the
        geometric mean of the speeds. Without contact times no stiffness is identified.
    uncertainties : array_like, optional
        Standard deviations of the restitution coefficients, or their covariance matrix. Without
        them they follow from the scatter about each law.
    absolute_uncertainties : bool
        False if only the ratios of the uncertainties are known; a common factor then follows from
        the scatter.
    duration_uncertainties : float or array_like, optional
        Standard deviations of the contact times in s.
    mass
        Mass of the ball, such as "20 g".
    laws : sequence of str, optional
        Names of the laws; by default all.

    Raises
    ------
    ModelError
        If a number is out of its range, or lists differ in length.

    Examples
    --------
    >>> fit = fit_contact([0.5, 1.0, 2.0, 4.0], [0.857, 0.842, 0.826, 0.809], 0.75e-3, mass="450 g")
    >>> fit.best.law, round(float(fit.best.restitution_at(6.0)), 2)
    ('kuwabara-kono', 0.79)
    >>> fit.best.contact(speed=1.0).law
    'kuwabara-kono'
    """
    points = checked(speeds, restitutions, uncertainties)
    points = replace(points, is_relative=not absolute_uncertainties)
    weight = None if mass is None else in_si("mass", mass, quantities(Contact)["mass"])
    times = _times(durations, duration_uncertainties, points)
    names = tuple(CURVES) if laws is None else _names(laws)
    found = [
        replace(_with_time(fit_law(curve_named(name), points), times), mass=weight)
        for name in names
    ]
    found.sort(key=lambda each: (np.nan_to_num(each.criterion, nan=np.inf), each.rms))
    return ContactFit(points, tuple(found), _notes(points, times))


def _names(laws: Any) -> tuple[str, ...]:
    """The names of laws.

    Raises
    ------
    ParameterError
        If they are no list of names.
    """
    if not isinstance(laws, list | tuple) or not all(isinstance(name, str) for name in laws):
        raise ParameterError("{laws} = {} is no list of names of laws", shortened(laws))
    return tuple(laws)


def checked(speeds: ArrayLike, restitutions: ArrayLike, uncertainties: ArrayLike | None) -> Points:
    """The points of a fit.

    Raises
    ------
    ModelError
        See :func:`fit_contact`.
    """
    v = np.atleast_1d(as_numbers(speeds, "impact speed", _POSITIVE))
    e = np.atleast_1d(as_numbers(restitutions, "restitution coefficient", "in (0, 1]"))
    if v.ndim != 1 or v.shape != e.shape or not v.size:
        raise ParameterError(
            f"{{speeds}} and {{restitutions}} are lists of one length, not {v.size} and {e.size}"
        )
    require(np.isfinite(v) & (v > 0), v, "impact speed", _POSITIVE)
    require((e > 0) & (e <= 1), e, "restitution coefficient", "in (0, 1]")
    if uncertainties is None:
        return Points(v, e)
    u = as_numbers(uncertainties, "uncertainty", _POSITIVE)
    if u.ndim < 2:
        u = np.broadcast_to(u, v.shape) if u.size in (1, v.size) else u
        require(np.isfinite(u) & (u > 0), u, "uncertainty", _POSITIVE)
        if u.shape == v.shape:
            u = np.diag(u**2)
    if u.shape != (v.size, v.size):
        raise ParameterError(f"{{uncertainties}} has not one number for each of {v.size} points")
    return Points(v, e, u)


@dataclass(frozen=True)
class _Times:
    """Contact times in s, the speeds that they belong to, and their uncertainties or None."""

    speeds: np.ndarray
    values: np.ndarray
    errors: np.ndarray | None


def _times(durations: Any, errors: Any, points: Points) -> _Times | None:
    if durations is None:
        return None
    t = as_numbers(durations, "contact time", _POSITIVE)
    v = points.speeds
    if t.ndim == 0:
        t = t.reshape(1)
        v = np.array([points.reference])
    if t.shape != v.shape:
        raise ParameterError(f"{{durations}} has not one number for each of {v.size} points")
    s = None
    if errors is not None:
        s = as_numbers(errors, "uncertainty of a contact time", _POSITIVE)
        if s.shape not in ((), t.shape):
            raise ParameterError(
                f"{{duration_uncertainties}} has not one number for each of {t.size}"
            )
        s = np.broadcast_to(s, t.shape)
    known = ~np.isnan(t)
    if not known.any():
        return None
    t = t[known]
    v = v[known]
    require(np.isfinite(t) & (t > 0), t, "contact time", _POSITIVE)
    if s is not None:
        s = s[known]
        require(np.isfinite(s) & (s > 0), s, "uncertainty of a contact time", _POSITIVE)
    return _Times(v, t, s)


def _with_time(fit: LawFit, times: _Times | None) -> LawFit:
    """The fit with the contact time at v₀: the mean of the times, each reduced to v₀."""
    if times is None or fit.curve.kind is None:
        return fit
    ratio = times.speeds / fit.speed
    shape = fit.curve.duration(fit.theta, ratio) / fit.curve.duration(fit.theta, 1.0)
    weights = (shape if times.errors is None else shape / times.errors) ** 2
    time = float(np.sum(weights * times.values / shape) / np.sum(weights))
    freedom = times.values.size - 1
    if times.errors is not None:
        error = 1 / np.sqrt(np.sum(weights))
    elif freedom:
        error = np.sqrt(np.sum((times.values - time * shape) ** 2) / freedom / np.sum(shape**2))
    else:
        error = np.nan
    away = _quantile(times.errors is not None, freedom) * error
    return replace(fit, contact_time=time, time_interval=(time - away, time + away))


def _notes(points: Points, times: _Times | None) -> tuple[str, ...]:
    notes = []
    if points.size == 1:
        notes += ["One point determines the parameter of each law; it tests no law."]
    elif np.ptp(points.speeds) == 0:
        notes += ["All speeds are equal, so that the laws cannot be told apart."]
    if times is None:
        notes += [
            "The stiffness is not identified: restitution coefficients determine the dissipation "
            "group of a law only. Give a contact time."
        ]
    else:
        share = STANDARD_GRAVITY * float(np.max(times.values)) / float(np.min(points.speeds))
        notes += [
            "Gravity during contact is neglected: it changes the speed by at most "
            f"{share:.2g} of the slowest impact speed."
        ]
    if not points.is_known and points.size > 1:
        notes += [
            "Without uncertainties, intervals follow from the scatter about each law, and a "
            "systematic error of the measurement counts as a deviation from each law."
        ]
    return tuple(notes)
