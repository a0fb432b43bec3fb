"""Balls with a restitution coefficient, a spring and a damper, or a corrected restitution.

Times are in units of 1/Ω and lengths in units of g/Ω². These terms are used:

- *Gap* δ: height of the ball above the table, which is at ΛW(τ).
- *Impact*: starts at the time τ with the closing speed u = -δ′, and has the duration D. At its end
  the ball leaves at the gap δ with the relative speed w = δ′.
- *Contact*: impact with a duration. It ends at the first zero of the release function. This end is
  the *release*.
- T: duration in a time scale of the ball. It is ϖD for a spring and a damper, and the root time of
  :mod:`.root_time` for a force law.
- *Load*: acceleration g + ΛW″ that presses the ball onto the table.
- *Free impact*: impact without gravity on a table at rest, and therefore without a load.

All functions are analytic in all arguments and parameters. Derivatives by complex steps therefore
keep all digits.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from bouncing_ball_beyond.contacts import one_ball, oscillator
from bouncing_ball_beyond.contacts.one_ball import EPS, PATIENCE, REACH, SLOWEST
from bouncing_ball_beyond.contacts.resolution import H, check_continuous
from bouncing_ball_beyond.tables.table import SINE, Table, Values

FEW_BALLS = 40
"""Number of balls below which a scalar loop is faster than arrays.

One step on arrays takes as long as one step of this many balls in a loop.

