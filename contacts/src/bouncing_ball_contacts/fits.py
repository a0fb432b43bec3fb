r"""From a recording to r over the speed, with its interval, and to the contact laws that it allows.

The impacts of a recording have restitution coefficients rᵢ at speeds vᵢ. Their logarithms are::

    ln rᵢ = β + s (e^(q xᵢ) - 1)/q + eᵢ,   xᵢ = ln(vᵢ/v₀)
    cov e = σ² [(1 - φ) M Mᵀ + φ I],       M Mᵀ in units of the median of its diagonal

The exponent q is between -1/2 and 5/4: 0 for an r that is a power of the speed, about 1/5 for a law
of Kuwabara and Kono, 1 for one of Hunt and Crossley, more for r = 1 - c v, and negative for an r
that changes at low speeds only. The slope s has a normal prior of the width 0.25, because measured
slopes lie between 0 and about -0.3; β has none. M says how readings enter: an error of a time
enters the flights on both of its sides. φ is the share of the scatter between impacts in the
variance of ln r, so that scatter has the size σ √φ and errors of readings σ √(1 - φ). Both sizes
have log-normal priors with a factor of 7 either way. That of scatter is about 0.011, the middle of
the published experiments (0.0004 to 0.04); that of errors about what instruments have, 1 ms, 2 mm
or 0.02 m/s. If the errors of the readings are given, σ² (1 - φ) is known.

Few impacts do not tell errors of readings, which hardly change r in the middle, from scatter, which
does. So there are two intervals of 95 %, by the posterior of β: for φ = 0, if impacts do not
scatter, and for all other φ, if they do. The first one is left out if the impacts contradict it or
if both are alike. The impacts contradict it if a test of φ = 0 rejects it at 5 %. Its statistic is
Q(0)/σ², which has the χ² distribution, if the errors are known, and Q(0)/Q(1) otherwise, where Q(φ)
is the sum of squares that a power of the speed leaves.

A law is judged by how much worse it fits than a parabola in ln v, for each φ: by the F
distribution, of whose probabilities the largest one counts among those φ that are at least 1/20 as
likely as the likeliest one, or by the χ² distribution if the errors are known, averaged over φ.
Scatter alone, which the parabola has as well, therefore rejects no law. Without given errors a
systematic error of the measurement does not show in the scatter: a law is then not called
incompatible, but said to deviate.
"""

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, optimize, special
from scipy.optimize import elementwise

from bouncing_ball_contacts.designs import Bounce, Design, Page, Quantity, aligned, design
from bouncing_ball_contacts.engines import Engine
from bouncing_ball_contacts.recordings import Recording, read
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY as G
from bouncing_ball_contacts.units import Refused, positive, show, span

_SLOPE = 0.25
_EXPONENTS = np.array([-0.5, 1e-6, 0.25, 0.5, 0.75, 1.0, 1.25])
# φ: none, and evenly in ln(φ/(1 - φ)), so that sizes of scatter and errors are even in logarithms.
_SHARES = np.concatenate([[0.0], special.expit(np.arange(-6.0, 7.0, 2.0))])
# Usual sizes of scatter in ln r and of errors of readings, and the width of the priors of both in
# their logarithms: a factor of 7 either way.
_SCATTER = 0.011
_USUAL = {"flights": 1e-3, "heights": 2e-3, "drops": 2e-3, "speeds": 0.02, "coefficients": 0.011}
_WIDTH = 2.0
_LEAST, _MOST = 1e-5, 0.5
_LEVEL = 0.95
# What is less likely than this, compared with something else, is left out.
_UNLIKELY = 0.05
# Contacts of balls rarely last longer, in s.
_LONG_CONTACT = 0.01
# Intervals are alike if the narrower one is more than this part of the other one.
_ALIKE = 0.8
REJECTED = 0.005
"""A law with a smaller probability is rejected."""
ACCEPTED = 0.05
# Of air and osmium, in kg/m³, and the drag coefficient of a sphere.
_AIR = 1.2
_DENSEST = 22600.0
_DRAG = 0.47
_FEWEST = 3


