r"""From a recording to r over the speed, with its interval, and to the contact laws that it allows.

The impacts of a recording have restitution coefficients rᵢ at speeds vᵢ. Their logarithms are

    ln rᵢ = β₀ + β₁ x + β₂ x²/2 + τ εᵢ + σ (M η)ᵢ,   x = ln(v/v₀)

where τ is the scatter between impacts, σ the error of a reading (a time, a height, a speed), and M
says how readings enter: an error of a time enters the flights on both of its sides. The slope and
the curvature are those of a smooth curve. Measured laws have slopes between 0 and about -0.3, so
that β₁ and β₂ have normal priors of the width 0.25 about 0; β₀ has none. The logarithm of σ is
uniform on a grid; τ is 0 with a prior weight of a half (a tenth if σ is stated), and otherwise has
a weight as √τ on such a grid. For each τ and σ, β is normal (generalized least squares), so that
ln r at a speed is a mixture of normal distributions over the grid, whose quantiles are the ends of
the 95 % interval.

A law is judged by how much worse it fits than the smooth curve without priors, for each τ and σ by
the χ² distribution of the difference, averaged over the grid. Scatter alone, which both have,
therefore rejects no law. Without given errors a systematic error of the measurement does not show
in the scatter: a law is then not called incompatible, but said to deviate.
"""

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special

from bouncing_ball_contacts.designs import Bounce, Design, Quantity, aligned, design
from bouncing_ball_contacts.recordings import Recording, read
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, positive, show

G = STANDARD_GRAVITY
_SLOPE = 0.25
_CURVATURE = 0.25
# τ, of ln r, of which 0 stands for none, and σ, in units in which a reading changes ln r by 1 at
# the median impact.
_SCATTERS = np.array([0.0, *np.geomspace(3e-4, 0.06, 16)])
_ERRORS = np.array([0.0, *np.geomspace(1e-4, 0.3, 19)])
# Prior weights of no scatter at all, for unknown and for stated errors of the readings. Unknown
# errors explain the same deviations as a scatter does, and both explanations have the same weight;
# beside stated errors the deviations themselves show a scatter. Chosen by simulated recordings of
# seven impacts, so that intervals neither miss a scatter nor assume one that is not there.
_NO_SCATTER = 0.5
_NO_SCATTER_STATED = 0.1
_LEVEL = 0.95
REJECTED = 0.005
"""A law with a smaller probability is rejected."""
ACCEPTED = 0.05
# Of air, in kg/m³, and the drag coefficient of a sphere.
_AIR = 1.2
_DRAG = 0.47
_FEWEST = 3


@dataclass(frozen=True)
class Impacts:
    """Impacts of a recording.

    ``speed`` is in m/s; ``readings`` is M, the derivative of ln r by the readings (of times in s,
    heights in m, speeds in m/s, or r).
    """

    speed: Array
    log_r: Array
    readings: Array

    @property
    def restitution(self) -> Array:
        """r of each impact."""
        return np.exp(self.log_r)


def _flight_speeds(duration: Array, drag: float) -> tuple[Array, Array]:
    """Return the speeds at the start and the end of flights, with the drag in 1/m."""
    if not drag:
        return G * duration / 2, G * duration / 2
    low = G * duration / 2
    high = 4 * G * duration / 2
    for _ in range(50):
        up = (low + high) / 2
        fall = np.arccosh(np.sqrt(1 + drag * up**2 / G))
        takes = (np.arctan(up * math.sqrt(drag / G)) + fall) / math.sqrt(drag * G)
        low = np.where(takes < duration, up, low)
        high = np.where(takes < duration, high, up)
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
    speeds = []
    logs = []
    blocks = []
    for chain in recording.chains:
        if recording.kind in ("flights", "heights"):
            if len(chain) < 2:
                continue
            if recording.kind == "flights":
                up, down = _flight_speeds(chain, drag)
                # An error of a time enters the flights on both sides of it.
                of_flights = np.diff(np.diag(1 / chain), axis=0)
                matrix = of_flights @ np.diff(np.eye(len(chain) + 1), axis=0)
            else:
                up, down = _height_speeds(chain, drag)
                matrix = np.diff(np.diag(0.5 / chain), axis=0)
            speeds.append(down[:-1])
            logs.append(np.log(up[1:] / down[:-1]))
            blocks.append(matrix)
            continue
        first, second = chain.T
        if recording.kind == "drops":
            down = _height_speeds(first, drag)[1]
            up = _height_speeds(second, drag)[0]
            matrix = np.diag(0.5 * np.hypot(1 / first, 1 / second))
        elif recording.kind == "speeds":
            down = first
            up = second
            matrix = np.diag(np.hypot(1 / first, 1 / second))
        else:
            down = first
            up = first * second
            matrix = np.diag(1 / second)
        speeds.append(down)
        logs.append(np.log(up / down))
        blocks.append(matrix)
    if not speeds:
        raise Refused(f"{recording.name}: no impact lies between two flights: three times or two "
                      "heights are needed")  # fmt: skip
    return Impacts(np.concatenate(speeds), np.concatenate(logs), _block_diagonal(blocks))


