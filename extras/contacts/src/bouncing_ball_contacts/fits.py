"""From a recording to r over the speed, with its interval, and to the contact laws that it allows.

The impacts of a recording have restitution coefficients rᵢ at speeds vᵢ. Their logarithms are::

    ln rᵢ = β + c (e^(q xᵢ) - 1)/q + eᵢ,   xᵢ = ln(vᵢ/v₀)
    cov e = τ² M Mᵀ + s² I,                M Mᵀ in units of the median of its diagonal

The exponent q is between -1/2 and 5/4: 0 for an r that is a power of the speed, about 1/5 for a law
of Kuwabara and Kono, 1 for one of Hunt and Crossley, more for r = 1 - b v, and negative for an r
that changes at low speeds only. The slope c has a normal prior of the width 0.25, because measured
slopes lie between 0 and about -0.3; β has none. M says how readings enter: an error of a time
enters the flights on both of its sides. τ is the size of errors of readings, and s that of the
scatter between impacts. Both have log-normal priors. That of the errors is about what instruments
have, 1 ms, 2 mm or 0.02 m/s, with a factor of 7 either way; beside it readings have an error of
rounding, 0.29 frames or units of the last digit (`rounding_of`). If the errors of the readings are
given, τ is known. The prior of scatter is about 0.011, with a factor of 4.5 either way: the
published experiments have 0.0004 to 0.04.

The covariances of all ratios ρ = s/τ have the same eigenvectors, those of M Mᵀ. In their basis each
covariance is a row of variances, and every question below is one of weighted sums of squares.

Few impacts do not tell errors of readings, which hardly change r in the middle, from scatter, which
does. So there are two intervals of 95 %. If impacts do not scatter, it is that of the posterior of
β for s = 0. If they do, a posterior would hold r too often where scatter is hidden below the
errors, and too seldom where it is large. In its place, τ and q have their posterior, but for each
of these s has its confidence distribution: the squares of the deviations, over their variances and
weighted by the share of scatter in these, have a sum whose distribution is known for each s, and
the probability of a scatter below s is that of a larger sum than the one at s (`_below`). So s = 0
has a probability of its own. (H. K. Iyer, C. M. Wang, T. Mathew, J. Am. Stat. Assoc. 99 (2004)
1060, have such intervals for laboratories that measure the same.) Above its middle the prior of
scatter multiplies this distribution. Two impacts leave no deviation, and have the posterior for all
s > 0. The interval without scatter is left out if both are alike or if a test of s = 0 at 5 %
rejects it (`without_scatter`).

A law is judged by how much worse it fits than the nearest smooth curve, which is one of those above
or a parabola in ln v, for each ρ: with m impacts more than the three parameters of the curve, and
sums of squares Q of the law and P of the curve, its probability is (P/Q)^(m/2), that of the F
distribution with 2 and m degrees of freedom. The largest one counts of those ρ that are at least
1/20 as likely as the likeliest one. If the errors are known it is e^(-(Q - P)/2τ²), that of the χ²
distribution, averaged over ρ. Scatter alone, which the curve has as well, therefore rejects no law.
Without given errors a systematic error of the measurement does not show in the scatter: a law is
then not called incompatible, but said to deviate.
"""

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import integrate, interpolate, linalg, optimize, special

from bouncing_ball_contacts.designs import Bounce, Design, Page, Quantity, aligned, design
from bouncing_ball_contacts.engines import Engine
from bouncing_ball_contacts.flights import drag_of, heights_of, impact_of, speeds_of
from bouncing_ball_contacts.recordings import Recording, read, rounding_of
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, positive, show, span

REJECTED = 0.005
"""The probability below which a law is rejected."""
ACCEPTED = 0.05
"""The probability above which a law is compatible, and an absence of scatter possible."""

# Of each kind of recording: the unit of a reading, its usual standard deviation, and the powers of
# the readings with which the speeds before and after an impact go. Those of series are alike; of a
# coefficient the speed is taken as exact.
_KINDS = {
    "flights": ("s", 1e-3, (1.0, 1.0)),
    "heights": ("m", 2e-3, (0.5, 0.5)),
    "drops": ("m", 2e-3, (0.5, 0.5)),
    "speeds": ("m/s", 2e-2, (1.0, 1.0)),
    "track": ("m/s", 2e-2, (1.0, 1.0)),
    "coefficients": ("", 1.1e-2, (0.0, 1.0)),
}
# ρ C A/(2 m) of a tennis ball in 1/m.
_TENNIS = 0.017
_WITH_DRAG = ("flights", "heights", "drops", "track")
# The priors: the width of the logarithm of errors, the middle of scatter and the width of its
# logarithm, and the width of c.
_WIDTH_OF_ERRORS = 2.0
_SCATTER = 0.011
_WIDTH_OF_SCATTER = 1.5
_SLOPE = 0.25
# 1e-6 stands for 0, which would be divided by.
_EXPONENTS = np.array([-0.5, 1e-6, 0.25, 0.5, 0.75, 1.0, 1.25])


# Readings to impacts.


@dataclass(frozen=True)
class Impacts:
    """Impacts of a recording.

    ``speed`` is in m/s; ``readings`` is M, the derivative of ln r by the readings (of times in s,
    heights in m, speeds in m/s, or r), and ``usual`` is the usual standard deviation of these.
    ``arithmetic`` has the errors of ln r if numbers of the size of the sum of readings, as times
    are, have errors of 2⁻⁵² of it, which do not cancel.
    """

    speed: Array
    log_r: Array
    readings: Array
    usual: float
    arithmetic: Array

    @property
    def restitution(self) -> Array:
        """r of each impact."""
        return np.exp(self.log_r)