@dataclass(frozen=True)
class Impacts:
    """Impacts of a recording.

    ``speed`` is in m/s; ``readings`` is M, the derivative of ln r by the readings (of times in s,
    heights in m, speeds in m/s, or r), and ``usual`` is the usual standard deviation of these.
    """

    speed: Array
    log_r: Array
    readings: Array
    usual: float

    @property
    def restitution(self) -> Array:
        """r of each impact."""
        return np.exp(self.log_r)


def _flight_speeds(duration: Array, drag: float) -> tuple[Array, Array]:
    """Return the speeds at the start and the end of flights, with the drag in 1/m."""
    if not drag:
        return G * duration / 2, G * duration / 2

    def lasts(up: Array) -> Array:
        x = up * math.sqrt(drag / G)
        return (np.arctan(x) + np.arcsinh(x)) / math.sqrt(drag * G)

    bracket = (G * duration / 2, 2 * G * duration)
    up = elementwise.find_root(lambda up, all_: lasts(up) - all_, bracket, args=(duration,)).x
    return up, up / np.sqrt(1 + drag * up**2 / G)


def _height_speeds(height: Array, drag: float) -> tuple[Array, Array]:
    """Return the speeds of a rise to a height, and of the fall from it."""
    if not drag:
        return np.sqrt(2 * G * height), np.sqrt(2 * G * height)
    up = np.sqrt(G / drag * np.expm1(2 * drag * height))
    return up, np.sqrt(-G / drag * np.expm1(-2 * drag * height))


def impacts_of(recording: Recording, drag: float = 0.0) -> Impacts:
    """Return the impacts of a recording; drag is ρ C A/(2 m) in 1/m.

    Raises
    ------
    Refused
        If there is no impact between two flights.
    """
    parts = []
    for chain in recording.chains:
        is_pairs = recording.kind not in ("flights", "heights")
        first, second = chain.T if is_pairs else (chain[:-1], chain[1:])
        down = first
        up = second
        if recording.kind == "flights":
            down = _flight_speeds(first, drag)[1]
            up = _flight_speeds(second, drag)[0]
            # An error of a time enters the flights on both sides of it.
            of_flights = np.diff(np.diag(1 / chain), axis=0)
            matrix = of_flights @ np.diff(np.eye(len(chain) + 1), axis=0)
        elif recording.kind == "coefficients":
            up = first * second
            matrix = np.diag(1 / second)
        elif recording.kind == "speeds":
            matrix = np.diag(np.hypot(1 / first, 1 / second))
        else:
            down = _height_speeds(first, drag)[1]
            up = _height_speeds(second, drag)[0]
            of_pairs = np.diag(0.5 * np.hypot(1 / first, 1 / second))
            matrix = of_pairs if is_pairs else np.diff(np.diag(0.5 / chain), axis=0)
        parts.append((down, np.log(up / down), matrix))
    if not sum(len(down) for down, _, _ in parts):
        raise Refused(f"{recording.name}: no impact lies between two flights: three times or two "
                      "heights are needed")  # fmt: skip
    speeds, logs, blocks = zip(*parts, strict=True)
    readings = linalg.block_diag(*blocks)
    return Impacts(np.concatenate(speeds), np.concatenate(logs), readings, _USUAL[recording.kind])


def without_contacts(recording: Recording, durations: Array) -> Recording:
    """Return the recording with flights from release to touch.

    Raises
    ------
    Refused
        If a contact would last longer than half of the flights, or than two touches are apart.
    """
    chains = tuple(chain - durations[: len(chain)] for chain in recording.chains)
    typical = float(np.mean(durations))
    if any((chain <= 0).any() or typical > np.median(chain) for chain in chains if len(chain)):
        longest = show(float(durations.max()), "s")
        raise Refused(f"contact time: {longest} is longer than flights are: is its unit right?")
    return replace(recording, chains=chains)