def _block_diagonal(blocks: list[Array]) -> Array:
    found = np.zeros((sum(len(each) for each in blocks), sum(each.shape[1] for each in blocks)))
    row = 0
    column = 0
    for each in blocks:
        found[row : row + len(each), column : column + each.shape[1]] = each
        row += len(each)
        column += each.shape[1]
    return found


@dataclass(frozen=True)
class Posterior:
    """The grid of errors: covariances of ln r, and their weights."""

    covariances: Array
    weights: Array


def _powers(impacts: Impacts, at: float) -> Array:
    """Return the columns 1, x and x²/2."""
    x = np.log(impacts.speed / at)
    return np.column_stack([np.ones_like(x), x, x**2 / 2])


def posterior(impacts: Impacts, known: float | Array | None) -> Posterior:
    """Return the grid of covariances with its weights.

    ``known`` is the standard deviation of the readings, or that of each r; None if it is not known.
    """
    n = len(impacts.log_r)
    unit = np.eye(n)
    if known is None:
        of_readings = impacts.readings @ impacts.readings.T
        of_readings = of_readings / np.median(np.diag(of_readings))
        sigmas = _ERRORS
    elif np.ndim(known):
        of_readings = np.diag((np.asarray(known) / impacts.restitution) ** 2)
        sigmas = np.ones(1)
    else:
        of_readings = impacts.readings @ impacts.readings.T
        sigmas = np.array([float(known)])
    scatter, sigma = (each.ravel() for each in np.meshgrid(_SCATTERS, sigmas))
    has_errors = (scatter > 0) | (sigma > 0)
    scatter = scatter[has_errors]
    sigma = sigma[has_errors]
    covariances = scatter[:, None, None] ** 2 * unit + sigma[:, None, None] ** 2 * of_readings
    # Rounding errors of a covariance that is nearly singular stay below a millionth of r.
    covariances = covariances + 1e-12 * unit
    middle = math.exp(float(np.mean(np.log(impacts.speed))))
    powers = _powers(impacts, middle)
    prior = powers[:, 1:] @ np.diag([_SLOPE**2, _CURVATURE**2]) @ powers[:, 1:].T
    logs = _log_likelihood(impacts.log_r, covariances + prior)
    none = _NO_SCATTER if known is None else _NO_SCATTER_STATED
    some = np.sqrt(_SCATTERS[1:])
    prior_weights = np.array([none, *((1 - none) * some / some.sum())])
    logs = logs + np.log(np.interp(scatter, _SCATTERS, prior_weights))
    weights = np.exp(logs - logs.max())
    return Posterior(covariances, weights / weights.sum())


def _log_likelihood(y: Array, covariances: Array) -> Array:
    """Return the logarithm of the likelihood of y, a constant with a flat prior plus errors."""
    roots = np.linalg.cholesky(covariances)
    both = np.column_stack([np.ones_like(y), y])
    white = np.linalg.solve(roots, np.broadcast_to(both, (len(roots), *both.shape)))
    ones = white[:, :, 0]
    values = white[:, :, 1]
    weight = np.sum(ones**2, axis=1)
    rest = np.sum(values**2, axis=1) - np.sum(ones * values, axis=1) ** 2 / weight
    logs = np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1)
    return -0.5 * rest - logs - 0.5 * np.log(weight)


def predicted(impacts: Impacts, found: Posterior, at: float) -> tuple[Array, Array]:
    """Return mean and standard deviation of ln r at a speed, for each covariance."""
    powers = _powers(impacts, at)
    inverse = np.linalg.inv(found.covariances)
    information = powers.T @ inverse @ powers + np.diag([0, _SLOPE**-2, _CURVATURE**-2])
    spread = np.linalg.inv(information)
    best = (spread @ (powers.T @ inverse @ impacts.log_r)[..., None])[..., 0]
    return best[:, 0], np.sqrt(spread[:, 0, 0])