def _derivatives(kind: str, values: Array) -> Array:
    """Return the part of a chain in M, which is that of ln v after minus that before an impact."""
    power = np.array(_KINDS[kind][2])
    n = len(values)
    if values.ndim == 2:
        # The readings of a pair are independent, and enter as one.
        return np.diag(np.linalg.norm(power / values, axis=1))
    # A flight is the difference of two readings.
    each = np.diff(np.eye(n + 1), axis=0) if kind == "flights" else np.eye(n)
    return np.diff(power[0] * each / values[:, None], axis=0)


def impacts_of(recording: Recording, drag: float = 0.0) -> Impacts:
    """Return the impacts of a recording; drag is ρ C A/(2 m) in 1/m.

    Raises
    ------
    Refused
        If there is no impact between two flights.
    """
    kind = recording.kind
    chains = recording.chains
    if kind == "track":
        found = np.array([impact_of(each, drag) for each in chains])
        chains = (found[:, :2] * STANDARD_GRAVITY / found[:, 2:3],)
    pairs = np.concatenate(
        [
            values if values.ndim == 2 else np.column_stack([values[:-1], values[1:]])
            for values in chains
        ]
    )
    if not len(pairs):
        raise Refused(
            f"{recording.name}: no impact lies between two flights: three times or two heights are "
            "needed"
        )
    before, after = pairs.T
    if kind == "coefficients":
        after = before * after
    if kind == "flights":
        before, after = heights_of(pairs, drag).T
    if kind in ("flights", "heights", "drops"):
        before, _ = speeds_of(before, drag)
        _, after = speeds_of(after, drag)
    readings = linalg.block_diag(*(_derivatives(kind, values) for values in chains))
    size = sum(float(values.sum()) for values in chains)
    arithmetic = np.finfo(float).eps * size * np.linalg.norm(readings, axis=1)
    return Impacts(before, np.log(after / before), readings, _KINDS[kind][1], arithmetic)


def without_contacts(recording: Recording, durations: Array) -> Recording:
    """Return a recording of flights from release to touch, in place of from touch to touch.

    Raises
    ------
    Refused
        If a contact would last longer than half of the flights, or than two touches are apart.
    """
    # A recording with a duration for each touch has one chain.
    lasting = durations if len(durations) == 1 else durations[:-1]
    chains = tuple(flights - lasting for flights in recording.chains)
    rest = np.concatenate(chains)
    if rest.min() <= 0 or rest.sum() < np.concatenate(recording.chains).sum() / 2:
        longest = show(float(np.max(durations)), "s")
        raise Refused(f"contact time: {longest} is longer than flights are: is its unit right?")
    return replace(recording, chains=chains)


# Impacts to r at one speed.


@dataclass(frozen=True)
class Curves:
    """Smooth curves about a speed, by the ratio ρ of scatter to errors, the size τ of these, and q.

    ``basis`` has the eigenvectors of M Mᵀ, in which ``columns`` (exponent, n, 2) are the ones and
    the bends of which curves are the sums, and ``variances`` (ratio, n) those of ln r over τ²;
    ``sizes`` are the τ, and ``rounded`` is what rounding has of them. The logarithm of the
    posterior, the weights by the confidence distribution of the scatter, the means of β, ``value``,
    and of c, ``slope``, and the standard deviation of β, ``spread``, have the shape (ratio, size,
    exponent). ``scatter`` is the root mean square of the errors of r about the mean curve.
    ``is_known`` says whether the errors of readings are given.
    """

    is_known: bool
    basis: Array
    columns: Array
    variances: Array
    sizes: Array
    rounded: float
    posterior: Array
    confidence: Array
    value: Array
    slope: Array
    spread: Array
    scatter: float


@dataclass(frozen=True)
class Estimate:
    """The median of β, the ends of its interval of 95 %, and the mean of c."""

    value: float
    low: float
    high: float
    slope: float


def _deviations(weights: Array, columns: Array, y: Array) -> tuple[Array, Array]:
    """Return what the best sums of columns leave, over its standard deviation, and their basis.

    ``weights`` (ratio, n) are one over the variances, ``columns`` are (curve, n, k); the deviations
    (ratio, curve, n, 1) are y less its projection Q Qᵀ on the columns.
    """
    size = np.sqrt(weights)[:, None, :, None]
    q, r = np.linalg.qr(size * columns)
    # Impacts of one speed tell nothing of a slope, and those of two nothing of a bend.
    left = np.abs(np.diagonal(r, axis1=-2, axis2=-1))
    q *= (left > 1e-9 * left[..., :1])[..., None, :]
    u = size * y[:, None]
    return u - q @ (q.swapaxes(-1, -2) @ u), q