@dataclass(frozen=True)
class Curves:
    """The smooth curves of a recording about a speed, by share φ, exponent q and size σ.

    ``shapes`` are the V of covariances σ² V of ln r (share, n, n), ``sizes`` the σ (share, size);
    ``columns`` are those of β and s at the impacts (exponent, 2, n), ``project`` is XᵀV⁻¹,
    ``spread`` the covariance of β and s, ``log_weight`` what the posterior has besides squares.
    ``is_known`` says whether the errors of readings are given.
    """

    is_known: bool
    shapes: Array
    sizes: Array
    columns: Array
    project: Array
    spread: Array
    log_weight: Array

    def posterior(self, y: Array) -> tuple[Array, Array, Array]:
        """Return weights of sum 1, β and s for ln r of a recording."""
        normal = self.project @ y
        squares = y @ np.linalg.solve(self.shapes, y[:, None])[..., 0].T
        variance = self.sizes[:, None, :] ** 2
        best = (self.spread @ normal[:, :, None, :, None])[..., 0] / variance[..., None]
        explained = np.sum(best * normal[:, :, None], axis=-1)
        logs = self.log_weight - (squares[:, None, None] - explained) / (2 * variance)
        weights = np.exp(logs - logs.max())
        return weights / weights.sum(), best[..., 0], best[..., 1]


def curves_of(impacts: Impacts, known: float | Array | None, at: float) -> Curves:
    """Return the smooth curves about a speed in m/s.

    ``known`` is the standard deviation of the readings, or that of each r; None if it is not known.
    """

    def log_prior(size: Array) -> Array:
        return -0.5 * (np.log(size) / _WIDTH) ** 2

    n = len(impacts.log_r)
    of_readings = impacts.readings @ impacts.readings.T
    if isinstance(known, np.ndarray):
        of_readings = np.diag((known / impacts.restitution) ** 2)
    unit = float(np.median(np.diag(of_readings)))
    share = _SHARES[:, None, None]
    # Contributions below 10⁻⁴ of σ keep the covariances regular.
    shapes = (1 - share) * of_readings / unit + (share + 1e-9) * np.eye(n)
    still = np.sqrt(1 - _SHARES)[:, None]
    if known is None:
        # ln σ is known to about 1/√(2n), which the grid resolves.
        size = np.geomspace(_LEAST, _MOST, 28 + (n if n > 11 else 0))
        sizes = np.tile(size, (len(_SHARES), 1))
        logs = log_prior(sizes * still / (impacts.usual * math.sqrt(unit)))
    else:
        sizes = (1.0 if isinstance(known, np.ndarray) else known) * math.sqrt(unit) / still
        logs = np.zeros_like(sizes)
    logs[1:] += log_prior(sizes[1:] * np.sqrt(_SHARES[1:])[:, None] / _SCATTER)
    logs -= 0.5 * np.linalg.slogdet(shapes)[1][:, None] + n * np.log(sizes)
    q = _EXPONENTS[:, None]
    columns = np.stack([np.ones((len(q), n)), np.expm1(q * np.log(impacts.speed / at)) / q], axis=1)
    project = columns @ np.linalg.inv(shapes)[:, None]
    information = project @ np.swapaxes(columns, 1, 2)
    prior = np.diag([0.0, _SLOPE**-2])
    precision = information[:, :, None] / sizes[:, None, :, None, None] ** 2 + prior
    return Curves(
        is_known=known is not None,
        shapes=shapes,
        sizes=sizes,
        columns=columns,
        project=project,
        spread=np.linalg.inv(precision),
        log_weight=logs[:, None] - 0.5 * np.linalg.slogdet(precision)[1],
    )


@dataclass(frozen=True)
class Estimate:
    """The mean of β, the ends of its interval of 95 %, and the mean of s."""

    value: float
    low: float
    high: float
    slope: float


def _estimate(curves: Curves, y: Array, possible: NDArray[np.bool_]) -> Estimate:
    """Return what a recording says if only these shares are possible."""
    middle = float(np.mean(y))
    weights, beta, slope = curves.posterior(y - middle)
    weights = weights * possible[:, None, None]
    weights = weights / weights.sum()
    deviation = np.sqrt(curves.spread[..., 0, 0])
    centre = float(np.sum(weights * beta))
    spread = math.sqrt(float(np.sum(weights * (deviation**2 + (beta - centre) ** 2))))

    def below(at: float) -> float:
        """Return the probability that β is less."""
        return float(np.sum(weights * special.ndtr((at - beta) / deviation)))

    # Less than 1/49 of any distribution is further from its mean than seven deviations.
    bracket = centre - 7 * spread, centre + 7 * spread
    low = optimize.brentq(lambda at: below(at) - (1 - _LEVEL) / 2, *bracket) + middle
    high = optimize.brentq(lambda at: below(at) - (1 + _LEVEL) / 2, *bracket) + middle
    return Estimate(centre + middle, low, high, float(np.sum(weights * slope)))


