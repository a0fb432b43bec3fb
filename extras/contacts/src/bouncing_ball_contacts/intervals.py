"""From the readings of a recording to its impacts, and to r at a speed with its interval.

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

A reading enters the speed xᵢ also, which makes a slope where there is none. What it adds to the
sums of products in c is known, and subtracted (`_by_errors`).

The covariances of all ratios ρ = s/τ have the same eigenvectors, those of M Mᵀ. In their basis each
covariance is a row of variances, and every question below is one of weighted sums of squares.

Few impacts do not tell errors of readings, which hardly change r in the middle, from scatter, which
does. A posterior would hold r too often where scatter is hidden below the errors, and too seldom
where it is large. In its place, τ and q have their posterior, and for each of these s has its
confidence distribution: the squares of the deviations, over their variances and weighted by the
share of scatter in these, have a sum whose distribution is known for each s, and the probability of
a scatter below s is that of a larger sum than the one at s (`_below`). So s = 0 has a probability
of its own. (H. K. Iyer, C. M. Wang, T. Mathew, J. Am. Stat. Assoc. 99 (2004) 1060, have such
intervals for laboratories that measure the same.) Above its middle the prior of scatter multiplies
this distribution. Two impacts leave no deviation, and have the posterior for all s > 0.

Impacts of one group, such as the trials of one height, share an error bⱼ. If group j has nⱼ impacts
i, their mean is::

    ȳⱼ = β + c f(x̄ⱼ) + bⱼ + Σᵢ eᵢ/nⱼ,    var ȳⱼ = var b + var e/nⱼ

so means of different groups are independent, and their variances are equal for equal nⱼ. The fit
above is made to the means, whose scatter s contains bⱼ: impacts of one group count as one impact
(S. G. Donald, K. Lang, Review of Economics and Statistics 89 (2007) 221; J. M. Wooldridge, American
Economic Review 93 (2003) 133). Few means alone do not bound s: by three of them and a slope r would
be known seven times worse than by single impacts. What a group shares is seldom much larger than
the scatter within the groups, so the middle of the prior of s is 1.5 times this scatter, with a
factor of 3.3 above it. At least three groups of several impacts are needed (`group_means`).

The speed of an impact that follows another one is larger for a larger r, so bⱼ would make a slope
of the means ȳⱼ over x̄ⱼ, which hides it. Such means are taken at one speed: only the prior of c then
says how r changes with the speed. A drop height is set, and does not depend on bⱼ.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special

from bouncing_ball_contacts.cameras import Film, film_of
from bouncing_ball_contacts.flights import heights_of, impact_of, speeds_of
from bouncing_ball_contacts.recordings import Recording
from bouncing_ball_contacts.tables import Lines
from bouncing_ball_contacts.tracks import FEWEST
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Array, Refused, refuse, show

# Of each kind of recording: the unit of a reading, its usual standard deviation, and the powers of
# the readings with which the speeds before and after an impact go. Those of series are alike; of a
# coefficient the speed is taken as exact.
KINDS = {
    "flights": ("s", 1e-3, (1.0, 1.0)),
    "heights": ("m", 2e-3, (0.5, 0.5)),
    "drops": ("m", 2e-3, (0.5, 0.5)),
    "speeds": ("m/s", 2e-2, (1.0, 1.0)),
    "track": ("m/s", 2e-2, (1.0, 1.0)),
    "coefficients": ("", 1.1e-2, (0.0, 1.0)),
}
# The priors: the width of the logarithm of errors, the middle of scatter and the width of its
# logarithm, and the width of c.
_WIDTH_OF_ERRORS = 2.0
_SCATTER = 0.011
_WIDTH_OF_SCATTER = 1.5
_SLOPE = 0.25
# The same of means of groups: the middle in units of the scatter within groups, and the width. Both
# are the smallest with which intervals hold r in about 95 % (``interval_coverage.py``).
_SCATTER_OF_GROUPS, _WIDTH_OF_GROUPS = 1.5, 1.2
# Scatter within groups that are all alike, as by rounding.
_SMALLEST_WITHIN = 1e-3
# Of a reading in its SI unit: exact ones, as of a simulation, have the errors of arithmetic.
_ARITHMETIC = 1e-12
# A fit takes about 1 s for each 1,000 impacts; of a series arrays have the square of its length.
_MOST = 10_000
_LONGEST = 1000
# 1e-6 stands for 0, which would be divided by.
_EXPONENTS = np.array([-0.5, 1e-6, 0.25, 0.5, 0.75, 1.0, 1.25])


_TOO_LONG = "contact time: {} is longer than flights are: is its unit right?"


# Readings to impacts.


@dataclass(frozen=True, eq=False)
class Impacts:
    """Impacts of a recording.

    Attributes
    ----------
    speed, log_r
        Speed in m/s, and ln r.
    readings, of_speed
        Derivatives M of ln r and L of ln v with respect to the readings: times in s, heights in m,
        speeds in m/s, or r. Both have one matrix for each series, because series share no reading.
    usual
        Usual standard deviation of a reading.
    known
        Standard deviations of the readings of each series, or of each r, that the recording has or
        shows; None if they are not known.
    films
        Fits of the films of a track.
    groups
        What impacts that share an error have in common: a height, a film, or a name.
    scatter, width
        Middle of the prior of scatter, and the width of its logarithm above the middle.
    is_set
        Whether speeds were set, and do not follow from the impact before.
    """

    speed: Array
    log_r: Array
    readings: tuple[Array, ...]
    of_speed: tuple[Array, ...]
    usual: float
    groups: NDArray[Any]
    known: Array | None = None
    films: tuple[Film, ...] = ()
    scatter: float = _SCATTER
    width: float = _WIDTH_OF_SCATTER
    is_set: bool = True

    @property
    def restitution(self) -> Array:
        """r of each impact."""
        return np.exp(self.log_r)

    def errors(self, size: float | Array) -> tuple[list[Array], list[Array]]:
        """Return M and L times the standard deviation of the readings, or that of each r."""
        sizes = np.broadcast_to(size, len(self.readings))
        of_r, of_speed = (
            [deviation * matrix for deviation, matrix in zip(sizes, matrices, strict=True)]
            for matrices in (self.readings, self.of_speed)
        )
        return of_r, of_speed

    def largest_error(self, known: float | Array | None) -> float:
        """Return the largest standard deviation of the readings.

        If it is not known, all deviations of r are errors of the readings.
        """
        squares = max(sum(float(np.sum(matrix**2)) for matrix in self.readings), _ARITHMETIC)
        largest = math.sqrt(len(self.log_r) * float(np.var(self.log_r)) / squares)
        return largest if known is None else min(largest, float(np.max(known)))


def _derivatives(kind: str, values: Array) -> Iterator[tuple[Array, Array]]:
    """Yield M and L of the series of a chain; each pair is a series."""
    power = np.array(KINDS[kind][2])
    n = len(values)
    if values.ndim == 2:
        # A height of a drop and a speed of a coefficient are set, and not read.
        is_read = kind in ("speeds", "track")
        derivatives = power / values
        readings = (derivatives * [-1, 1])[:, None]
        yield from zip(readings, (derivatives * [is_read, 0])[:, None], strict=True)
    elif n > 1:
        # A flight is the difference of two readings.
        derivatives = np.diff(np.eye(n + 1), axis=0) if kind == "flights" else np.eye(n)
        log_v = power[0] * derivatives / values[:, None]
        yield np.diff(log_v, axis=0), log_v[:-1]


def are_told(impacts: Impacts, known: float | Array | None) -> bool:
    """Return whether the speeds differ by more than errors of the readings would make.

    A reading enters r and the speed, so its error makes a slope of r over the speed where there is
    none. If the covariance of the largest errors is a correlation with a square above 1/20, the
    slope would take more than this share of the deviations.
    """
    both = zip(impacts.readings, impacts.of_speed, strict=True)
    shared = sum(float(np.sum(of_r * of_v)) for of_r, of_v in both)
    covariance = impacts.largest_error(known) ** 2 * shared / len(impacts.speed)
    product = np.var(np.log(impacts.speed)) * np.var(impacts.log_r)
    return bool(20 * covariance**2 <= product)


def _error_of_speed(film: Film) -> float:
    """Return the standard deviation of a speed in m/s, to which speeds of r contribute alike."""
    before, after = film.speeds.T
    of_r = np.linalg.norm(film.readings, axis=1)
    return float(np.median(of_r / np.hypot(1 / before, 1 / after)))


def impacts_of(recording: Recording, drag: float = 0.0) -> Impacts:
    """Return the impacts of a recording; drag is ρ C A/(2 m) in 1/m.

    Raises
    ------
    Refused
        If there is no impact between two flights.
    """
    kind = recording.kind
    chains = recording.chains
    films = tuple(film_of(film, drag, recording.has_clock) for film in recording.films)
    if films:
        chains = tuple(film.speeds for film in films)
    pairs = np.concatenate(
        [
            values if values.ndim == 2 else np.column_stack([values[:-1], values[1:]])
            for values in chains
        ]
    )
    longest = max((len(values) - 1 for values in chains if values.ndim == 1), default=0)
    refuse(
        [
            (
                len(pairs) > _MOST,
                f"{recording.name}: {len(pairs)} impacts are more than {_MOST}: fit parts of them",
            ),
            (
                longest > _LONGEST,
                f"{recording.name}: {longest} impacts of one series are more than {_LONGEST}",
            ),
            (
                not len(pairs),
                f"{recording.name}: no impact lies between two flights: three times or two heights "
                "are needed",
            ),
            (
                not np.all(pairs > 0),
                f"{recording.name}: with this drag no flight is as fast as those of the film: are "
                "mass, diameter and times right?",
            ),
        ]
    )
    before, after = pairs.T
    if kind == "coefficients":
        after = before * after
    if kind == "flights":
        before, after = heights_of(pairs, drag).T
    if kind in ("flights", "heights", "drops"):
        before, _ = speeds_of(before, drag)
        _, after = speeds_of(after, drag)
    series = [derivatives for values in chains for derivatives in _derivatives(kind, values)]
    known = recording.uncertainty
    if films:
        # The error of a speed to which the errors of a film amount.
        known = np.array([_error_of_speed(film) for film in films])
        series = [
            (film.readings / size, film.of_speed / size)
            for film, size in zip(films, known, strict=True)
        ]
    readings, of_speed = zip(*series, strict=True)
    groups = np.arange(len(pairs)) if recording.groups is None else recording.groups
    is_set = kind in ("drops", "coefficients")
    log_r = np.log(after / before)
    usual = KINDS[kind][1]
    return Impacts(before, log_r, readings, of_speed, usual, groups, known, films, is_set=is_set)


def group_means(
    impacts: Impacts, known: float | Array | None
) -> tuple[Impacts, float | Array | None]:
    """Return the mean of each group as one impact, and the standard deviation of its readings.

    With fewer than three groups of several impacts they are returned as they are: two means leave
    no deviation by which the errors of the groups are known.
    """
    names, of, sizes = np.unique(impacts.groups, return_inverse=True, return_counts=True)
    if np.sum(sizes > 1) < 3:
        return impacts, known
    # Errors of each r become the unit of its reading.
    unit = known if isinstance(known, np.ndarray) else 1.0
    begins = np.cumsum([0, *map(len, impacts.readings[:-1])])

    def of_means(matrices: list[Array]) -> tuple[Array, ...]:
        """Return the derivatives of each mean with respect to all readings of its group."""
        rows: list[list[Array]] = [[] for _ in names]
        for i, matrix in zip(of[begins], matrices, strict=True):
            rows[i].append(matrix.sum(axis=0) / sizes[i])
        return tuple(np.concatenate(members)[None] for members in rows)

    readings, of_speed = map(of_means, impacts.errors(unit))
    log_v = np.bincount(of, np.log(impacts.speed)) / sizes
    if not impacts.is_set:
        log_v[:] = np.mean(np.log(impacts.speed))
    log_r = np.bincount(of, impacts.log_r) / sizes
    within = math.sqrt(np.sum((impacts.log_r - log_r[of]) ** 2) / (len(of) - len(names)))
    prior = _SCATTER_OF_GROUPS * math.hypot(within, _SMALLEST_WITHIN), _WIDTH_OF_GROUPS
    means = Impacts(
        np.exp(log_v), log_r, readings, of_speed, impacts.usual, names, None, (), *prior
    )
    return means, 1.0 if isinstance(known, np.ndarray) else known


def misread(impacts: Impacts) -> Lines:
    """Return the impacts that one wrong reading moved away from all others; empty without one.

    A top of a series enters two impacts with opposite signs, and a time enters three. A top that is
    missing moved one impact. They were moved by much more than the deviations that remain.
    """
    away = impacts.log_r - np.median(impacts.log_r)
    # The impact that is farthest away is moved by the reading, or is left.
    farthest = int(np.argmax(np.abs(away)))
    begins = np.cumsum([0, *map(len, impacts.readings)])
    i = int(np.searchsorted(begins, farthest, side="right")) - 1
    begin, end = begins[i : i + 2]
    readings = np.column_stack([impacts.readings[i], np.eye(end - begin)])
    # A reading of a speed that is exact moves nothing.
    squares = np.sum(readings**2, axis=0)
    moved = readings * (readings.T @ away[begin:end]) / np.where(squares > 0, squares, 1.0)
    others = np.abs(np.delete(away, slice(begin, end))).max(initial=0.0)
    left = np.maximum(np.abs(away[begin:end, None] - moved).max(axis=0), others)
    worst = int(np.argmin(left))
    indices = begin + np.flatnonzero(readings[:, worst])
    # Two impacts seldom deviate oppositely by themselves, as one may.
    least = 0.05 if len(indices) > 1 else 0.2
    is_far = np.abs(moved[:, worst]).max() > max(least, 5 * left[worst])
    return indices if is_far and len(away) - len(indices) > 2 else indices[:0]


def _without_contact(recording: Recording, lasts: float) -> Iterator[Array]:
    """Yield the tracks of a recording without positions and time of the contacts in s."""
    for film in recording.films:
        fits = np.array([impact_of(track) for track in film])
        # Times of slow motion are longer than true ones.
        slow = 1.0 if recording.has_clock else math.sqrt(STANDARD_GRAVITY / fits[:, 2].mean())
        for i, track in enumerate(film):
            t, _, after = track.T
            left = np.min(np.abs(t - fits[:, 4, None]), axis=0) > slow * lasts
            if min(np.sum(left * after), np.sum(left * (1 - after))) < FEWEST:
                raise Refused(_TOO_LONG.format(show(lasts, "s")))
            yield (track - np.outer((i + after) * slow * lasts, [1, 0, 0]))[left]


def without_contacts(recording: Recording, lasts: float) -> Recording:
    """Return a recording with the contact subtracted from flights from touch to touch, or from the
    times of a film after each of its impacts.

    Raises
    ------
    Refused
        If a contact in s lasts longer than half of the flights, or than two touches are apart.
    """
    if recording.kind == "track":
        return replace(recording, chains=tuple(_without_contact(recording, lasts)))
    chains = tuple(flights - lasts for flights in recording.chains)
    rest = np.concatenate(chains)
    if rest.min() <= 0 or rest.sum() < np.concatenate(recording.chains).sum() / 2:
        raise Refused(_TOO_LONG.format(show(lasts, "s")))
    return replace(recording, chains=chains)


# Impacts to r at one speed.


@dataclass(frozen=True, eq=False)
class Curves:
    """Smooth curves about a speed, by the ratio ρ of scatter to errors, the size τ of these, and q.

    Attributes
    ----------
    confidence, value, slope, spread
        Weights by the confidence distribution of the scatter, means of β and of c, and standard
        deviation of β, shape (ratio, size, exponent).
    scatter_sizes
        Sizes of the scatter s, shape (ratio, size).
    scatter
        Root mean square of the errors of r about the mean curve.
    has_slope
        Whether the speeds differ by more than errors of the readings would make (`are_told`).
    """

    scatter_sizes: Array
    confidence: Array
    value: Array
    slope: Array
    spread: Array
    scatter: float
    has_slope: bool


@dataclass(frozen=True)
class Estimate:
    """Median of β, ends of its 95 % interval, and mean of c."""

    value: float
    low: float
    high: float
    slope: float

    @property
    def of_r(self) -> tuple[float, float, float]:
        """The median of r and the ends of its interval, which are at most 1."""
        value, low, high = (min(math.exp(x), 1.0) for x in (self.value, self.low, self.high))
        return value, low, high


def deviations(weights: Array, columns: Array, y: Array) -> tuple[Array, Array]:
    """Return the scaled residuals of least squares, and the orthonormal basis Q.

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
    `deviations` u. It has nearly a χ² distribution with its mean and variance (F. E.
    Satterthwaite, Biometrics Bulletin 2 (1946) 110).
    """
    u, q = deviations(weights, columns, y)
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


def _confidence(posterior: Array, below: Array, above: Array) -> Array:
    """Return the weights by the confidence distribution of the scatter.

    ``above`` is ln s less the middle of its prior, in widths of the prior.
    """
    # No scatter has a weight of its own, and each other one what is nearest to it.
    ends = (below[1:-1] + below[2:]) / 2
    ends = np.concatenate([np.zeros_like(ends[:1]), below[:1], ends, np.ones_like(ends[:1])])
    weights = np.diff(ends, axis=0)
    weights[1:] *= np.exp(-(np.maximum(above, 0.0) ** 2) / 2)[..., None]
    return weights / weights.sum(axis=0) * posterior.sum(axis=0)


def _by_errors(
    weights: Array,
    bases: Sequence[Array],
    of_r: list[Array],
    of_speed: list[Array],
    growth: list[Array],
) -> tuple[Array, Array]:
    """Return what errors of the readings add to the products of a regression, (ratio, exponent).

    The slope of y over x is xᵀPy/xᵀPx, with P = W - W 1 1ᵀ W/(1ᵀ W 1). If x = ξ + δ and y = c ξ + ε
    have errors with the covariances cov(δ, ε) = τ² C and cov(δ, δ) = τ² D, these products have the
    means::

        E xᵀPy = c ξᵀPξ + τ² tr PC,    E xᵀPx = ξᵀPξ + τ² tr PD

    The ratio of both, each less its trace, is c (W. A. Fuller, Measurement Error Models, 1987,
    section 2.2). The traces are returned. The ``weights`` (ratio, n) are those of W in its basis.
    For each series, ``of_r`` and ``of_speed`` (n, reading) are derivatives with respect to the
    readings, and ``growth`` (n, exponent) has the derivatives of x with respect to ln v.
    """
    traces = np.zeros((2, len(weights), len(_EXPONENTS)))
    of_means = np.zeros((2, len(weights), len(_EXPONENTS)))
    total = np.zeros((len(weights), 1))
    begin = 0
    for basis, m, of_v, g in zip(bases, of_r, of_speed, growth, strict=True):
        w = weights[:, begin : (begin := begin + len(basis))]
        mean = (w * basis.sum(axis=0)) @ basis.T
        total += mean.sum(axis=1, keepdims=True)
        # The speed may be set, and have no error.
        if np.any(of_v):
            grown = g.T[:, :, None] * basis
            grown_mean = g.T[:, None] * mean
            both = ((m, basis, mean), (of_v, grown, grown_mean))
            for i, (other, others, other_mean) in enumerate(both):
                covariance = of_v @ other.T
                traces[i] += w @ np.sum(grown * (covariance @ others), axis=1).T
                of_means[i] += np.sum((grown_mean @ covariance) * other_mean, axis=-1).T
    made, lost = traces - of_means / total
    return made, lost


def curves_of(
    impacts: Impacts, known: float | Array | None, at: float, rounding: float = 0.0
) -> Curves:
    """Return the smooth curves about a speed in m/s.

    ``known`` is the standard deviation of the readings, or that of each r; None if it is not known.
    Then readings are multiples of ``rounding``, if it is not 0. Groups are fitted by their means.
    """
    impacts, known = group_means(impacts, known)
    n = len(impacts.log_r)
    unit = impacts.usual if known is None else known
    variances_of_series = [np.sum(matrix**2, axis=1) for matrix in impacts.errors(unit)[0]]
    error = math.sqrt(np.median(np.concatenate(variances_of_series)))
    errors, errors_of_speed = impacts.errors(unit / error)
    eigenvalues_of_series, bases = zip(
        *(np.linalg.eigh(matrix @ matrix.T) for matrix in errors), strict=True
    )
    eigenvalues = np.concatenate(eigenvalues_of_series)
    ends = np.cumsum(list(map(len, errors)))[:-1]

    def in_basis(columns: Array) -> Array:
        """Return columns in the basis of the eigenvectors of each series."""
        both = zip(bases, np.split(columns, ends), strict=True)
        return np.concatenate([np.tensordot(basis, part, axes=(0, 0)) for basis, part in both])

    # What is known of ln τ, or else of ln s, has a width of at least 1/√(2 n). Steps of 1/20 are
    # enough, because an error of 5 % in scatter is one of 5 % in the width.
    step = float(np.clip(math.sqrt(2 / n), 0.05, 0.25))
    # A scatter of 0.5 is more than enough, beside any errors.
    most = 7.5 if known is None else max(7.5, math.log(0.5 / error))
    ratio = np.exp(np.arange(-3.5, most, 0.25 if known is None else step))
    # Readings that are nearly redundant have eigenvalues of about 0.
    variances = eigenvalues + 1e-9 + np.square([0.0, *ratio])[:, None]
    unrounded = np.exp(np.arange(-7.0, 7.0, step)) if known is None else np.ones(1)
    rounded = max(rounding / math.sqrt(12) if known is None else 0.0, _ARITHMETIC) / impacts.usual
    sizes = error * np.hypot(unrounded, rounded)
    scatter = np.outer(ratio, sizes)
    # The logarithms of the priors.
    prior = -((np.log(unrounded) / _WIDTH_OF_ERRORS) ** 2) / 2 * np.ones((len(variances), 1))
    above = np.log(scatter / impacts.scatter)
    prior[1:] -= (above / _WIDTH_OF_SCATTER) ** 2 / 2
    # Least squares of y = X (β, c) with the weights W, and the prior of c as one more reading.
    # Bends less their mean, times the ones, are orthogonal to these, so that c is found first. The
    # posterior of the ratio, the size and the exponent has the determinants of W and of both. The
    # middle of ln r is subtracted against rounding errors.
    middle = float(np.mean(impacts.log_r))
    y = in_basis(impacts.log_r - middle)
    # Speeds that differ by errors only are taken as one: then only the prior of c says how r
    # changes up to the speed that is asked.
    x = np.log(impacts.speed / at)
    has_slope = are_told(impacts, known)
    x = x if has_slope else np.full(n, np.mean(x))
    growths = np.outer(x, _EXPONENTS)
    bends = np.expm1(growths) / _EXPONENTS
    both = np.stack([np.ones_like(bends), bends], axis=-1)
    columns = in_basis(both).swapaxes(0, 1)
    weights = 1 / variances
    precision = (1 / sizes**2)[:, None]
    products = np.tensordot(weights, columns[..., None] * columns[..., None, :], axes=(1, 1))
    pull = np.tensordot(weights, columns * y[:, None], axes=(1, 1))
    ones = products[..., 0, 0]
    shift = products[..., 0, 1] / ones
    # Errors of the readings enter the speeds also.
    growth = np.split(np.exp(growths) * has_slope, ends)
    traces = _by_errors(weights, bases, errors, errors_of_speed, growth)
    # Larger errors than the deviations have a posterior of about 0.
    largest = impacts.largest_error(known) * error / np.max(unit)
    made, lost = (trace[:, None] * np.minimum(1.0, largest**2 * precision) for trace in traces)
    squares_of_bends = (products[..., 1, 1] - shift**2 * ones)[:, None] * precision
    of_bends = np.maximum(squares_of_bends - lost, 0.0) + _SLOPE**-2
    slope = ((pull[..., 1] - shift * pull[..., 0])[:, None] * precision - made) / of_bends
    value = (pull[..., 0] / ones)[:, None] - shift[:, None] * slope
    left = (weights @ y**2)[:, None] - pull[..., 0] ** 2 / ones
    squares = left[:, None] * precision - slope**2 * of_bends
    volume = np.sum(np.log(variances), axis=1)[:, None] + 2 * (n - 1) * np.log(sizes)
    volume = volume[..., None] + np.log(ones)[:, None] + np.log(of_bends)
    posterior = prior[..., None] - (squares + volume) / 2
    shares = special.softmax(posterior)
    curve = middle + np.sum(shares * value) + bends @ np.sum(shares * slope, axis=(0, 1))
    errors_of_r = np.exp(curve) - impacts.restitution
    # Two impacts leave no deviation, and have the posterior of all s > 0.
    confidence = np.concatenate([np.zeros_like(shares[:1]), special.softmax(posterior[1:])])
    if n > 2:
        # One exponent at a time, because these arrays are the largest ones.
        below = [_below(weights, regressors[None], y, sizes) for regressors in columns]
        shares_below = np.concatenate(below, axis=-1)
        confidence = _confidence(confidence, shares_below, above / impacts.width)
    return Curves(
        scatter_sizes=np.concatenate([np.zeros_like(scatter[:1]), scatter]),
        confidence=confidence,
        value=middle + value,
        slope=slope,
        spread=np.sqrt((1 / ones)[:, None] / precision + shift[:, None] ** 2 / of_bends),
        # A curve has two parameters, and a constant r has one.
        scatter=math.sqrt(float(np.sum(errors_of_r**2)) / max(n - 1 - has_slope, 1)),
        has_slope=has_slope,
    )


def estimate(curves: Curves) -> Estimate:
    """Return the median and the interval of β."""
    # What is left out changes probabilities by less than 1e-6.
    matters = curves.confidence > 1e-6 / curves.confidence.size
    weights = curves.confidence[matters]
    value = curves.value[matters]
    spread = curves.spread[matters]
    ends = np.min(value - 9 * spread), np.max(value + 9 * spread)
    low, middle, high = (
        optimize.brentq(
            lambda x, p=level: special.ndtr((x - value) / spread) @ weights - p, *ends, xtol=1e-9
        )
        for level in (0.025, 0.5, 0.975)
    )
    return Estimate(middle, low, high, float(np.sum(curves.slope[matters] * weights)))