def _below(weights: Array, columns: Array, y: Array, sizes: Array) -> Array:
    """Return the probability that the scatter is below each one: (ratio, size, exponent).

    The statistic is the derivative of the logarithm of the likelihood by s², Σ w u² of the
    `_deviations` u. It has nearly a χ² distribution with its mean and variance (F. E.
    Satterthwaite, Biometrics Bulletin 2 (1946) 110).
    """
    u, q = _deviations(weights, columns, y)
    # The weights of no scatter are those of the smallest one, against rounding errors.
    w = np.concatenate([weights[1:2], weights[1:]])[:, None, :, None]
    weighted = w * q
    both = q.swapaxes(-1, -2) @ weighted
    mean = np.sum(w, axis=(2, 3)) - np.trace(both, axis1=2, axis2=3)
    variance = np.sum(w**2, axis=(2, 3)) - 2 * np.sum(weighted**2, axis=(2, 3))
    variance += np.sum(both**2, axis=(2, 3))
    # There are between 1 and n - 1 degrees of freedom.
    degrees = 1 / np.clip(variance / mean**2, 1 / (len(y) - 1), 1.0)
    statistic = degrees / mean * np.sum(w * u**2, axis=(2, 3))
    return special.chdtrc(degrees[:, None], statistic[:, None] / sizes[:, None] ** 2)


def _confidence(posterior: Array, below: Array, scatter: Array) -> Array:
    """Return the weights by the confidence distribution of the scatter."""
    # No scatter has a weight of its own, and each other one what is nearest to it.
    ends = (below[1:-1] + below[2:]) / 2
    ends = np.concatenate([np.zeros_like(ends[:1]), below[:1], ends, np.ones_like(ends[:1])])
    weights = np.diff(ends, axis=0)
    above = np.maximum(np.log(scatter / _SCATTER) / _WIDTH_OF_SCATTER, 0.0)
    weights[1:] *= np.exp(-(above**2) / 2)[..., None]
    return weights / weights.sum(axis=0) * posterior.sum(axis=0)


def curves_of(
    impacts: Impacts, known: float | Array | None, at: float, rounding: float = 0.0
) -> Curves:
    """Return the smooth curves about a speed in m/s.

    ``known`` is the standard deviation of the readings, or that of each r; None if it is not known.
    Then readings are multiples of ``rounding``, if it is not 0.
    """
    n = len(impacts.log_r)
    errors = impacts.readings * (impacts.usual if known is None else known)
    covariance = errors @ errors.T
    error = math.sqrt(float(np.median(np.diag(covariance))))
    eigenvalues, basis = np.linalg.eigh(covariance / error**2)
    # What is known of ln τ, or else of ln s, has a width of at least 1/√(2 n). Steps of 1/20 are
    # enough, because an error of 5 % in scatter is one of 5 % in the width.
    step = float(np.clip(math.sqrt(2 / n), 0.05, 0.25))
    # A scatter of 0.5 is more than enough, beside any errors.
    most = 7.5 if known is None else max(7.5, math.log(0.5 / error))
    ratio = np.exp(np.arange(-3.5, most, 0.25 if known is None else step))
    # Readings that are nearly redundant have eigenvalues of about 0.
    variances = eigenvalues + 1e-9 + np.square([0.0, *ratio])[:, None]
    if known is None:
        unrounded = np.exp(np.arange(-7.0, 7.0, step))
        rounded = rounding / math.sqrt(12) / impacts.usual
        sizes = error * np.hypot(unrounded, rounded)
    else:
        rounded = 0.0
        unrounded = np.ones(1)
        sizes = np.array([error])
    scatter = np.outer(ratio, sizes)
    # The logarithms of the priors.
    prior = -((np.log(unrounded) / _WIDTH_OF_ERRORS) ** 2) / 2 * np.ones((len(variances), 1))
    prior[1:] -= (np.log(scatter / _SCATTER) / _WIDTH_OF_SCATTER) ** 2 / 2
    # With the weights w, e for the ones, b for the bends and means m = Σ w e y/Σ w e² and
    # d = Σ w e b/Σ w e², the slope is (Σ w b y - d m Σ w e²)/(Σ w b² - d² Σ w e² + 1/0.25²), and β
    # is m - d c. The middle of ln r is subtracted against rounding errors.
    bends = np.expm1(np.outer(_EXPONENTS, np.log(impacts.speed / at))) / _EXPONENTS[:, None]
    middle = float(np.mean(impacts.log_r))
    one = basis.sum(axis=0)
    bend = bends @ basis
    y = (impacts.log_r - middle) @ basis
    weights = 1 / variances
    ones = (weights @ one**2)[:, None]
    both = weights @ (one * bend).T / ones
    mean = (weights @ (one * y))[:, None] / ones
    precision = (1 / sizes**2)[:, None]
    of_bends = (weights @ (bend**2).T - ones * both**2)[:, None] * precision + _SLOPE**-2
    pull = (weights @ (bend * y).T - ones * both * mean)[:, None] * precision
    slope = pull / of_bends
    squares = ((weights @ y**2)[:, None] - ones * mean**2)[:, None] * precision - pull * slope
    logarithms = np.sum(np.log(variances), axis=1)[:, None] + 2 * (n - 1) * np.log(sizes)
    volume = (logarithms + np.log(ones))[..., None] + np.log(of_bends)
    posterior = prior[..., None] - (squares + volume) / 2
    value = middle + mean[:, None] - both[:, None] * slope
    shares = special.softmax(posterior)
    curve = np.sum(shares * value) + np.sum(shares * slope, axis=(0, 1)) @ bends
    deviations = np.exp(curve) - impacts.restitution
    columns = np.stack([np.broadcast_to(one, bend.shape), bend], axis=-1)
    # Two impacts leave no deviation, and have the posterior of all s > 0.
    confidence = np.concatenate([np.zeros_like(shares[:1]), special.softmax(posterior[1:])])
    if n > 2:
        confidence = _confidence(confidence, _below(weights, columns, y, sizes), scatter)
    return Curves(
        is_known=known is not None,
        basis=basis,
        columns=columns,
        variances=variances,
        sizes=sizes,
        rounded=error * rounded,
        posterior=posterior,
        confidence=confidence,
        value=value,
        slope=slope,
        spread=np.sqrt(1 / (ones[:, None] * precision) + both[:, None] ** 2 / of_bends),
        # A curve has two parameters.
        scatter=math.sqrt(float(np.sum(deviations**2)) / max(n - 2, 1)),
    )