def without_scatter(impacts: Impacts, curves: Curves) -> float:
    """Return the probability of deviations that are at least as unlikely if impacts do not scatter.

    The deviations are those from a power of the speed. A ratio of two squares is larger than the
    measured one if a sum of squares of normal numbers with certain factors is positive: the
    integral for that is of J. P. Imhof, Biometrika 48 (1961) 419.
    """
    x = np.log(impacts.speed)
    contrasts = linalg.null_space(np.stack([np.ones_like(x), x - x.mean()]))
    z = contrasts.T @ impacts.log_r
    if not len(z):
        return 1.0
    still = contrasts.T @ curves.shapes[0] @ contrasts
    squares = float(z @ np.linalg.solve(still, z))
    if curves.is_known:
        return float(special.chdtrc(len(z), squares / curves.sizes[0, 0] ** 2))
    scattered = float(z @ z)
    if scattered < 1e-20:
        # A power of the speed but for rounding errors.
        return 1.0
    factors = 1 - squares / scattered * np.linalg.eigvalsh(still)
    if np.abs(factors).max() < 1e-6:
        # Errors of readings are like scatter.
        return 1.0
    steps = np.arange(-30.0, 60.0, 0.05)
    by_step = factors / np.abs(factors).max() * np.exp(steps)[:, None]
    swing = np.sin(np.arctan(by_step).sum(axis=1) / 2)
    damped = np.exp(-np.log1p(by_step**2).sum(axis=1) / 4)
    return 0.5 + float(np.trapezoid(swing * damped, steps)) / math.pi


def estimates(impacts: Impacts, curves: Curves) -> tuple[Estimate, Estimate | None]:
    """Return what a recording says if impacts scatter, and if they do not.

    The second one is None if the impacts contradict it, or if it says the same.
    """
    scattering = _estimate(curves, impacts.log_r, _SHARES > 0)
    if without_scatter(impacts, curves) < _UNLIKELY:
        return scattering, None
    still = _estimate(curves, impacts.log_r, _SHARES == 0)
    is_alike = still.high - still.low > _ALIKE * (scattering.high - scattering.low)
    return scattering, None if is_alike or still.low > 0 else still


def scatter_of(impacts: Impacts, curves: Curves) -> float:
    """Return the root mean square of the errors of r about the likeliest smooth curve."""
    weights, beta, slope = curves.posterior(impacts.log_r - np.mean(impacts.log_r))
    best = np.unravel_index(int(np.argmax(weights)), weights.shape)
    level, steep = curves.columns[best[1]]
    curve = np.mean(impacts.log_r) + beta[best] * level + slope[best] * steep
    errors = impacts.restitution - np.exp(curve)
    # The curve takes two of the degrees of freedom.
    return float(np.sqrt(np.sum(errors**2) / max(len(errors) - 2, 1)))


@dataclass(frozen=True)
class ContactLaw:
    """A contact that pushes with K (p^n + A p^m p′), and never pulls.

    In the units L = (M v²/K)^(1/(n + 1)) and L/v the ball arrives with the speed 1, and only the
    damping x = A v L^(m - n) is left, which goes as v to the power of ``speed``.
    """

    n: float
    m: float
    most: float

    @property
    def speed(self) -> float:
        """The power of the speed with which the damping x goes."""
        return 1 + 2 * (self.m - self.n) / (self.n + 1)

    def log_r(self, a: float, v: Array) -> Array:
        """Return ln r at speeds in m/s if x = a v^speed."""
        x, log_r, _ = _impacts_of_law(self)
        return np.interp(a * v**self.speed, x, log_r)

    def duration(self, a: float, v: Array) -> Array:
        """Return the contact time at speeds in m/s, over L/v."""
        x, _, duration = _impacts_of_law(self)
        return np.interp(a * v**self.speed, x, duration)

    def damping(self, restitution: float) -> float:
        """Return the x with a restitution coefficient."""
        x, log_r, _ = _impacts_of_law(self)
        return float(np.interp(-math.log(restitution), -log_r, x))


