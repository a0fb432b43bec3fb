r"""Many balls whose restitution coefficient scatters from impact to impact.

At each impact r is drawn anew, independently of the motion, from the beta distribution with the
mean r and the standard deviation s of the model. It has values in (0, 1) only, and for s → 0 it is
r itself. The generator of a seed gives the same balls on every machine.

At an impact of the speed v = -δ′ the energy of a ball over its mass changes by ::

    w′ (1 + r) v - (1 - r²) v²/2

The first term is the work of the table, and the second the loss. A free flight keeps the energy,
so that the mean work is equal to the mean loss once the statistics do not change any more. Because
r does not depend on v, the mean loss of impacts is (1 - r² - s²) ⟨v²⟩/2. On a table at rest the
speeds obey v_{k+1} = r_k v_k, so that after k impacts ⟨v^j⟩ = v_0^j ⟨r^j⟩^k, with ⟨r²⟩ = r² + s².

That r scatters is seen in experiments, where the distribution is not Gaussian: M. Montaine and
others, *The coefficient of restitution as a fluctuating quantity*, arXiv:1104.0049, of which the
abstract and the introduction were read. They find two exponential flanks. The beta distribution
here is a choice.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice
from typing import Annotated, Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.datasets.arguments import (
    AMPLITUDE,
    IMPACTS,
    SAMPLES,
    START,
    Amplitude,
    Impacts,
    SampleCount,
    Start,
    checked_number,
)
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.drawing.result import Result
from bouncing_ball.errors import ParameterError, Range, count, suggesting
from bouncing_ball.models.ball import Ball, a_single_ball
from bouncing_ball.models.contacts_and_flights import Impact
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.rigid import RestitutionModel

NOISE = Range(0, 0.5, "[)")
SEED = count(2**32 - 1, low=0)
_QUANTILES = (0.05, 0.5, 0.95)
_VARIABLES = {
    "impact": Variable("number of the impact"),
    "quantile": Variable("share of the balls with a smaller value"),
    "balls_bouncing": Variable("number of balls that have this impact"),
    "speed_mean": Variable("mean speed of the impacts", symbol="⟨v⟩"),
    "speed_error": Variable("standard error of the mean speed"),
    "speed_square": Variable("mean of the square of the speed", symbol="⟨v²⟩"),
    "speed_quantile": Variable("quantiles of the speed"),
    "time_mean": Variable("mean time since the first impact"),
    "work_mean": Variable("mean work of the table at the impact"),
    "work_error": Variable("standard error of the mean work"),
    "loss_mean": Variable("mean energy lost at the impact"),
    "loss_error": Variable("standard error of the mean loss"),
}


@suggesting
def ensemble(
    ball: Ball,
    *,
    amplitude: Amplitude,
    noise: Annotated[float, NOISE],
    balls: SampleCount = 1000,
    impacts: Impacts = 200,
    phase: Start = 0.0,
    velocity: Start = -math.pi,
    seed: Annotated[int, SEED] = 0,
) -> Result:
    """Statistics over balls whose restitution coefficient scatters from impact to impact.

    Parameters
    ----------
    ball : Ball
        A single rigid ball, whose r is the mean restitution coefficient.
    amplitude : float
        Excitation amplitude Λ.
    noise : float
        The standard deviation s of r, with s² < r(1 - r).
    balls : int
        Number of balls; all start with the same first impact.
    impacts : int
        Number of impacts, the first included.
    phase : float
        Phase of the table at the first impact.
    velocity : float
        Absolute velocity of the balls before the first impact.
    seed : int
        The seed of the random numbers.

    Returns
    -------
    Result
        For each ``impact``: the number of balls that have it, ``balls_bouncing``; the mean of the
        speed v = -δ′ with its standard error, of v² and of the time; ``speed_quantile``; and the
        means of the work of the table and of the energy lost, over the mass of a ball. The bounces
        before a ball sticks to the table are summed up with one r. Balls that stay on the table
        have no further impacts. The figure shows the speeds.

    Raises
    ------
    ModelError
        If a parameter is of a wrong type or out of range, or if the ball is not rigid.

    Examples
    --------
    On a table at rest ⟨v²⟩ falls by the factor r² + s² from impact to impact:

    >>> from bouncing_ball import rigid
    >>> found = ensemble(rigid(restitution=0.8), amplitude=0.0, noise=0.1, balls=4000, impacts=3)
    >>> (found.speed_square / found.speed_square[0]).values.round(2).tolist()
    [1.0, 0.65, 0.42]
    """
    model = a_single_ball(ball)
    if not isinstance(model, RestitutionModel):
        raise ParameterError(
            "an ensemble is one of rigid balls, because the impacts of other balls have no r"
        )
    lam = checked_number("amplitude", amplitude, AMPLITUDE)
    scatter = _Scatter.of(float(model.restitution), checked_number("noise", noise, NOISE))
    number = checked_number("balls", balls, SAMPLES)
    most = checked_number("impacts", impacts, IMPACTS)
    first = [checked_number(*each, START) for each in (("phase", phase), ("velocity", velocity))]
    rng = np.random.default_rng(checked_number("seed", seed, SEED))
    start = np.full(number, first[0]), np.full(number, first[1])
    dynamics, phases, relative, _ = model.dynamics(np.full(number, lam)).first_impacts(*start)
    rows = _impacts_of_balls(dynamics, dynamics.start(phases, relative), scatter, most, rng)
    given = {"amplitude": lam, "noise": scatter.deviation, "balls": number, "seed": seed}
    labels = {"phase": first[0], "velocity": first[1]}
    attributes = {**model.parameters, **given, **labels}
    return Result.of(_statistics(rows).assign_attrs(attributes), "ensemble")


class _Scatter(NamedTuple):
    """The distribution of r, by its mean and its standard deviation."""

    mean: float
    deviation: float

    @classmethod
    def of(cls, mean: float, deviation: float) -> _Scatter:
        """The distribution.

        Raises
        ------
        ParameterError
            If no distribution over (0, 1) has these numbers.
        """
        if deviation * deviation >= mean * (1 - mean) and deviation > 0:
            raise ParameterError(
                f"{{noise}} = {{}} is too large: no restitution in (0, 1) with the mean {mean:g} "
                f"scatters by {math.sqrt(mean * (1 - mean)):.3g} or more",
                repr(deviation),
            )
        return cls(mean, deviation)

    def draw(self, rng: np.random.Generator, size: int) -> np.ndarray:
        """Values of r; all are the mean if there is no scatter."""
        if not self.deviation:
            return np.full(size, self.mean)
        weight = self.mean * (1 - self.mean) / self.deviation**2 - 1
        found = rng.beta(weight * self.mean, weight * (1 - self.mean), size)
        # A value may be rounded to 0, where no impact has one.
        return np.clip(found, np.finfo(float).tiny, 1.0)


class _Rows(NamedTuple):
    """The speeds, times, works and losses of impacts, shape (impacts, balls); NaN after the last
    one.
    """

    speed: np.ndarray
    time: np.ndarray
    work: np.ndarray
    loss: np.ndarray


def _impacts_of_balls(
    dynamics: Dynamics,
    impact: Impact,
    scatter: _Scatter,
    impacts: int,
    rng: np.random.Generator,
) -> _Rows:
    """The impacts of a row of balls, each with an r of its own."""
    size = impact.phase.size
    rows = _Rows(*(np.full((impacts, size), np.nan) for _ in _Rows._fields))
    ball = np.arange(size)
    time = np.zeros(size)

    def renewed(before: Dynamics) -> Dynamics:
        # One number for each ball, whether it bounces or not: balls do not depend on others.
        return replace(before, law=scatter.draw(rng, size)[ball])

    for k, leg in enumerate(islice(dynamics.legs(impact, renewed=renewed), impacts)):
        r = leg.dynamics.law
        speed = -leg.impact.velocity
        table_rate, _ = leg.dynamics.table_at(leg.impact)
        rows.speed[k, ball] = speed
        rows.time[k, ball] = time
        rows.work[k, ball] = table_rate * (1 + r) * speed
        rows.loss[k, ball] = (1 - r * r) * speed * speed / 2
        ball, time = leg.keep(leg.bouncing(), ball, time)
        if k + 1 < impacts:
            _, passed = leg.fly()
            time = time + passed
    return rows


def _statistics(rows: _Rows) -> xr.Dataset:
    """The statistics over the balls of each impact."""
    bouncing = np.isfinite(rows.speed)
    many = bouncing.sum(axis=1)
    kept = np.flatnonzero(many)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = {name: _mean(values[kept]) for name, values in rows._asdict().items()}
    square, _ = _mean(rows.speed[kept] ** 2)
    quantile = np.nanquantile(rows.speed[kept], _QUANTILES, axis=1)
    found: dict[str, Any] = {
        "balls_bouncing": ("impact", many[kept]),
        "speed_mean": ("impact", means["speed"][0]),
        "speed_error": ("impact", means["speed"][1]),
        "speed_square": ("impact", square),
        "speed_quantile": (("impact", "quantile"), quantile.T),
        "time_mean": ("impact", means["time"][0]),
        "work_mean": ("impact", means["work"][0]),
        "work_error": ("impact", means["work"][1]),
        "loss_mean": ("impact", means["loss"][0]),
        "loss_error": ("impact", means["loss"][1]),
    }
    coords = {"impact": kept, "quantile": list(_QUANTILES)}
    return describe(xr.Dataset(found, coords), _VARIABLES)


def _mean(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mean over the balls and its standard error; NaN for a single ball."""
    many = np.isfinite(values).sum(axis=1)
    mean = np.nansum(values, axis=1) / many
    apart = np.nansum((values - mean[:, np.newaxis]) ** 2, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return mean, np.sqrt(apart / (many * (many - 1.0)))