def _estimate(curves: Curves, weights: Array) -> Estimate:
    """Return what a recording says; the weights begin with the first ratio."""
    n = len(weights)
    # What is left out changes probabilities by less than 1e-6.
    matters = weights > 1e-6 / weights.size
    weights = weights[matters]
    value = curves.value[:n][matters]
    spread = curves.spread[:n][matters]
    ends = np.min(value - 9 * spread), np.max(value + 9 * spread)
    low, middle, high = (
        optimize.brentq(
            lambda x, p=level: special.ndtr((x - value) / spread) @ weights - p, *ends, xtol=1e-9
        )
        for level in (0.025, 0.5, 0.975)
    )
    slope = np.sum(curves.slope[:n][matters] * weights)
    return Estimate(middle, low, high, float(slope))


def without_scatter(impacts: Impacts, curves: Curves) -> float:
    """Return the probability of deviations that are at least as unlikely if impacts do not scatter.

    The deviations from a power of the speed are sums of independent uᵢ with variances τ² λᵢ. If τ
    is known, Σ u²/(τ² λ) has the χ² distribution. Otherwise the statistic is q = (Σ u²/λ)/(Σ u²):
    it is larger than the measured one if a sum of squares of normal numbers with the factors
    1 - q λᵢ is positive, whose probability is an integral of J. P. Imhof, Biometrika 48 (1961) 419.
    """
    # Sums of ln r in which powers of the speed vanish.
    free = linalg.null_space(np.vander(np.log(impacts.speed), 2).T)
    turned = free.T @ curves.basis
    eigenvalues, turn = np.linalg.eigh((turned * curves.variances[0]) @ turned.T)
    squares = (impacts.log_r @ free @ turn) ** 2
    statistic = float(np.sum(squares / eigenvalues))
    if curves.is_known:
        # Two impacts leave no deviations, which any number of degrees of freedom allows.
        return float(special.chdtrc(max(len(squares), 1), statistic / curves.sizes[0] ** 2))
    # A single deviation has no pattern, and neither have errors of the arithmetic.
    if len(squares) < 2 or squares.sum() <= np.sum(impacts.arithmetic**2):
        return 1.0
    factors = 1 - statistic / squares.sum() * eigenvalues
    # The integrand is smooth in ln u, and vanishes on both sides.
    log_u = np.linspace(-40.0, 60.0, 2001)
    products = np.exp(log_u)[:, None] * factors / np.abs(factors).max()
    angle = np.sum(np.arctan(products), axis=1) / 2
    decay = np.exp(-np.sum(np.log1p(products**2), axis=1) / 4)
    return float(0.5 + integrate.trapezoid(np.sin(angle) * decay, log_u) / math.pi)


def estimates(impacts: Impacts, curves: Curves) -> tuple[Estimate, Estimate | None]:
    """Return what a recording says if impacts scatter, and if they do not.

    The second one is None if the impacts contradict it, or if it says the same.
    """
    scattering = _estimate(curves, curves.confidence)
    still = _estimate(curves, special.softmax(curves.posterior[:1]))
    # An interval of nearly the same width says the same.
    says_more = still.high - still.low < 0.8 * (scattering.high - scattering.low)
    is_possible = still.low <= 0 and without_scatter(impacts, curves) >= ACCEPTED
    return scattering, still if says_more and is_possible else None


# Impacts to contact laws.


@dataclass(frozen=True)
class ContactLaw:
    """A contact that pushes with K (p^n + A p^m p′), and never pulls.

    In the units L = (M v²/K)^(1/(n + 1)) and L/v the ball arrives with the speed 1, and only the
    damping x = A v L^(m - n) is left, which goes as v to the power of ``speed``.
    """

    n: float
    m: float

    @property
    def speed(self) -> float:
        """The power of the speed with which the damping x goes."""
        return (1 + 2 * self.m - self.n) / (1 + self.n)

    @functools.cached_property
    def by_damping(self) -> Any:
        """The curve over x of ln r and of the contact time over L/v, down to r = 0.005.

        The impacts of all x are one system p″ = -(pⁿ + x p^m p′)₊, p′ = 1 at first, which is
        followed until all balls fly. Their flight leads back to the release, where pⁿ = x p^m r.
        Errors of ln r are below 1e-5, and those of the contact time below 2e-4 of it.
        """
        x = np.array([0.0, *np.geomspace(1e-3, 200.0, 120)])
        end = 40.0

        def rate(_: float, state: Array) -> Array:
            p, w = np.split(state, 2)
            inside = np.maximum(p, 0.0)
            force = inside**self.n + x * inside**self.m * w
            return np.concatenate([w, -np.maximum(force, 0.0)])

        states = integrate.solve_ivp(
            rate, (0.0, end), np.repeat([0.0, 1.0], len(x)), rtol=1e-8, atol=1e-11
        ).y
        p, w = np.split(states[:, -1], 2)
        released = (-x * w) ** (1 / (self.n - self.m)) if self.n > self.m else 0.0
        # The first ball has no damping, and its r is 1.
        values = np.column_stack([np.log(w / w[0]), end + (released - p) / w])
        return interpolate.CubicSpline(x, values)

    def x(self, a: Array | float, v: Array) -> Array:
        """Return the damping x = a v^speed at speeds in m/s, at most that of the curve."""
        return np.minimum(a * v**self.speed, self.by_damping.x[-1])

    def log_r(self, a: Array | float, v: Array) -> Array:
        """Return ln r at speeds in m/s if x = a v^speed."""
        return self.by_damping(self.x(a, v))[..., 0]

    def duration(self, a: Array | float, v: Array) -> Array:
        """Return the contact time at speeds in m/s, over L/v."""
        return self.by_damping(self.x(a, v))[..., 1]

    def damping(self, restitution: float) -> float:
        """Return the x with a restitution coefficient."""
        x = self.by_damping.x
        return float(np.interp(-math.log(restitution), -self.by_damping(x)[:, 0], x))