@functools.cache
def _impacts_of_law(law: ContactLaw) -> tuple[Array, Array, Array]:
    """Return x, ln r and the contact time over L/v of p″ = -(p^n + x p^m p′)₊, p′ = 1 at first."""
    x = np.concatenate([[0.0], np.geomspace(1e-3, law.most, 200)])
    h = 0.005
    p = np.zeros_like(x)
    v = np.ones_like(x)
    duration = np.zeros_like(x)

    def push(p: Array, v: Array) -> Array:
        depth = np.maximum(p, 0.0)
        return np.maximum(depth**law.n + x * depth**law.m * v, 0.0)

    # The midpoint rule; a contact without damping lasts 3.2.
    for _ in range(1100):
        middle = p + h / 2 * v
        half = v - h / 2 * push(p, v)
        change = push(middle, half)
        v = v - h * change
        p = p + h * half
        duration += np.where(change > 0, h, 0.0)
    # Without damping r is 1 but for the error of the rule.
    return x, np.log(-v) - math.log(-v[0]), duration


_LINEAR = ContactLaw(1.0, 0.0, 20.0)
_TSUJI = ContactLaw(1.5, 0.25, 20.0)
LAWS = {
    "constant r (linear; Hertz with Tsuji)": _LINEAR,
    "Hertz with Kuwabara and Kono": ContactLaw(1.5, 0.5, 2.9),
    "Hunt and Crossley": ContactLaw(1.0, 1.0, 50.0),
}
"""Laws with one parameter a; a linear contact stands for all with a constant r."""
_TIMED = {"linear": _LINEAR, "Hertz with Tsuji": _TSUJI} | dict(list(LAWS.items())[1:])


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
    verdict: str


def _least_squares(law: ContactLaw, v: Array, y: Array, root: Array) -> float:
    """Return the parameter of a law with the least squares, by a search in ln a."""
    whiten = np.linalg.inv(root)

    def miss(log_a: float) -> float:
        return float(np.sum((whiten @ (y - law.log_r(math.exp(log_a), v))) ** 2))

    most = law.most / float(v.max()) ** law.speed
    grid = np.linspace(math.log(1e-5), math.log(most), 60)
    i = int(np.argmin([miss(each) for each in grid]))
    around = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
    found = optimize.minimize_scalar(miss, bounds=around, method="bounded", options={"xatol": 1e-7})
    return math.exp(found.x)