def scatter_of(impacts: Impacts, found: Posterior) -> float:
    """Return the root mean square of the errors of r about the likeliest smooth curve."""
    n = len(impacts.log_r)
    powers = _powers(impacts, math.exp(float(np.mean(np.log(impacts.speed)))))
    inverse = np.linalg.inv(found.covariances[int(np.argmax(found.weights))])
    information = powers.T @ inverse @ powers + np.diag([0, _SLOPE**-2, _CURVATURE**-2])
    best = np.linalg.solve(information, powers.T @ inverse @ impacts.log_r)
    errors = impacts.restitution - np.exp(powers @ best)
    # A straight line takes two of the degrees of freedom.
    return float(np.sqrt(np.sum(errors**2) / max(n - 2, 1)))


def quantile(probability: float, means: Array, deviations: Array, weights: Array) -> float:
    """Return a quantile of a mixture of normal distributions, by bisection."""
    low = float(np.min(means - 12 * deviations))
    high = float(np.max(means + 12 * deviations))
    for _ in range(60):
        middle = (low + high) / 2
        if weights @ special.ndtr((middle - means) / deviations) < probability:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _constant(a: float, v: Array) -> Array:
    return np.full(np.shape(v), -a)


@functools.cache
def _viscoelastic() -> tuple[Array, Array]:
    """Return ln r of p″ = -(p^(3/2) + A √p p′)₊ with p′ = 1 at first, over A."""
    a = np.concatenate([[0.0], np.geomspace(1e-3, 3, 400)])
    h = 0.005
    p = np.zeros_like(a)
    v = np.ones_like(a)

    def push(p: Array, v: Array) -> Array:
        root = np.sqrt(np.maximum(p, 0.0))
        return np.maximum(root * p + a * root * v, 0.0)

    # The midpoint rule; a contact without damping lasts 3.2.
    for _ in range(1100):
        middle = p + h / 2 * v
        half = v - h / 2 * push(p, v)
        v = v - h * push(middle, half)
        p = p + h * half
    # Without damping r is 1 but for the error of the rule.
    return a, np.log(-v) - math.log(-v[0])


def _kuwabara_kono(a: float, v: Array) -> Array:
    table, log_r = _viscoelastic()
    return np.interp(a * v**0.2, table, log_r)


@functools.cache
def _hunt_and_crossley() -> tuple[Array, Array]:
    """Return ln r over x, by bisection of x (1 + r) = ln((1 + x)/(1 - x r))."""
    x = np.concatenate([[0.0], np.geomspace(1e-6, 1e3, 3000)])
    low = np.zeros_like(x)
    high = np.minimum(1.0, (1 - 1e-12) / np.maximum(x, 1e-12))
    for _ in range(50):
        r = (low + high) / 2
        above = x * (1 + r) < np.log1p(x) - np.log1p(-x * r)
        low = np.where(above, low, r)
        high = np.where(above, r, high)
    # Below, rounding errors are larger than the next term of ln r = -2x/3.
    return x, np.where(x < 1e-3, -2 * x / 3, np.log(r))


def _hunt_crossley(a: float, v: Array) -> Array:
    table, log_r = _hunt_and_crossley()
    return np.interp(a * v, table, log_r)


LAWS: dict[str, tuple[Callable[[float, Array], Array], float]] = {
    "constant r (linear; Hertz with Tsuji)": (_constant, 5.0),
    "Hertz with Kuwabara and Kono": (_kuwabara_kono, 2.9),
    "Hunt and Crossley": (_hunt_crossley, 50.0),
}
"""Laws with one parameter a: ln r of a and the speed, and the largest a for 1 m/s."""


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


def _least_squares(law: Callable[[float, Array], Array], most: float, v: Array, y: Array,
                   root: Array) -> float:  # fmt: skip
    """Return the parameter of a law with the least squares, by a golden section in ln a."""
    whiten = np.linalg.inv(root)

    def miss(log_a: float) -> float:
        return float(np.sum((whiten @ (y - law(math.exp(log_a), v))) ** 2))

    grid = np.linspace(math.log(1e-5), math.log(most), 60)
    i = int(np.argmin([miss(each) for each in grid]))
    low = grid[max(i - 1, 0)]
    high = grid[min(i + 1, len(grid) - 1)]
    share = (math.sqrt(5) - 1) / 2
    for _ in range(40):
        one = high - share * (high - low)
        two = low + share * (high - low)
        if miss(one) < miss(two):
            high = two
        else:
            low = one
    return math.exp((low + high) / 2)