# By their contact times, and by their r over the speed.
_TIMED = {
    "linear": ContactLaw(1.0, 0.0),
    "Hertz with Tsuji": ContactLaw(1.5, 0.25),
    "Hertz with Kuwabara and Kono": ContactLaw(1.5, 0.5),
    "Hunt and Crossley": ContactLaw(1.0, 1.0),
}
LAWS = {
    "constant r (linear; Hertz with Tsuji)": _TIMED["linear"],
    **{name: law for name, law in _TIMED.items() if law.speed},
}


@dataclass(frozen=True)
class Judged:
    """A law beside the impacts.

    ``rms`` is the root mean square of the errors of r, ``left_out`` that at impacts that are left
    out of the fit one by one, ``needed`` the size of independent errors of r with which the law
    would not be rejected, ``probability`` that of a larger deviation from the smooth curve.
    """

    law: str
    parameter: float
    restitution: float
    rms: float
    left_out: float
    needed: float
    probability: float
    verdict: str = "undecided"


def _rms(errors: Array) -> float:
    return math.sqrt(float(np.mean(errors**2)))


def _least_squares(law: ContactLaw, impacts: Impacts, curves: Curves) -> tuple[Array, Array, Array]:
    """Return a of a law for each ratio, what it misses of ln r, and the derivative of ln r by a.

    It is found by Gauss's method: ln r is a convex curve over a, which is approached from below.
    """
    v = impacts.speed
    a = np.zeros((len(curves.variances), 1))
    for _ in range(20):
        missed = impacts.log_r - law.log_r(a, v)
        slope = law.by_damping(law.x(a, v), 1)[..., 0] * v**law.speed
        pull = slope @ curves.basis / curves.variances
        step = np.sum(pull * (missed @ curves.basis), axis=1)
        step /= np.sum(pull * (slope @ curves.basis), axis=1)
        # r is at most 1.
        a = np.maximum(a + step[:, None], 0.0)
    return a, missed, slope


def _judged(
    name: str, impacts: Impacts, curves: Curves, at: float, weights: Array, nearest: Array
) -> Judged:
    """Return a law beside the impacts.

    ``weights`` are those of the ratios, and ``nearest`` has the squares of the nearest curve for
    each. The last row of variances is beside the ratios.
    """
    law = LAWS[name]
    r = impacts.restitution
    a, missed, slope = _least_squares(law, impacts, curves)
    squares = np.sum((missed @ curves.basis) ** 2 / curves.variances, axis=1)
    # A law may fit better than the curves.
    worse = np.maximum(squares - nearest, 0.0)
    if curves.is_known:
        of_ratios = np.exp(-worse[1:-1] / (2 * curves.sizes[0] ** 2))
        probability = np.average(of_ratios, weights=weights[1:])
    else:
        least = nearest[:-1]
        of_ratios = (least / (least + worse[:-1])) ** (max(len(r) - 3, 0) / 2)
        probability = np.max(of_ratios[weights > np.max(weights) / 20])
    best = int(np.argmax(weights))
    inverse = curves.basis / curves.variances[best] @ curves.basis.T
    # An impact is left out if it has a parameter of its own, which is what the others leave of it.
    column = slope[best] / math.sqrt(slope[best] @ inverse @ slope[best])
    pull = inverse @ column
    alone = inverse @ missed[best] / (np.diag(inverse) - pull**2)
    return Judged(
        law=name,
        parameter=float(a[best, 0]),
        restitution=float(np.exp(law.log_r(a[best, 0], np.array(at)))),
        rms=_rms(r * np.expm1(-missed[best])),
        left_out=_rms(r * np.expm1(-missed[best] - column * pull * alone)),
        needed=math.sqrt(worse[-1] / (-2 * math.log(REJECTED))) * float(np.mean(r)),
        probability=float(probability),
    )


def _verdict(probability: float, is_any_rejected: bool, is_known: bool) -> str:
    if probability < REJECTED:
        return "incompatible" if is_known else "deviates"
    return "compatible" if probability > ACCEPTED and is_any_rejected else "undecided"