def judge(impacts: Impacts, curves: Curves, at: float) -> list[Judged]:
    """Return the laws with their verdicts, that of the smallest errors first."""
    v = impacts.speed
    y = impacts.log_r
    n = len(y)
    powers = np.vander(np.log(v) - np.mean(np.log(v)), 3, increasing=True)
    posterior, _, _ = curves.posterior(y - np.mean(y))
    likelihood = posterior.sum(axis=1)
    share, size = np.unravel_index(int(np.argmax(likelihood)), likelihood.shape)
    values = len(np.unique(np.round(np.log(v), 3)))
    shape = powers[:, : min(3, values, n - 1)]
    further = shape.shape[1] - 1
    likely = curves.shapes[share] * curves.sizes[share, size] ** 2
    root = np.linalg.cholesky(likely)
    of_share = likelihood.sum(axis=1) * (_SHARES > 0)
    # An r without any deviation leaves rounding errors.
    smooth = np.maximum(_rest(curves.shapes, shape, y), 1e-20)
    left = n - shape.shape[1]
    judged = []
    for name, law in LAWS.items():
        a = _least_squares(law, v, y, root)
        fitted = law.log_r(a, v)
        slope = (law.log_r(a * 1.001, v) - law.log_r(a * 0.999, v)) / (0.002 * a)
        misfit = y - fitted
        worse = np.maximum(_rest(curves.shapes, slope[:, None], misfit) - smooth, 0.0)
        probability = math.nan
        if further and curves.is_known:
            chances = special.chdtrc(further, worse / curves.sizes[:, 0] ** 2)
            probability = float(of_share @ chances / of_share.sum())
        elif further and left:
            chances = special.fdtrc(further, left, worse / further / (smooth / left))
            probability = float(chances[of_share > _UNLIKELY * of_share.max()].max())
        errors = impacts.restitution - np.exp(fitted)
        weighted = np.linalg.solve(likely, slope)
        hat = slope * weighted / (slope @ weighted)
        apart = errors / np.maximum(1 - hat, 1e-9)
        excess = _rest(np.eye(n)[None], slope[:, None], misfit) - _rest(np.eye(n)[None], shape, y)
        bound = special.chdtri(further, REJECTED) if further else math.nan
        judged.append(
            Judged(
                law=name,
                parameter=a,
                restitution=float(np.exp(law.log_r(a, np.asarray(at)))),
                rms=float(np.sqrt(np.mean(errors**2))),
                left_out=float(np.sqrt(np.mean(apart**2))),
                needed=float(np.mean(impacts.restitution) * math.sqrt(max(excess[0], 0.0) / bound)),
                probability=probability,
                verdict="",
            )
        )
    some_rejected = any(each.probability < REJECTED for each in judged)
    with_words = (
        replace(each, verdict=_verdict(each.probability, some_rejected, curves.is_known))
        for each in judged
    )
    return sorted(with_words, key=lambda each: each.rms)


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
    laws: list[Judged],
    at: float,
    restitution: float,
    mass: float,
) -> list[Timed]:
    """Return the laws whose contacts last as long as measured ones, one time or one per impact."""
    v = impacts.speed if len(durations) == len(impacts.speed) else np.array([at])
    parameters = {LAWS[each.law]: each.parameter for each in laws}
    found = []
    for name, law in _TIMED.items():
        # A constant r is known without a fit.
        a = law.damping(restitution) if law.speed == 0 else parameters.get(law)
        if a is None:
            continue
        power = 1 / (law.n + 1)
        # T = D(x) L/v with L = (M v²/K)^(1/(n + 1)).
        lasting = np.log(law.duration(a, v)) + (2 * power - 1) * np.log(v)
        scale = float(np.mean(np.log(durations) - lasting))
        errors = np.expm1(np.log(durations) - lasting - scale)
        length = math.exp(scale) * at ** (2 * power)
        found.append(
            Timed(
                law=name,
                duration=float(law.duration(a, np.asarray(at))) * length / at,
                rms=float(np.sqrt(np.mean(errors**2))) if len(v) > 1 else math.nan,
                stiffness=mass * math.exp(-scale / power),
                damping=a * at ** (law.speed - 1) * length ** (law.n - law.m),
                unit="N/m" if law.n == 1 else "N/m^1.5",
            )
        )
    return found


def _rest(covariances: Array, columns: Array, y: Array) -> Array:
    """Return the weighted squares that are left by generalized least squares."""
    roots = np.linalg.cholesky(covariances)
    both = np.column_stack([columns, y])
    white = np.linalg.solve(roots, np.broadcast_to(both, (len(roots), *both.shape)))
    x = white[:, :, :-1]
    z = white[:, :, -1]
    best = np.linalg.solve(np.swapaxes(x, 1, 2) @ x, (np.swapaxes(x, 1, 2) @ z[..., None]))
    return np.sum((z - (x @ best)[..., 0]) ** 2, axis=1)


def _verdict(probability: float, some_rejected: bool, is_known: bool) -> str:
    if probability < REJECTED:
        return "incompatible" if is_known else "deviates"
    if probability > ACCEPTED and some_rejected:
        return "compatible"
    return "undecided"