def judge(impacts: Impacts, found: Posterior, at: float, is_known: bool) -> list[Judged]:
    """Return the laws with their verdicts, that of the smallest errors first."""
    v = impacts.speed
    y = impacts.log_r
    n = len(y)
    powers = _powers(impacts, math.exp(float(np.mean(np.log(v)))))
    values = len(np.unique(np.round(np.log(v), 3)))
    shape = powers[:, : min(3, values, n - 1)]
    further = shape.shape[1] - 1
    likely = found.covariances[int(np.argmax(found.weights))]
    root = np.linalg.cholesky(likely)
    heavy = found.weights > 1e-4
    covariances = found.covariances[heavy]
    weights = found.weights[heavy] / found.weights[heavy].sum()
    smooth = _rest(covariances, shape, y)
    judged = []
    for name, (law, most) in LAWS.items():
        largest = most / max(1.0, float(v.max()))
        a = _least_squares(law, largest, v, y, root)
        fitted = law(a, v)
        slope = (law(a * 1.001, v) - law(a * 0.999, v)) / (0.002 * a)
        misfit = y - fitted
        worse = np.maximum(_rest(covariances, slope[:, None], misfit) - smooth, 0.0)
        probability = math.nan
        if further:
            probability = float(weights @ special.chdtrc(further, worse))
        r = impacts.restitution
        errors = r - np.exp(fitted)
        inverse = np.linalg.inv(likely)
        hat = slope * (inverse @ slope) / (slope @ inverse @ slope)
        apart = errors / np.maximum(1 - hat, 1e-9)
        excess = _rest(np.eye(n)[None], slope[:, None], misfit) - _rest(np.eye(n)[None], shape, y)
        bound = special.chdtri(further, REJECTED) if further else math.nan
        judged.append(
            Judged(
                law=name,
                parameter=a,
                restitution=float(np.exp(law(a, np.array([at])))[0]),
                rms=float(np.sqrt(np.mean(errors**2))),
                left_out=float(np.sqrt(np.mean(apart**2))),
                needed=float(np.mean(r) * math.sqrt(max(excess[0], 0.0) / bound)),
                probability=probability,
                verdict="",
            )
        )
    some_rejected = any(each.probability < REJECTED for each in judged)
    with_words = [
        Judged(**{**vars(each), "verdict": _verdict(each.probability, some_rejected, is_known)})
        for each in judged
    ]
    return sorted(with_words, key=lambda each: each.rms)


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
class Fit:
    """r at a speed with its 95 % interval, the laws, and what else is known of the recording."""

    recording: Recording
    impacts: Impacts
    speed: float
    restitution: float
    interval: tuple[float, float]
    scatter: float
    slope: float
    laws: tuple[Judged, ...]
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
        low, high = self.interval
        title = self.recording.head.get("title", self.recording.name)
        span = f"{v.min():.3g} to {v.max():.3g} m/s"
        return [
            f"{title}: {len(v)} impacts at {span}, from {self.recording.kind}",
            f"r = {self.restitution:.4f} at {self.speed:.3g} m/s, 95 %: {low:.4f} to {high:.4f}; "
            f"r goes as v^{self.slope:+.3f}, and impacts scatter about it by {self.scatter:.4f}",
            "",
            *aligned(self.table),
            *(f"! {note}" for note in self.notes),
        ]

    def __repr__(self) -> str:
        return "\n".join(self.lines[:2])

    def __str__(self) -> str:
        return "\n".join(self.lines)

    def _repr_html_(self) -> str:
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in line) + "</tr>"
            for line in self.table
        )
        first, second, *_ = self.lines
        return f"<p>{escape(first)}</p><p>{escape(second)}</p><table>{rows}</table>"

    def bounce(self, mass: Quantity = None, **more: Any) -> Bounce:
        """Return the bounce at this speed, with the contact time of the recording if it has one."""
        body = self.mass if mass is None else mass
        if body is None:
            raise Refused("the mass is missing: the recording does not say it, give --mass '46 g'")
        given = {"penetration", "stiffness", "contact_time"} & {
            name for name, value in more.items() if value is not None
        }
        if self.recording.duration is not None and not given:
            more["contact_time"] = self.recording.duration
        if self.diameter is not None and more.get("radius") is more.get("density") is None:
            more["radius"] = self.diameter / 2
        return Bounce(mass=body, restitution=min(self.restitution, 1.0), speed=self.speed, **more)

    def design(self, engine: str = "generic", time_step: Quantity = None, **more: Any) -> Design:
        """Return the design of an engine for this bounce; ``more`` belongs to the bounce."""
        return design(self.bounce(**more), engine, time_step)