def judge(impacts: Impacts, curves: Curves, at: float) -> list[Judged]:
    """Return the laws with their verdicts, that of the smallest errors first."""
    weights = special.softmax(curves.posterior).sum(axis=(1, 2))
    # One more row has independent errors of ln r.
    rows = [curves.variances, np.ones(len(impacts.log_r))]
    curves = replace(curves, variances=np.vstack(rows))
    x = np.log(impacts.speed / at)
    powers = curves.basis.T @ np.column_stack([np.ones_like(x), x, x**2])
    y = impacts.log_r @ curves.basis
    deviations = [
        _deviations(1 / curves.variances, columns, y)[0]
        for columns in (curves.columns, powers[None])
    ]
    squares = np.sum(np.concatenate(deviations, axis=1) ** 2, axis=(2, 3))
    nearest = np.min(squares, axis=1)
    # Rounded readings may be alike by chance, and leave a curve less than their own errors and
    # those of the arithmetic.
    errors = curves.rounded**2 * curves.variances[0] + curves.basis.T**2 @ impacts.arithmetic**2
    left = np.mean(errors / curves.variances[:-1], axis=1)
    nearest[:-1] = np.maximum(nearest[:-1], max(len(x) - 3, 1) * left)
    found = [_judged(name, impacts, curves, at, weights, nearest) for name in LAWS]
    is_any_rejected = any(each.probability < REJECTED for each in found)
    return sorted(
        (
            replace(each, verdict=_verdict(each.probability, is_any_rejected, curves.is_known))
            for each in found
        ),
        key=lambda each: each.rms,
    )


@dataclass(frozen=True)
class Timed:
    """A law with measured contact times.

    ``duration`` is the contact time of the law at the speed in s, ``rms`` the root mean square of
    the relative errors of the times, NaN of a single one; ``stiffness`` is K in N/m^n (per kg if
    the mass is not known) and ``damping`` A of the force K (p^n + A p^m p′), in SI units.
    """

    law: str
    duration: float
    rms: float
    stiffness: float
    damping: float
    unit: str


def by_contact_time(
    impacts: Impacts,
    durations: Array,
    laws: tuple[Judged, ...],
    restitution: float,
    at: float,
    mass: float | None,
) -> tuple[Timed, ...]:
    """Return the laws whose contacts last as long as measured ones.

    There is one time, or one for each impact or each touch of flights; the first and the last touch
    have no r. A law that was not judged has the restitution coefficient at the speed.
    """
    v = impacts.speed
    measured = durations[1:-1] if len(durations) == len(v) + 2 else durations
    if len(measured) != len(v):
        measured = measured.mean(keepdims=True)
        v = np.exp(np.mean(np.log(v), keepdims=True))
    parameters = {each.law: each.parameter for each in laws}
    found = []
    for name, law in _TIMED.items():
        a = parameters.get(name, law.damping(restitution) / at**law.speed)
        # T = (M/K)^(1/(n + 1)) v^power D, where D is over L/v.
        power = (1 - law.n) / (1 + law.n)
        lasts = v**power * law.duration(a, v)
        scale = math.exp(float(np.mean(np.log(measured / lasts))))
        found.append(
            Timed(
                law=name,
                duration=scale * at**power * float(law.duration(a, np.array(at))),
                rms=_rms(measured / (scale * lasts) - 1) if len(v) > 1 else math.nan,
                stiffness=(mass or 1.0) / scale ** (law.n + 1),
                damping=a * scale ** (law.n - law.m),
                unit=("N/m" if law.n == 1 else f"N/m^{law.n:g}") + ("" if mass else "/kg"),
            )
        )
    return tuple(found)


# The answer.