@dataclass(frozen=True, repr=False)
class Fit(Page):
    """r at a speed with its 95 % interval, the laws, and what else is known of the recording.

    ``without_scatter`` is the interval if impacts do not scatter; None if it is the same, or if the
    impacts contradict it. ``scatter`` is the root mean square of the deviations of single impacts.
    """

    recording: Recording
    impacts: Impacts
    speed: float
    restitution: float
    interval: tuple[float, float]
    without_scatter: tuple[float, float] | None
    scatter: float
    slope: float
    laws: tuple[Judged, ...]
    times: tuple[Timed, ...]
    mass: float | None
    diameter: float | None
    notes: tuple[str, ...]

    @property
    def table(self) -> list[list[str]]:
        """The cells of the table of laws, the headings first."""
        head = ["law", f"r at {self.speed:.3g} m/s", "rms", "left out", "errors needed", "verdict"]
        rows = [
            [
                each.law,
                f"{each.restitution:.4f}",
                f"{each.rms:.4f}",
                f"{each.left_out:.4f}",
                f"{each.needed:.4f}" if math.isfinite(each.needed) else "–",
                each.verdict,
            ]
            for each in self.laws
        ]
        return [head, *rows]

    @property
    def lines(self) -> list[str]:
        """The answer, line by line."""
        v = self.impacts.speed
        title = self.recording.head.get("title", self.recording.name)
        speeds = span(v.min(), v.max(), form="g")
        interval = span(*self.interval, 4)
        if self.without_scatter is not None:
            still = span(*self.without_scatter, 4)
            interval += f" if impacts scatter, {still} if they do not"
        return [
            f"{title}: {len(v)} impacts at {speeds} m/s, from {self.recording.kind}",
            f"r = {self.restitution:.4f} at {self.speed:.3g} m/s, 95 %: {interval}",
            f"r goes as v^{self.slope:+.3f}; single impacts deviate from it by {self.scatter:.4f}",
            *(["", *aligned(self.table)] if self.laws else []),
            *self.timed,
            *(f"! {note}" for note in self.notes),
        ]

    @property
    def timed(self) -> list[str]:
        """The lines of the laws by their contact times, if there are some."""
        if not self.times:
            return []
        per = "" if self.mass else "/kg"
        head = ["law", f"contact time at {self.speed:.3g} m/s", "rms", "stiffness", "damping"]
        rows = [
            [
                each.law,
                show(each.duration, "s", 4),
                f"{100 * each.rms:.1f} %" if math.isfinite(each.rms) else "–",
                show(each.stiffness, each.unit, 4) + per,
                f"{each.damping:.4g}",
            ]
            for each in self.times
        ]
        return ["", *aligned([head, *rows])]

    @property
    def intervals(self) -> list[str]:
        """The lines of single impacts: r, the plain ratio of the flights, and the drag's part."""
        plain = np.exp(impacts_of(self.recording).log_r)
        r = self.impacts.restitution
        rows = [
            [f"{v:.5g}", f"{each:.5f}", f"{ratio:.5f}", f"{ratio - each:+.5f}"]
            for v, each, ratio in zip(self.impacts.speed, r, plain, strict=True)
        ]
        return aligned([["v in m/s", "r", "ratio", "by drag"], *rows])

    def __repr__(self) -> str:
        return "\n".join(self.lines[:3])

    def __str__(self) -> str:
        return "\n".join(self.lines)

    def bounce(self, mass: Quantity = None, **more: Any) -> Bounce:
        """Return the bounce at this speed, with the contact time of the recording if it has one.

        That of a bounce is the one of a linear contact without damping.
        """
        body = self.mass if mass is None else mass
        if body is None:
            raise Refused("the mass is missing: the recording does not say it, give --mass '46 g'")
        given = {"penetration", "stiffness", "contact_time"} & {
            name for name, value in more.items() if value is not None
        }
        if self.times and not given:
            x = _LINEAR.damping(self.restitution)
            lasts = float(_LINEAR.duration(x, np.asarray(self.speed)))
            more["contact_time"] = self.times[0].duration * math.pi / lasts
        if self.diameter is not None and more.get("radius") is more.get("density") is None:
            more["radius"] = self.diameter / 2
        return Bounce(mass=body, restitution=self.restitution, speed=self.speed, **more)

    def design(
        self, engine: str | Engine = "generic", time_step: Quantity = None, **more: Any
    ) -> Design:
        """Return the design of an engine for this bounce; ``more`` belongs to the bounce."""
        return design(self.bounce(**more), engine, time_step)