At half: no effect. At twice: motions 30 % faster; 24 of 960 transients end elsewhere.
"""


ENDLESS = "its free impacts do not end, so it has no restitution coefficient"
"""What every question that needs a restitution coefficient answers for such a ball."""


class Impact(NamedTuple):
    """State at the end of an impact, as arrays of the same shape.

    Attributes
    ----------
    duration : array
        Duration D.
    gap : array
        δ at the end.
    speed : array
        δ′ at the end.
    release : array
        Release function. It is negative during a contact and zero at the end of the contact. It is
        zero for an instantaneous impact.
    """

    duration: np.ndarray
    gap: np.ndarray
    speed: np.ndarray
    release: np.ndarray


class Signature(NamedTuple):
    """Quantities of a free impact, which takes place without gravity on a table at rest.

    docs/impact-as-an-instant.md explains them.

    Attributes
    ----------
    restitution : array
        Restitution coefficient r.
    duration : array
        Duration D.
    centroid : array
        Time t_c from the start of the impact to the centroid of its force.
    loss : array
        σ: derivative of the impulse with respect to a constant load. The closing speed at the
        centroid is fixed.
    """

    restitution: np.ndarray
    duration: np.ndarray
    centroid: np.ndarray
    loss: np.ndarray


class Ball:
    """Base class of all balls."""

    has_duration: ClassVar[bool] = False
    """Whether contacts have a duration."""

    below_table: ClassVar[bool] = False
    """Whether contacts are replaced by instantaneous impacts below the level of the table."""

    @property
    def unknowns(self) -> int:
        """Number q of unknowns of an impact: τ, u and, if it has a duration, T."""
        return 3 if self.has_duration else 2

    @property
    def parameters(self) -> dict[str, Values]:
        """Names and values of the parameters that can be varied."""
        return {
            name: value
            for name, value in vars(self).items()
            if not (value is None or callable(value) or isinstance(value, str))
        }

    def at(self, **values: Values) -> Any:
        """Return the ball with other values of parameters.

        The values may be numbers or arrays, real or complex. They are not checked. Raises
        ValueError for an unknown name.
        """
        unknown = values.keys() - vars(self).keys()
        if unknown:
            raise ValueError(
                f"{', '.join(sorted(unknown))}: no parameter of {type(self).__name__};"
                f" its parameters: {', '.join(self.parameters) or 'none'}"
            )
        new = object.__new__(type(self))
        vars(new).update(vars(self), **values)
        return new

    def rows(self, which: Any) -> Any:
        """Return the ball with x[which] instead of x, for each parameter x that is an array."""
        arrays = {name: x[which] for name, x in self.parameters.items() if np.ndim(x)}
        return self.at(**arrays) if arrays else self

    @property
    def kappa(self) -> Values:
        """κ of the release condition δ + κδ′ = 0. It is 0 if contacts end at δ = 0."""
        return 0.0

    @property
    def frequency_powers(self) -> dict[str, Any]:
        """Exponents by name: a parameter of a given contact is proportional to Ω^exponent."""
        return {}

    def start(self, u: Values) -> Values:
        """Gap at the start of an impact.

        It is 0 after a flight (u > 0), and κu if a contact resumes (u < 0).
        """
        kappa = self.kappa
        if isinstance(kappa, float) and kappa == 0:
            return np.zeros(np.shape(u))
        return np.where(np.real(u) < 0, kappa * u, 0.0)

    def free(self, u: Values) -> Values:
        """T of a free impact; 0 for impacts without a duration."""
        return 0.0 * np.asarray(u)

    def loop_parameters(self, table: Table) -> tuple | None:
        """Arguments (r, ϖ, ζ) of :func:`.one_ball.impacts`; None if loops cannot be used."""
        return None

    @property
    def has_two_ends(self) -> bool:
        """Whether contacts end at one of two events, whichever comes first: see :class:`.Force`."""
        return False

    def first_release(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        periods: Values = None,
        table: Table = SINE,
    ) -> Values:
        """T of the first release; 0 for instantaneous impacts.

        T may be NaN for contacts that last longer than ``periods`` periods of the table.
        """
        return 0.0 * (tau + u + amplitude)

    def contact(
        self,
        tau: Values,
        u: Values,
        T: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        table: Table = SINE,
    ) -> Impact:
        """State of an impact at T. The impact starts at the time τ with the closing speed u."""
        raise NotImplementedError

    def contact_after(
        self, tau: Values, u: Values, time: Values, amplitude: Values, table: Table = SINE
    ) -> tuple[Values, Values]:
        """δ and δ′ at the given time after the start of a contact.

        Both are zero for instantaneous impacts, because the ball then rests on the table.
        """
        nothing = 0.0 * (tau + u + time + amplitude)
        return nothing, nothing

    def end_slopes(
        self, tau: Values, u: Values, T: Values, amplitude: Values, table: Table = SINE
    ) -> NDArray:
        """Derivatives with respect to τ and u of D, δ and δ′ at the end of an impact.

        Returns an array of the shape (3, 2, *tau.shape).
        """
        if self.has_duration:
            return slopes_at_release(self, tau, u, T, amplitude, table)
        steps = 1j * H * np.eye(2).reshape(2, 2, *np.ones(np.ndim(tau), int))
        impact = self.contact(tau + steps[0], u + steps[1], T, amplitude, table=table)
        return np.array([impact.duration.imag, impact.gap.imag, impact.speed.imag]) / H

    def release_slopes(
        self,
        tau: Values,
        u: Values,
        T: Values,
        places: NDArray,
        amplitude: Values,
        table: Table = SINE,
    ) -> NDArray | None:
        """Approximate derivatives of the release function at the times T * places.

        ``places`` are fractions of T. Returns an array of the shape (..., places), or None if the
        derivatives take longer than the contacts up to all these times.
        """
        return None

    def signature(self, u: Values) -> Signature:
        """Signature of free impacts with the closing speed u."""
        raise NotImplementedError

    def first_impact(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        periods: Values = None,
        table: Table = SINE,
    ) -> tuple:
        """T of the first release, as `first_release`, and the state of the impact there."""
        T = self.first_release(tau, u, amplitude, gravity, periods, table)
        return T, self.contact(tau, u, T, amplitude, gravity, table)

    def leaves(self, tau: Values, u: Values, amplitude: Values, table: Table = SINE) -> tuple:
        """T, D, δ and δ′ at the first release. D is infinite if the ball stays on the table."""
        T, (duration, gap, speed, _) = self.first_impact(tau, u, amplitude, table=table)
        if np.any(self.kappa):
            # The condition δ + κδ′ = 0 of the release gives δ without rounding errors.
            gap = -self.kappa * speed
        return T, np.where(np.isnan(T), np.inf, duration), gap, speed


def brief(value: Values) -> str:
    """Text of a wrong argument in an error message: its repr, or its type if the repr is long."""
    text = repr(value)
    return f"{type(value).__name__}(…)" if "\n" in text or len(text) > 60 else text


def check_ends(name: str, ball: Ball, u: Values) -> None:
    """Raise ValueError if no free impact of a ball with the closing speeds u ends."""
    if not np.isfinite(ball.signature(u).restitution).any():
        raise ValueError(f"{name} = {brief(ball)}: {ENDLESS}")


def check_ball(ball: Any) -> None:
    """Raise ValueError unless ``ball`` is a `Ball`."""
    if not isinstance(ball, Ball):
        raise ValueError(f"ball = {brief(ball)}: must be a ball, such as Rigid(0.7)")


def check_one_ball(ball: Any) -> None:
    """Raise ValueError unless ``ball`` is a `Ball` whose parameters are numbers."""
    check_ball(ball)
    if any(map(np.ndim, ball.parameters.values())):
        raise ValueError(f"ball = {ball!r}: must be one ball, with numbers as parameters")


def whole_number(name: str, value: Values, least: int = 1) -> int:
    """Convert a whole number to int. The number may be an int or a float.

    Raises ValueError if it is not a whole number, or if it is less than ``least``.
    """
    number = np.asarray(value)
    if number.ndim or number.dtype.kind not in "iuf" or number % 1 or number < least:
        raise ValueError(f"{name} = {brief(value)}: must be a whole number from {least}")
    return int(number)


def check_whole_numbers(name: str, value: Values) -> None:
    """Raise ValueError unless all entries of ``value`` are whole numbers from 1 to 1000."""
    numbers = np.ravel(checked(name, value, 1, 1000, low_allowed=True))
    for number in numbers[numbers % 1 != 0]:
        raise ValueError(f"{name} = {number:g}: must be a whole number")


def broadcast_named(named: Any) -> tuple[np.ndarray, ...]:
    """Broadcast the arrays of pairs (name, array).

    Raises ValueError if the shapes do not broadcast. The message has the names and shapes of all
    arrays that are not numbers.
    """
    named = list(named)
    try:
        return np.broadcast_arrays(*(x for _, x in named))
    except ValueError:
        shapes = ", ".join(f"{name} has {np.shape(x)}" for name, x in named if np.ndim(x))
        raise ValueError(f"arrays must have shapes that broadcast: {shapes}") from None


def checked(name: str, value: Values, low: float, high: float, *, low_allowed: bool) -> Values:
    """Return ``value`` as a float or an array of floats.

    Raises ValueError unless all entries are finite and from ``low`` to ``high``. The bound ``low``
    itself is allowed only if ``low_allowed`` is true.
    """
    least = f"[{low:g}" if low_allowed and low > -np.inf else f"({low:g}"
    allowed = f"{least}, {high:g}{']' if high < np.inf else ')'}".replace("inf", "∞")
    try:
        values = np.array(value, float)
        is_number = values.size and np.asarray(value).dtype.kind in "iuf"
    except (TypeError, ValueError):
        is_number = False
    if not is_number:
        raise ValueError(f"{name} = {brief(value)}: must be a number or an array in {allowed}")
    above = values >= low if low_allowed else values > low
    good = np.isfinite(values) & above & (values <= high)
    if not good.all():
        raise ValueError(f"{name} = {values[~good].flat[0]:g}: must be in {allowed}")
    return values if values.ndim else float(values)


def one_number(name: str, value: Any, *, low_allowed: bool = False) -> float:
    """Return a number as a float. Raises ValueError unless it is one finite number above 0.

    The number 0 is allowed if ``low_allowed`` is true.
    """
    number = checked(name, value, 0, np.inf, low_allowed=low_allowed)
    if np.ndim(number):
        raise ValueError(f"{name} = {brief(value)}: must be one number")
    return number


def check_analytic(what: str, function: Callable, at: NDArray) -> NDArray:
    """Return the values of a function at the points ``at``.

    Raises ValueError unless complex steps give the derivative of the function.
    """
    reach = np.ptp(at)
    step = 1e-6 * reach
    try:
        values = function(at) + 0 * at
        along = np.imag(function(at + 1j * H)) / H
        across = (function(at + step) - function(at - step)) / (2 * step)
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise ValueError(
            f"{what} must accept arrays, also complex ones, which tables and splines do not: give"
            f" a polynomial, or restitution_of(pairs) ({reason})"
        ) from None
    # The difference has a rounding error of eps/step, and an error of step² times the third
    # derivative.
    size = np.abs(along) + np.abs(across)
    if np.any(np.abs(along - across) > 1e-4 * size.max() + 1e-9 * np.abs(values).max() / reach):
        raise ValueError(
            f"{what} must be analytic: write it without abs, real, sign and the like, and instead"
            " of a table or spline as a polynomial, or as restitution_of(pairs)"
        )
    return values


RESOLVED = 0.01, 1e4
"""Closing speeds between which an r(u) must not jump. 1000-T orbits close below 2000π."""


@dataclass(frozen=True)
class Rigid(Ball):
    """Ball with instantaneous impacts. Its restitution coefficient r gives w = r u (Eq. 5).

    Parameters
    ----------
    restitution : array_like or callable
        r in [0, 1], or an analytic function r(u) of the closing speed, such as
        ``restitution_of(pairs)``. It must not jump; replace a jump by a smooth step.

    Examples
    --------
    >>> float(Rigid(0.5).contact(0.0, 2.0, None, 1.0).speed)
    1.0
    """

    restitution: float | np.ndarray | Callable

    def __post_init__(self) -> None:
        if callable(self.restitution):
            # Orbits with one impact in one period close at π to 2π.
            samples = np.array([0.5, 1.0, 2.0, np.pi, 2 * np.pi])
            r = check_analytic("restitution: r(u)", self.restitution, samples)
            checked("restitution at u = 0.5, 1, 2, π or 2π", r, 0, 1, low_allowed=True)
            check_continuous("restitution: r(u)", self.restitution, *RESOLVED)
        else:
            r = checked("restitution", self.restitution, 0, 1, low_allowed=True)
            object.__setattr__(self, "restitution", r)

    @property
    def frequency_powers(self) -> dict[str, Any]:
        """Empty, because a constant r does not depend on Ω.

        Raises ValueError for r(u), because the unit g/Ω of u depends on Ω.
        """
        if callable(self.restitution):
            raise ValueError(
                "restitution: u in r(u) is in units of g/Ω, which change with the frequency;"
                " give a number, or a contact law with units"
            )
        return {}

    def loop_parameters(self, table: Table) -> tuple | None:
        """Return (r, 0, 0) if r is a number and the table is a sine; otherwise None."""
        is_looped = table.is_sine and not callable(self.restitution)
        return (self.restitution, 0.0, 0.0) if is_looped else None

    def _restitution(self, u: Values) -> Values:
        return self.restitution(u) if callable(self.restitution) else self.restitution

    def contact(
        self,
        tau: Values,
        u: Values,
        T: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        table: Table = SINE,
    ) -> Impact:
        """Impact at the time τ with the closing speed u."""
        nothing = 0.0 * (tau + u + amplitude)
        return Impact(nothing, nothing, self._restitution(u) * u + nothing, nothing)

    def signature(self, u: Values) -> Signature:
        """Signature with r and with D = t_c = σ = 0."""
        nothing = 0.0 * u
        return Signature(self._restitution(u) + nothing, nothing, nothing, nothing)


@dataclass(frozen=True)
class RestitutionFit:
    """The fit r(v) = 1/(1 + C v^q) to measured pairs, a function of v; see `restitution_of`.

    Attributes
    ----------
    logarithm : float
        ln C.
    exponent : float
        q.
    residual : float
        Largest modulus of the difference between a measured r and the fit.
    at : float
        Speed of the pair with this difference.
    """

    logarithm: float
    exponent: float
    residual: float = 0.0
    at: float = np.nan

    def __call__(self, v: Values) -> Values:
        return 1 / (1 + np.exp(self.logarithm + self.exponent * np.log(v)))


def restitution_of(pairs: Values) -> RestitutionFit:
    """Fit r(v) = 1/(1 + C v^q) to measured pairs of a closing speed v and r by least squares.

    This r is in (0, 1) at every speed, and is a power of the speed where it is small. Other shapes
    are approximated over the measured speeds: ``residual`` of the result says how far a pair is
    from the fit. A fit is used, and no interpolation, because measured pairs scatter: the slope of
    an interpolation is that of the scatter, and the slope decides on stability.

    Parameters
    ----------
    pairs : array_like, shape (impacts, 2)
        Closing speeds > 0 in any unit, which is then the unit of v, and r in (0, 1].

    Returns
    -------
    RestitutionFit
        Analytic function r(v), for ``Rigid``.

    Raises
    ------
    ValueError
        If the pairs are not of this kind, or if all speeds are equal.

    Examples
    --------
    >>> r = restitution_of([(1.0, 0.90), (2.0, 0.86), (4.0, 0.81)])
    >>> r(np.array([1.0, 3.0])).round(2).tolist()
    [0.9, 0.83]
    >>> round(r.residual, 4), r.at
    (0.0006, 2.0)
    """
    try:
        speeds, measured = np.asarray(pairs, float).T
    except (TypeError, ValueError):
        raise ValueError(
            "restitution: must be a number, or pairs of a speed and r, such as"
            " [(1.0, 0.90), (2.0, 0.86)]"
        ) from None
    if not np.all((speeds > 0) & (speeds < np.inf) & (measured > 0) & (measured <= 1)):
        raise ValueError("restitution: pairs (speed, r) must have speeds > 0 and r in (0, 1]")
    if np.ptp(np.log(speeds)) < 1e-6:
        raise ValueError("restitution: all pairs have one speed: give their mean r as a number")
    start = np.log(1 / min(measured.mean(), 0.999) - 1)

    def misses(given: NDArray) -> NDArray:
        return RestitutionFit(given[0], given[1])(speeds) - measured

    fitted = least_squares(misses, [start, 0.0]).x
    residuals = np.abs(misses(fitted))
    worst = float(residuals.max()), float(speeds[residuals.argmax()])
    return RestitutionFit(float(fitted[0]), float(fitted[1]), *worst)


def damping_of(restitution: Values, release: str = "displacement") -> Values:
    """Damping ratio ζ < 1 of the contact whose free impacts have the restitution coefficient r.

    - Release "displacement": ζ = -ln r/√(π² + ln² r) (Eq. 16).
    - Release "force": ζ = cos θ, where θ is the root of θ cot θ = -(ln r)/2. It is NaN for
      r ≤ e⁻², because only contacts with ζ ≥ 1 have these r.
    """
    loss = -np.log(restitution)
    if release == "displacement":
        return loss / np.sqrt(np.pi**2 + loss * loss)
    # The duration T = 2θ/sin θ of the guess has an error below 0.1 % for r > 0.14. Each step of
    # Newton's method doubles the number of digits.
    theta = np.arccos(loss / (np.pi - 2 / np.pi * loss + 0.033 * loss * loss))
    for _ in range(6):
        sine = np.sin(theta)
        cosine = np.cos(theta)
        surplus = theta * cosine / sine - loss / 2
        theta = theta - surplus * sine * sine / (cosine * sine - theta)
    # For r = 1 this is exactly 0, and cos θ is not.
    return loss * np.sin(theta) / (2 * theta)


def _arc_over_root(zeta: Values) -> Values:
    """Return 2 arccos ζ/√(1 - ζ²), in a form that is analytic at ζ = 1.

    The form is 4A/(1 + ζ) with A = arctan(√t)/√t and t = (1 - ζ)/(1 + ζ).
    """
    t = (1 - zeta) / (1 + zeta)
    near = np.abs(t) < 0.1
    over = np.real(t) < 0
    root = np.sqrt(np.where(near, 1.0, np.where(over, -t, t)))
    arc = np.where(over, np.arctanh(np.where(over & ~near, root, 0.0)), np.arctan(root)) / root
    series = sum((-np.where(near, t, 0.0)) ** k / (2 * k + 1) for k in range(17))
    return 4 * np.where(near, series, arc) / (1 + zeta)


@dataclass(frozen=True)
class SpringDamper(Ball):
    """Ball with the paper's spring and damper: δ″ + 2ζϖδ′ + ϖ²δ = -g + Λ sin τ (Eq. 11).

    Parameters
    ----------
    frequency_ratio : array_like
        ϖ > 0, large for a stiff contact. T is ϖD.
    restitution : array_like, optional
        r in (0, 1] of free impacts with this release (`damping_of`). With the release "force", r is
        above e⁻² = 0.1353: give ``damping_ratio`` ≥ 1 for a smaller r. Under a load, the
        restitution of the contact differs from r.
    damping_ratio : array_like, optional
        ζ ≥ 0. Give either ``restitution`` or ``damping_ratio``. If ζ ≥ 1 and the release is
        "displacement", free impacts do not end, and `free` and `signature` are NaN.
    release : {"displacement", "force"}
        If "displacement", contacts end where δ = 0 (Eq. 23). If "force", contacts end where the
        force vanishes: δ + κδ′ = 0 with κ = 2ζ/ϖ. The ball is then below the level of the table. If
        δ + κδ′ vanishes again before the ball reaches this level, the contact resumes. It resumes
        as an impact that starts at the gap κu with u = -δ′ < 0.

    Examples
    --------
    >>> ball = SpringDamper(10.0, restitution=0.85)
    >>> round(float(ball.zeta), 5)
    0.05166
    >>> round(float(ball.free(1.0)), 5)
    3.14579
    """

    frequency_ratio: float | np.ndarray
    restitution: float | np.ndarray | None = None
    damping_ratio: float | np.ndarray | None = None
    release: str = "displacement"

    has_duration: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if (self.restitution is None) == (self.damping_ratio is None):
            raise ValueError("restitution, damping_ratio: exactly one of them must be given")
        if self.release not in ("displacement", "force"):
            raise ValueError(f"release = {self.release!r}: must be 'displacement' or 'force'")
        ranges = {
            "frequency_ratio": (0, np.inf),
            "damping_ratio": (0, np.inf),
            "restitution": (np.exp(-2) if self.release == "force" else 0, 1),
        }
        given = "restitution" if self.damping_ratio is None else "damping_ratio"
        for name in ("frequency_ratio", given):
            value = getattr(self, name)
            value = checked(name, value, *ranges[name], low_allowed=name == "damping_ratio")
            object.__setattr__(self, name, value)
        broadcast_named(self.parameters.items())

    def at(self, **values: Values) -> Any:
        """As `Ball.at`. A damping ratio replaces the restitution, and vice versa."""
        if "damping_ratio" in values:
            values = {"restitution": None} | values
        elif "restitution" in values:
            values = {"damping_ratio": None} | values
        return super().at(**values)

    @property
    def zeta(self) -> Values:
        """Damping ratio ζ, as given or computed from r."""
        if self.damping_ratio is not None:
            return self.damping_ratio
        return damping_of(self.restitution, self.release)

    @property
    def kappa(self) -> Values:
        """κ of the release condition δ + κδ′ = 0: 2ζ/ϖ for the release "force", otherwise 0."""
        return 2 * self.zeta / self.frequency_ratio if self.release == "force" else 0.0

    @property
    def frequency_powers(self) -> dict[str, Any]:
        """Exponent -1 of ϖ, because ϖ is proportional to 1/Ω."""
        return {"frequency_ratio": -1.0}

    def contact(
        self,
        tau: Values,
        u: Values,
        T: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        table: Table = SINE,
    ) -> Impact:
        """State of the contact at the time τ + T/ϖ. The release function is ϖ(δ + κδ′)."""
        ratio = self.frequency_ratio
        duration = T / ratio
        waves = table.waves(tau, amplitude)
        given = self.start(u), u, table, waves, gravity, ratio, self.zeta
        gap, speed = oscillator.motion(duration, *given)
        return Impact(duration + 0 * gap, gap, speed, ratio * (gap + self.kappa * speed))

    def contact_after(
        self, tau: Values, u: Values, time: Values, amplitude: Values, table: Table = SINE
    ) -> tuple[Values, Values]:
        """δ and δ′ at the given time after the start of a contact."""
        return self.contact(tau, u, time * self.frequency_ratio, amplitude, table=table)[1:3]

    def free(self, u: Values) -> Values:
        """T of a free impact: 2 arccos ζ/√(1 - ζ²) for the release "force", else π/√(1 - ζ²)."""
        zeta = self.zeta
        if self.release == "force":
            return _arc_over_root(zeta) + 0 * u
        square = np.where(np.real(zeta) < 1, (1 - zeta) * (1 + zeta), np.nan)
        return np.pi / np.sqrt(square) + 0 * u

    @np.errstate(invalid="ignore")  # NaN if free impacts do not end
    def signature(self, u: Values) -> Signature:
        """r = e^{-ζT}, D = T/ϖ, t_c = r (D + κ)/(1 + r), σ = (1 - r)(D + κ) - 2ζ (1 + r)/ϖ."""
        T = self.free(u)
        r = np.exp(-self.zeta * T)
        duration = T / self.frequency_ratio
        through = duration + self.kappa
        loss = (1 - r) * through - 2 * self.zeta * (1 + r) / self.frequency_ratio
        return Signature(r, duration, r * through / (1 + r), loss)

    def has_closed_form(self, table: Table = SINE) -> bool:
        """Whether ζ is at most :data:`.oscillator.UNDERDAMPED` and ϖ is not near a resonance."""
        near = oscillator.resonates(self.frequency_ratio, self.zeta, table.orders)
        return bool(np.all((self.zeta <= oscillator.UNDERDAMPED) & ~near))

    def loop_parameters(self, table: Table) -> tuple | None:
        """Return (0, ϖ, ζ) if there is a closed form and the table is a sine; otherwise None."""
        if table.is_sine and self.has_closed_form():
            return 0.0, self.frequency_ratio, self.zeta
        return None

    def leaves(self, tau: Values, u: Values, amplitude: Values, table: Table = SINE) -> tuple:
        """T, D, δ and δ′ at the first release. D is infinite if the ball stays on the table."""
        duration, speed = releases(self, tau, u, amplitude, table)
        T = np.where(duration < np.inf, duration * self.frequency_ratio, np.nan)
        return T, duration, -self.kappa * speed, speed

    def at_ratio(self, restitution: Values, centroid: Values) -> Callable:
        """Return a function that maps ϖ to the ball."""
        return lambda ratio: self.at(frequency_ratio=ratio)

    def first_release(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        periods: Values = None,
        table: Table = SINE,
    ) -> Values:
        """T of the first release; NaN if the contact lasts for ever, or longer than `PATIENCE`.

        Examples
        --------
        >>> ball = SpringDamper(10.0, restitution=0.5)
        >>> ball.first_release(0.0, np.array([1.0, 1e-3]), amplitude=0.9).round(3)
        array([3.478,   nan])
        """
        parameters = self.parameters
        every = np.broadcast_arrays(tau, u, amplitude, *parameters.values())
        tau, u, amplitude, *others = (values.ravel() for values in every)
        ball = self.at(**dict(zip(parameters, others, strict=True)))
        return ball.leaves(tau, u, amplitude, table)[0].reshape(every[0].shape)


def slopes_at_release(
    ball: Ball, tau: Values, u: Values, T: Values, amplitude: Values, table: Table
) -> NDArray:
    """Compute the derivatives of :meth:`Ball.end_slopes` for a contact by complex steps."""
    steps = 1j * H * np.eye(3).reshape(3, 3, *np.ones(np.ndim(tau), int))
    impact = ball.contact(tau + steps[0], u + steps[1], T + steps[2], amplitude, table=table)
    slopes = np.array([impact.duration.imag, impact.gap.imag, impact.speed.imag]) / H
    # Eliminate T by implicit differentiation: the release function vanishes at the release.
    release = impact.release.imag / H
    return slopes[:, :2] - slopes[:, 2:] * (release[:2] / release[2])


def root_of_parabola(f: Values, slope: Values, bend: Values) -> Values:
    """:func:`.one_ball.root_of_parabola` for arrays. If there is no root, NaN or infinity."""
    root = np.sqrt(slope * slope + 2 * bend * f)
    falls = slope < 0
    # This quotient avoids a difference of nearly equal numbers.
    part = np.where(falls, 2 * f, root + slope)
    return part / np.where(falls, root - slope, np.maximum(bend, 0.0))


def safe_steps(
    t: Values, f: Values, slope: Values, second: Values, bend: Values, jerk: Values
) -> tuple:
    """:func:`.one_ball.safe_step` for arrays."""
    step = root_of_parabola(f, slope, bend)
    while True:
        reach = REACH * step
        closer = root_of_parabola(f, slope, np.minimum(bend, jerk / 3 * reach - second))
        short = (closer > reach) | (np.isnan(closer) & (slope >= 0))
        short &= reach < np.inf
        if not short.any():
            break
        step = np.where(short, reach, step)
    step = np.maximum(step, np.fmin(reach, closer))
    near = jerk * step * step * step <= -EPS * slope * t
    if near.any():
        step[near] = root_of_parabola(f[near], slope[near], -second[near])
    return step, near | (step <= EPS * t)


@np.errstate(all="ignore")  # steps may be infinite, and motions may decay to 0
def releases(ball: Any, phase: Values, u: Values, amplitude: Values, table: Table = SINE) -> tuple:
    """Durations of contacts with a spring and a damper, and δ′ at the releases.

    The duration is infinite if the ball stays on the table. This is :func:`.one_ball.release` for
    arrays of the shape (n,), and for all ϖ, ζ and tables.
    """
    u = np.where(u == 0, SLOWEST, u)
    waves = table.waves(phase, amplitude)
    given = [ball.start(u), u, *waves]
    closed = ball.has_closed_form(table)

    def resonance(ball: Any) -> Values:
        of_ball = ball.frequency_ratio, ball.zeta
        return 0.0 if closed else 1.0 * oscillator.resonates(*of_ball, table.orders)

    of_ball = ball.frequency_ratio, ball.zeta, ball.kappa
    forced = oscillator.forcing(table, waves, *of_ball, resonance(ball))
    rows = np.array(np.broadcast_arrays(0 * u, *given, *forced))
    of_time = oscillator.closed_motion if closed else oscillator.doubled_motion
    fewest = FEW_BALLS if closed and table.is_sine else 1
    given[:] = np.broadcast_arrays(*given, amplitude, ball.frequency_ratio, ball.zeta, ball.kappa)
    duration = np.full(u.shape, np.inf)
    speed = np.full(u.shape, np.nan)
    todo = np.arange(u.size)
    while todo.size >= fewest:
        s, gap, u, *waves = rows[:-4]
        ratio = ball.frequency_ratio
        zeta = ball.zeta
        kappa = ball.kappa
        resonant = resonance(ball)
        motion = of_time(s, gap, u, table, waves, 1.0, ratio, zeta)
        f, slope, second, third, bend, jerk, stays = oscillator.bounds(
            motion, table, rows[-4:], ratio, zeta, kappa, resonant
        )
        above = np.maximum(f, 0.0)
        step, last = safe_steps(s, above, slope, -second - kappa * third, bend, jerk)
        if not closed:
            step = np.fmin(step, np.divide(2, ratio * resonant))
        rows[0] = s + step
        done = last | stays | ~(rows[0] < PATIENCE)
        if done.any():
            released = todo[last]
            duration[released] = rows[0, last]
            speed[released] = (motion.speed + step * (second + step * third / 2))[last]
            (going,) = (~done).nonzero()
            todo = todo[going]
            rows = rows.take(going, axis=1)
            ball = ball.rows(going)
    for i in todo:
        duration[i], speed[i] = one_ball.release(*(values[i] for values in given))
    return duration, speed


@dataclass(frozen=True)
class Corrected(Ball):
    """Corrected restitution model. Instantaneous impacts replace the contacts of the ball `of`.

    An impact with the closing speed v takes place at the gap -v t_c(v). The ball leaves at the same
    gap with the relative speed w = r(v) v + σ(v) a, where a = g + ΛW″ is the load
    (docs/impact-as-an-instant.md).

    Examples
    --------
    >>> ball = Corrected(SpringDamper(2.0, damping_ratio=0.0))
    >>> float(ball.start(1.0)) == -np.pi / 4
    True
    """

    of: Ball

    below_table: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_ball(self.of)
        check_ends("of", self.of, 1.5 * np.pi)

    @property
    def parameters(self) -> dict[str, Values]:
        """Parameters of the ball `of`."""
        return self.of.parameters

    def at(self, **values: Values) -> Any:
        """Return the corrected model of `of` with other values of its parameters."""
        new = object.__new__(type(self))
        vars(new)["of"] = self.of.at(**values)
        return new

    @property
    def frequency_powers(self) -> dict[str, Any]:
        """Exponents as in `Ball.frequency_powers`, for the ball `of`."""
        return self.of.frequency_powers

    def start(self, u: Values) -> Values:
        """Gap -u t_c(u) at which the impact takes place."""
        return -u * self.of.signature(u).centroid

    def contact(
        self,
        tau: Values,
        u: Values,
        T: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        table: Table = SINE,
    ) -> Impact:
        """Impact at the time τ with the closing speed u."""
        r, _, centroid, loss = self.of.signature(u)
        speed = r * u + loss * (gravity + amplitude * table(tau, 2))
        return Impact(0 * speed, 0 * speed - u * centroid, speed, 0 * speed)

    def signature(self, u: Values) -> Signature:
        """Signature of the ball `of`."""
        return self.of.signature(u)