@dataclass(frozen=True, repr=False)
class Fit(Page):
    """r at a speed with its 95 % interval, the laws, and what else is known of the recording.

    ``restitution_without_scatter`` and ``without_scatter`` are r and its interval if impacts do not
    scatter; None if they are the same, or if the impacts contradict them. ``scatter`` is the root
    mean square of the deviations of single impacts.
    """

    recording: Recording
    impacts: Impacts
    speed: float
    restitution: float
    interval: tuple[float, float]
    restitution_without_scatter: float | None
    without_scatter: tuple[float, float] | None
    scatter: float
    slope: float
    laws: tuple[Judged, ...]
    times: tuple[Timed, ...]
    mass: float | None
    diameter: float | None
    notes: tuple[str, ...]

    @property
    def intervals(self) -> list[str]:
        """The lines of single impacts: r, the plain ratio of the flights, and the drag's part."""
        plain = impacts_of(self.recording).restitution
        rows = zip(self.impacts.speed, self.impacts.restitution, plain, strict=True)
        cells = [[f"{v:.5g}", f"{r:.5f}", f"{q:.5f}", f"{q - r:+.5f}"] for v, r, q in rows]
        return aligned([["v in m/s", "r", "ratio", "by drag"], *cells])

    @property
    def tables(self) -> list[list[list[str]]]:
        """The cells of the tables of laws, by r and by contact times, the headings first."""
        at = f"at {self.speed:.3g} m/s"
        by_r = [
            [each.law]
            + [f"{x:.4f}" for x in (each.restitution, each.rms, each.left_out, each.needed)]
            + [each.verdict]
            for each in self.laws
        ]
        by_time = [
            [
                each.law,
                show(each.duration, "s", 4),
                "–" if math.isnan(each.rms) else f"{100 * each.rms:.1f} %",
                show(each.stiffness, each.unit, 4),
                f"{each.damping:.4g}",
            ]
            for each in self.times
        ]
        return [
            [["law", f"r {at}", "rms", "left out", "errors needed", "verdict"], *by_r],
            [["law", f"contact time {at}", "rms", "stiffness", "damping"], *by_time],
        ]

    def __repr__(self) -> str:
        v = self.impacts.speed
        title = self.recording.head.get("title", self.recording.name)
        count = "1 impact" if len(v) == 1 else f"{len(v)} impacts"
        at = f"at {self.speed:.3g} m/s, 95 %:"

        def line(r: float, interval: tuple[float, float]) -> str:
            # r has the digits of its interval, in which it would not lie with fewer.
            ends = span(*interval, 4)
            return f"r = {r:.{len(ends.split()[0]) - 2}f} {at} {ends}"

        found = line(self.restitution, self.interval)
        if self.without_scatter is not None and self.restitution_without_scatter is not None:
            still = line(self.restitution_without_scatter, self.without_scatter)
            found += f" if impacts scatter\n{still} if they do not"
        return (
            f"{title}: {count} at {v.min():.3g} to {v.max():.3g} m/s, "
            f"from {self.recording.kind}\n"
            f"{found}\n"
            f"r goes as v^{self.slope:+.3f}; single impacts deviate from it by {self.scatter:.4f}"
        )

    def __str__(self) -> str:
        lines = [repr(self), *(f"! {note}" for note in self.notes)]
        for table in self.tables if self.laws else []:
            lines += ["", *aligned(table)] if len(table) > 1 else []
        return "\n".join(lines)

    def bounce(self, mass: Quantity = None, **more: Any) -> Bounce:
        """Return the bounce at this speed, with the contact time of the recording if it has one.

        That of a bounce is the one of a linear contact without damping.
        """
        given = {name: value for name, value in more.items() if value is not None}
        if self.diameter is not None and not given.keys() & {"radius", "density"}:
            given["radius"] = self.diameter / 2
        if self.times and not given.keys() & {"penetration", "stiffness", "contact_time"}:
            # The linear law is the first one, and its stiffness may be that of one kilogram.
            ratio = (self.mass or 1.0) / self.times[0].stiffness
            given["contact_time"] = math.pi * math.sqrt(ratio)
        mass = self.mass if mass is None else mass
        return Bounce(mass=mass, restitution=self.restitution, speed=self.speed, **given)

    def design(
        self, engine: str | Engine = "generic", time_step: Quantity = None, **more: Any
    ) -> Design:
        """Return the design of an engine for this bounce; ``more`` belongs to the bounce."""
        return design(self.bounce(**more), engine, time_step)


def lowest_points(recording: Recording, diameter: float | None) -> Recording:
    """Return a recording whose heights were read at the top of the ball as those of its bottom.

    Of drops these are the rebounds; the drop height is that of the bottom.

    Raises
    ------
    Refused
        If there are no heights, the diameter is missing, or it is more than a height.
    """
    if recording.kind not in ("drops", "heights"):
        raise Refused("--read-at is for heights: there are none in this recording")
    if diameter is None:
        raise Refused("heights read at the top of the ball need its diameter: --diameter '43 mm'")
    size = np.array([0.0, diameter]) if recording.kind == "drops" else diameter
    chains = tuple(each - size for each in recording.chains)
    if min(each.min() for each in chains) <= 0:
        raise Refused(f"a height is less than the diameter of {show(diameter, 'm')}")
    return replace(recording, chains=chains)


def _of_logs(estimate: Estimate) -> tuple[float, float]:
    """Return the ends of an interval of r, which is at most 1."""
    return min(math.exp(estimate.low), 1.0), min(math.exp(estimate.high), 1.0)