def _of_logs(estimate: Estimate) -> tuple[float, float]:
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
        Of the ball, with which the drag of the air is removed from flights and heights.
    contact_time : Quantity, optional
        A measured one, in place of those of the recording: it gives the laws their stiffness, and
        is taken off times between impacts, which are from touch to touch.
    leave_out : tuple of int
        Lines of the file.
    intervals : bool
        Whether a file with times and intervals is read by its intervals.

    Raises
    ------
    Refused
        If the recording cannot be read, no impact lies between two flights, or r is above 1.
    """
    recording = source if isinstance(source, Recording) else read(source, leave_out, intervals)
    head = recording.head
    notes = list(recording.notes)

    def known_of(name: str, given: Quantity, unit: str) -> float | None:
        """Return what is given, or else what the head of the recording says."""
        value = head.get(name) if given is None else given
        return None if value is None else positive(name, value, unit)

    kilograms = known_of("mass", mass, "kg")
    wide = known_of("diameter", diameter, "m")
    drag = 0.0
    if kilograms is not None and wide is not None:
        density = 6 * kilograms / (math.pi * wide**3)
        if not _AIR < density < _DENSEST:
            raise Refused(
                f"a ball of {show(kilograms, 'kg')} with a diameter of {show(wide, 'm')} has "
                f"a density of {density:.3g} kg/m³: is a unit missing, as in '46 g' and '43 mm'?"
            )
    if recording.kind in ("flights", "heights", "drops"):
        if kilograms is not None and wide is not None:
            drag = _AIR * _DRAG * math.pi * wide**2 / 8 / kilograms
            notes.append(f"the drag of the air is removed, {drag:.2g} of the speed per metre")
        else:
            notes.append("the drag of the air is not removed: give the mass and the diameter")
    durations = recording.durations
    if contact_time is not None:
        durations = np.array([positive("contact time", contact_time, "s")])
    if recording.kind == "flights" and durations is not None:
        recording = without_contacts(recording, durations)
        # The first and the last touch are no impacts between two flights.
        durations = durations[1:-1] if len(durations) > 2 else durations
        lasts = show(float(durations.mean()), "s")
        notes.append(f"the contact, {lasts}, is taken off each time between two impacts")
    impacts = impacts_of(recording, drag)
    n = len(impacts.log_r)
    middle = math.exp(float(np.mean(np.log(impacts.speed))))
    at = middle if speed is None else positive("speed", speed, "m/s")
    unit = {"flights": "s", "heights": "m", "drops": "m", "speeds": "m/s", "coefficients": ""}
    stated = known_of("resolution", resolution, unit[recording.kind])
    known = recording.uncertainty if stated is None else stated
    curves = curves_of(impacts, known, at)
    scattering, still = estimates(impacts, curves)
    above = f"r = {math.exp(scattering.value):.4f} is above 1"
    if scattering.low > 0:
        raise Refused(f"{recording.name}: {above} by more than its error: no ball bounces so")
    restitution = min(math.exp(scattering.value), 1.0)
    if recording.kind == "flights" and durations is None:
        tried = 0.01 * min(float(chain.min(initial=1.0)) for chain in recording.chains)
        shorter = impacts_of(without_contacts(recording, np.array([tried])), drag)
        low, high = _of_logs(still or scattering)
        falls = restitution * float(np.mean(impacts.log_r - shorter.log_r)) / tried
        if falls * _LONG_CONTACT > (high - low) / 2:
            notes.append(
                f"times between impacts include the contact: r is lower by {falls / 1000:.1g} for "
                f"each ms that it lasts, which matters from {show((high - low) / 2 / falls, 's')} "
                "on; give --contact-time"
            )
    laws = judge(impacts, curves, at) if n >= _FEWEST else []
    is_near = 0.9 * impacts.speed.min() <= at <= 1.1 * impacts.speed.max()
    fits = [each for each in laws if not each.probability < REJECTED]
    further = {
        "too few impacts for an interval of their own: it is wide": n < _FEWEST,
        f"{above} within its error: 1 is taken": scattering.value > 0,
        f"{at:.3g} m/s is outside of the measured speeds": not is_near,
        "no errors are given: a law can only be said to deviate": known is None,
        "no law fits: r is that of a smooth curve": bool(laws) and not fits,
    }
    notes += [text for text, holds in further.items() if holds]
    times: list[Timed] = []
    if durations is not None:
        times = by_contact_time(impacts, durations, laws, at, restitution, kilograms or 1.0)
    return Fit(
        recording=recording,
        impacts=impacts,
        speed=at,
        restitution=restitution,
        interval=_of_logs(scattering),
        without_scatter=None if still is None else _of_logs(still),
        scatter=scatter_of(impacts, curves),
        slope=scattering.slope,
        laws=tuple(laws),
        times=tuple(times),
        mass=kilograms,
        diameter=wide,
        notes=tuple(notes),
    )
