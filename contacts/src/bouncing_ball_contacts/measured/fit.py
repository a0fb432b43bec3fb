"""The parameters of all contact laws from measured restitution coefficients and contact times.

Each law is fitted to the restitution coefficients (:mod:`bouncing_ball_contacts.measured.law_fit`);
the time scale τ follows from the contact times. Contact times tell nothing of the loss, and
restitution coefficients nothing of the stiffness, so that the two fits are separate. The laws are
ranked by Akaike's criterion with the correction for few points.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import (
    NoOrbitError,
    ParameterError,
    require,
    shortened,
    suggesting,
)
from bouncing_ball_beyond.inherited.numerics.arrays import as_numbers
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.quantities import quantities
from bouncing_ball_contacts.contact.texts import lines
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY, in_si
from bouncing_ball_contacts.measured.curves import CURVES, curve_named
from bouncing_ball_contacts.measured.law_fit import LawFit, MeasuredPoints, fit_law, quantile_of

_POSITIVE = "a finite number > 0"
# Relative differences of r between laws with one r(v), by the ends of their fits.
_SAME = 1e-6
# The digits of a criterion and of an rms that do not depend on rounding: laws with one r(v) keep
# the order of their list.
_DIGITS = 9


@dataclass(frozen=True)
class ContactFit:
    """All laws fitted to measured impacts, the best one first.

    Parameters
    ----------
    points : MeasuredPoints
    laws : tuple of LawFit
    notes : tuple of str
        What the points do not determine, and how large neglected effects are.
    """

    points: MeasuredPoints
    laws: tuple[LawFit, ...]
    notes: tuple[str, ...]

    @property
    def best(self) -> LawFit:
        """The first law of the ranking that has a contact."""
        return next(each for each in self.laws if each.curve.kind is not None)

    @property
    def curves(self) -> tuple[tuple[str, ...], ...]:
        """The names of the laws that have the same r at all measured speeds, in the order of the
        first of them.

        Examples
        --------
        >>> fit_contact([0.5, 1.0, 2.0, 4.0], [0.857, 0.842, 0.826, 0.809]).curves[-1]
        ('hunt-crossley', 'hunt-crossley-linear')
        """
        v = self.points.speeds
        found: list[tuple[np.ndarray, list[str]]] = []
        for each in self.laws:
            r = each.restitution_at(v)
            names = next((few for same, few in found if np.allclose(r, same, rtol=_SAME)), None)
            if names is None:
                found.append((r, [each.law]))
            else:
                names.append(each.law)
        return tuple(tuple(names) for _, names in found)

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
    if not isinstance(absolute_uncertainties, bool | np.bool_):
        raise ParameterError(
            "{absolute_uncertainties} = {} is not True or False", shortened(absolute_uncertainties)
        )
    points = checked_points(speeds, restitutions, uncertainties)
    points = replace(points, is_relative=not absolute_uncertainties)
    weight = None if mass is None else in_si("mass", mass, quantities(Contact)["mass"])
    times = _times(durations, duration_uncertainties, points)
    names = CURVES if laws is None else laws
    is_list = laws is None or isinstance(laws, list | tuple)
    if not is_list or not all(isinstance(name, str) for name in names):
        raise ParameterError("{laws} = {} is no list of names of laws", shortened(laws))
    found = [
        replace(_with_time(fit_law(curve_named(name), points), times), mass=weight)
        for name in names
    ]
    found.sort(
        key=lambda each: (
            round(float(np.nan_to_num(each.criterion, nan=np.inf)), _DIGITS),
            round(each.rms, _DIGITS),
        )
    )
    share = None
    if times is not None:
        share = STANDARD_GRAVITY * float(np.max(times.values)) / float(np.min(points.speeds))
    notes = lines("measured_notes", points=points, share=share)
    return ContactFit(points, tuple(found), tuple(notes))


def checked_points(
    speeds: ArrayLike, restitutions: ArrayLike, uncertainties: ArrayLike | None
) -> MeasuredPoints:
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
        return MeasuredPoints(v, e)
    u = as_numbers(uncertainties, "uncertainty", _POSITIVE)
    if u.ndim < 2:
        u = np.broadcast_to(u, v.shape) if u.size in (1, v.size) else u
        require(np.isfinite(u) & (u > 0), u, "uncertainty", _POSITIVE)
        if u.shape == v.shape:
            u = np.diag(u**2)
    if u.shape != (v.size, v.size):
        raise ParameterError(f"{{uncertainties}} has not one number for each of {v.size} points")
    return MeasuredPoints(v, e, u)


@dataclass(frozen=True)
class _Times:
    """Contact times in s, the speeds that they belong to, and their uncertainties or None."""

    speeds: np.ndarray
    values: np.ndarray
    errors: np.ndarray | None


def _times(durations: Any, errors: Any, points: MeasuredPoints) -> _Times | None:
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
    away = quantile_of(times.errors is not None, freedom) * error
    return replace(fit, contact_time=time, time_interval=(time - away, time + away))