def fit(
    source: str | Path | Mapping[str, Any] | Recording,
    speed: Quantity = None,
    *,
    resolution: Quantity = None,
    mass: Quantity = None,
    diameter: Quantity = None,
    contact_time: Quantity = None,
    leave_out: tuple[int, ...] = (),
    intervals: bool = False,
    ball: str | None = None,
    read_at: str | None = None,
    laws: bool = False,
) -> Fit:
    """Return r of a recording at a speed with its 95 % interval, and the laws that it allows.

    Parameters
    ----------
    source : str, Path, mapping or Recording
        A file, a published experiment by its name, columns with the headings of a file such as
        ``{"time (s)": [0.45, 1.17, 1.75]}``, or a recording.
    speed : Quantity, optional
        By default the middle of the speeds, the geometric mean.
    resolution : Quantity, optional
        The standard deviation of a reading: of a time, a height, a speed, or r.
    mass, diameter : Quantity, optional
        Of the ball, with which the drag of the air is removed from flights, heights and tracks.
    contact_time : Quantity, optional
        A measured one, in place of those of the recording: it gives the laws their stiffness, and
        is taken off times between impacts, which are from touch to touch.
    leave_out : tuple of int
        Lines of the file.
    intervals : bool
        Whether a file with times and intervals is read by its intervals.
    ball : str, optional
        The name of one, if the file has a column of several.
    read_at : {"bottom", "top"}, optional
        Where rebound heights were read off the ball.
    laws : bool
        Whether contact laws are judged.

    Raises
    ------
    Refused
        If the recording cannot be read or has several balls, no impact lies between two
        flights, or r is above 1.
    """
    if isinstance(source, Recording):
        recording = source
    else:
        recording = read(source, leave_out, intervals, ball)

    def given(name: str, value: Quantity, unit: str) -> float | None:
        said = recording.head.get(name) if value is None else value
        return None if said is None else positive(name, said, unit)

    unit = _KINDS[recording.kind][0]
    known = given("resolution", resolution, unit) or recording.uncertainty
    kilograms = given("mass", mass, "kg")
    metres = given("diameter", diameter, "m")
    if read_at not in (None, "bottom", "top"):
        raise Refused(f"--read-at {read_at} is neither bottom nor top")
    if read_at == "top":
        recording = lowest_points(recording, metres)
    drag = drag_of(kilograms, metres) if kilograms and metres else 0.0
    contact = given("contact time", contact_time, "s")
    durations = recording.durations if contact is None else np.array([contact])
    if durations is None:
        # A contact that is not known is taken to have no duration.
        durations = np.zeros(1)
    lasts = float(np.mean(durations))
    rounding = rounding_of(recording) if known is None else 0.0
    is_heard = recording.kind == "flights" and not recording.is_free
    if is_heard:
        recording = without_contacts(recording, durations)
    impacts = impacts_of(recording, drag)
    v = impacts.speed
    middle = math.exp(float(np.mean(np.log(v))))
    at = middle if speed is None else positive("speed", speed, "m/s")
    curves = curves_of(impacts, known, at, rounding)
    scattering, still = estimates(impacts, curves)
    r = math.exp(scattering.value)
    # A number that is typed wrongly is by far the farthest one.
    far = np.abs(impacts.log_r - np.median(impacts.log_r))
    farthest = int(np.argmax(far))
    is_far = len(v) > 3 and far[farthest] > max(0.2, 5 * float(np.sort(far)[-2]))
    if scattering.low > 0:
        raise Refused(f"{recording.name}: r = {r:.4f} is above 1 by more than its error")
    interval = _of_logs(scattering)
    second = None if still is None else _of_logs(still)
    low, high = second or interval
    # Of flights T with a contact, r is T′/T; by g T = 2 v this is its derivative by the contact.
    lower = float(np.mean((1 - impacts.restitution) / v)) * STANDARD_GRAVITY / 2
    matters = (high - low) / (2 * lower) if lower > 0 else math.inf
    judged = tuple(judge(impacts, curves, at)) if laws and len(v) > 2 else ()
    # Of a flight to a height h, drag takes about r D v²/g; a tennis ball has D = 0.017/m.
    by_drag = (drag or _TENNIS) * r * float(np.mean(v**2)) / STANDARD_GRAVITY
    does_drag = recording.kind in _WITH_DRAG and by_drag > (high - low) / 2
    is_height = recording.kind in ("drops", "heights") and read_at is None
    size = metres or 0.04
    # r = √(h′/h), and h′ = r² v²/2g.
    by_size = float(np.mean(size * STANDARD_GRAVITY / (impacts.restitution * v**2)))
    # Both heights of a series are too large.
    by_size *= 1 - r**2 if recording.kind == "heights" else 1.0
    notes = {
        f"readings are multiples of {show(rounding, unit, 4)}: taken as rounded": rounding
        > impacts.usual,
        f"the drag of the air is not removed: of a tennis ball it would be {by_drag:.2g} of r; "
        "give the mass and the diameter": does_drag and not drag,
        f"the drag of the air is removed, {by_drag:.2g} of r": does_drag and drag > 0,
        "heights are taken as those of the lowest point of the ball: read at its top, a ball of "
        f"{show(size, 'm')} has an r that is too high by {by_size:.2g} (--read-at bottom or top)": (
            is_height
        ),
        f"the contact, {show(lasts, 's')}, is taken off each time between two impacts": is_heard
        and lasts > 0,
        # Contacts of rubber, the longest ones, last for 10 ms.
        f"times between impacts include the contact: r is lower by {lower / 1000:.2g} for each ms "
        f"that it lasts, which matters from {show(matters, 's')} on; give --contact-time": is_heard
        and not lasts
        and matters < 0.01,
        f"r = {r:.4f} is above 1 within its error: 1 is taken": r > 1,
        f"r = {impacts.restitution[farthest]:.3g} at {v[farthest]:.3g} m/s is far from all others: "
        "is a number wrong? --leave-out leaves its line out": is_far,
        # A speed that is typed is rounded.
        f"{show(at, 'm/s')} is outside of the measured speeds": not 0.99 * v.min()
        <= at
        <= 1.01 * v.max(),
        "too few impacts for an interval of their own: it is wide": len(v) < 3,
        "no errors are given: a law can only be said to deviate": bool(judged) and known is None,
        "no law fits: r is that of a smooth curve": bool(judged)
        and all(each.probability < REJECTED for each in judged),
    }
    r = min(r, 1.0)
    return Fit(
        recording=recording,
        impacts=impacts,
        speed=at,
        restitution=r,
        interval=interval,
        restitution_without_scatter=None if still is None else min(math.exp(still.value), 1.0),
        without_scatter=second,
        scatter=curves.scatter,
        slope=scattering.slope,
        laws=judged,
        times=by_contact_time(impacts, durations, judged, r, at, kilograms) if lasts else (),
        mass=kilograms,
        diameter=metres,
        notes=recording.notes + tuple(text for text, holds in notes.items() if holds),
    )