def fit(
    source: str | Path | Recording,
    speed: Quantity = None,
    *,
    resolution: Quantity = None,
    mass: Quantity = None,
    diameter: Quantity = None,
    leave_out: tuple[int, ...] = (),
) -> Fit:
    """Return r of a recording at a speed with its 95 % interval, and the laws that it allows.

    Parameters
    ----------
    source : str, Path or Recording
        A file, a published experiment by its name, or a recording.
    speed : Quantity, optional
        By default the middle of the speeds, the geometric mean.
    resolution : Quantity, optional
        The standard deviation of a reading: of a time, a height, a speed, or r.
    mass, diameter : Quantity, optional
        Of the ball, with which the drag of the air is removed from flights and heights.
    leave_out : tuple of int
        Lines of the file.

    Raises
    ------
    Refused
        If the recording cannot be read or has fewer than three impacts.
    """
    recording = source if isinstance(source, Recording) else read(source, leave_out)
    head = recording.head
    notes = list(recording.notes)
    body = mass if mass is not None else head.get("mass")
    across = diameter if diameter is not None else head.get("diameter")
    kilograms = None if body is None else positive("mass", body, "kg")
    wide = None if across is None else positive("diameter", across, "m")
    drag = 0.0
    if recording.kind in ("flights", "heights", "drops"):
        if kilograms is not None and wide is not None:
            drag = _AIR * _DRAG * math.pi * wide**2 / 8 / kilograms
            notes.append(f"the drag of the air is removed, {drag:.2g} of the speed per metre")
        else:
            notes.append("the drag of the air is not removed: give the mass and the diameter")
    impacts = impacts_of(recording, drag)
    n = len(impacts.log_r)
    middle = math.exp(float(np.mean(np.log(impacts.speed))))
    at = middle if speed is None else positive("speed", speed, "m/s")
    if n < _FEWEST:
        notes.append(f"{n} impacts are too few for an interval of its own: it is wide")
    stated = resolution if resolution is not None else head.get("resolution")
    known: float | Array | None = recording.uncertainty
    if stated is not None:
        unit = {"flights": "s", "heights": "m", "drops": "m", "speeds": "m/s"}
        known = positive("resolution", stated, unit.get(recording.kind, ""))
    found = posterior(impacts, known)
    means, deviations = predicted(impacts, found, at)
    tail = (1 - _LEVEL) / 2
    low = quantile(tail, means, deviations, found.weights)
    high = quantile(1 - tail, means, deviations, found.weights)
    centre = quantile(0.5, means, deviations, found.weights)
    steep = predicted(impacts, found, at * 1.05)[0] - predicted(impacts, found, at / 1.05)[0]
    if not 0.9 * impacts.speed.min() <= at <= 1.1 * impacts.speed.max():
        notes.append(f"{at:.3g} m/s is outside of the measured speeds")
    is_known = known is not None
    if not is_known:
        notes.append("no errors are given: a law can only deviate by more than the scatter")
    laws = judge(impacts, found, at, is_known) if n >= _FEWEST else []
    if laws and all(each.probability < REJECTED for each in laws):
        notes.append("no law fits: r is that of a smooth curve")
    if recording.duration is not None:
        notes.append(f"the contact time is {show(recording.duration, 's')}")
    return Fit(
        recording=recording,
        impacts=impacts,
        speed=at,
        restitution=math.exp(centre),
        interval=(math.exp(low), min(math.exp(high), 1.0)),
        scatter=scatter_of(impacts, found),
        slope=float(found.weights @ steep) / (2 * math.log(1.05)),
        laws=tuple(laws),
        mass=kilograms,
        diameter=wide,
        notes=tuple(notes),
    )
