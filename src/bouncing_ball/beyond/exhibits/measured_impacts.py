"""Measured impacts against every law, and what a constant r costs (beyond the paper).

Each experiment of the package (:mod:`bouncing_ball.measured.experiment`) is fitted by each contact
law, and the law is judged by points that the fit has not seen
(:mod:`bouncing_ball.measured.verdicts`). The paper's two models have a constant r: they are the
laws ``restitution``, without a contact, and ``linear``.

On a shaker an experiment's ball has impact speeds of 2nπ/(1 + r) g/Ω, often below the measured
ones. There the law that fits best gives r(v) and, if a contact time is known, the duration of the
contact, and so the ϖ of the linear contact with the same r and duration. The error of the
restitution model has then two parts: that by the duration, of the error law
(:mod:`bouncing_ball.accuracy.error_law`), which r(v) does not remove, and that by the constant r,
which it does. Both are signed and relative, as in the error law to the restitution model with r(v).
"""

from dataclasses import replace
from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import VALID_BELOW, first_order, small_parameter
from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.contacts.quantities import STANDARD_GRAVITY
from bouncing_ball.contacts.table import Table
from bouncing_ball.datasets.parameters import Family, Many, Parameters, Samples, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.measured.curves import CONSTANT, CURVES
from bouncing_ball.measured.experiment import Experiment, experiment
from bouncing_ball.measured.fit import LEVEL, ContactFit, LawFit, Points
from bouncing_ball.measured.verdicts import ACCEPTED, REJECTED, Judgement, judge, noise
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.laws.law_of_impact import law_of_impact
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import restitution_branch

# Ten times the largest change when a fit starts elsewhere, see tests/beyond/exhibits.
_FITTED = 1e-10

VARIABLES = {
    "experiment": Variable("name of the experiment"),
    "experiment_title": Variable("ball and surface"),
    "measured_impact": Variable("number of the impact, by its speed"),
    "fitted_law": Variable("contact law; restitution is a constant r without a contact"),
    "measured_speed": Variable("measured impact speed", symbol="v", units="m s-1"),
    "experiment_restitution": Variable("measured restitution coefficient", symbol="e"),
    "measured_uncertainty": Variable(
        "standard deviation of the restitution coefficient, where the experiment gives one"
    ),
    "measured_scatter": Variable(
        "standard deviation about the parabola of least squares in ln v", budget=_FITTED
    ),
    "curve_speed": Variable("impact speed of the curves", symbol="v", units="m s-1"),
    "fitted_restitution": Variable(
        "restitution coefficient of the law", symbol="r(v)", budget=_FITTED
    ),
    "fitted_low": Variable("lower end of the 95 % band", budget=_FITTED),
    "fitted_high": Variable("upper end of the 95 % band", budget=_FITTED),
    "fit_rms": Variable("root mean square of e - r(v)", budget=_FITTED),
    "left_out_rms": Variable(
        "root mean square of the errors at points left out of the fit", budget=_FITTED
    ),
    "extrapolation_rms": Variable(
        "root mean square of the errors at the faster half, fitted to the slower half",
        budget=_FITTED,
    ),
    "left_out_probability": Variable(
        "probability of greater errors at points left out", symbol="p", budget=_FITTED
    ),
    "extrapolation_probability": Variable(
        "probability of greater errors at the faster half", symbol="p", budget=_FITTED
    ),
    "law_verdict": Variable("whether the law is compatible with the experiment"),
    "rejected_below": Variable("a law is incompatible if a probability is below", symbol="p"),
    "accepted_above": Variable("a law may be compatible if both probabilities are above"),
    "band_level": Variable("probability of the bands"),
    "useful_below": Variable("small parameter below which the error law is useful", symbol="δ"),
    "shaker_frequency": Variable("frequency of the shaker", symbol="Ω/2π", units="Hz"),
    "shaker_law": Variable("contact law that fits the experiment best"),
    "shaker_speed": Variable(
        "impact speed of the orbit on the shaker", symbol="v", units="m s-1", budget=_FITTED
    ),
    "shaker_within": Variable("whether this speed is within the measured ones"),
    "shaker_ratio": Variable(
        "frequency ratio of the linear contact with the same r and contact time",
        symbol="ϖ",
        budget=_FITTED,
    ),
    "mean_restitution": Variable("constant r fitted to the experiment", symbol="r", budget=_FITTED),
    "shaker_restitution": Variable(
        "restitution coefficient of the law at this speed", symbol="r(v)", budget=_FITTED
    ),
    "by_duration": Variable(
        "relative error of the restitution model by the duration of the contact", budget=_FITTED
    ),
    "by_constant": Variable(
        "relative error of the restitution model by its constant r", budget=_FITTED
    ),
    "shaker_small": Variable(
        "small parameter of the error law, useful below 0.3", symbol="δ", budget=_FITTED
    ),
}

COMPARED = (Quantity.MAX_HEIGHT, Quantity.SADDLE_NODE)
Name = Annotated[str, number("name of an experiment of the package")]


class Measured(Parameters):
    """The experiments that are fitted, and the samples of the curves r(v)."""

    experiments: Many[Name]
    samples: Samples


class Shaker(Parameters):
    """Shakers, and the orbits on them: Λ at a share of the way from the saddle-node to the period
    doubling of the restitution model.
    """

    experiments: Many[Name]
    n: Family
    frequencies: Many[Annotated[float, number("frequency of the shaker", "Hz", gt=0)]]
    position: Annotated[
        float, number("place of Λ between saddle-node and period doubling", gt=0, lt=1)
    ]


def measured_impacts(parameters: Measured) -> xr.Dataset:
    """Every law on every experiment: curves with bands, errors and verdicts.

    The dataset has the measured points over (experiment, measured_impact), NaN beyond the last
    one, with their uncertainties, NaN where the experiment gives none; the curves and their bands
    over (experiment, fitted_law, sample) with their speeds over (experiment, sample); and errors,
    probabilities and verdicts over (experiment, fitted_law).
    """
    found = [experiment(name) for name in parameters.experiments]
    longest = max(each.speeds.size for each in found)
    parts = [_one(each, each.fit(), longest, parameters.samples) for each in found]
    data = xr.concat(parts, "experiment")
    return described(
        {
            **{str(name): data[name].variable for name in data.data_vars},
            "rejected_below": REJECTED / 2,
            "accepted_above": ACCEPTED,
            "band_level": LEVEL,
        },
        coords={
            "experiment": [each.name for each in found],
            "fitted_law": list(CURVES),
            "experiment_title": ("experiment", [each.title for each in found]),
        },
        variables=VARIABLES,
    )


def _padded(values: np.ndarray, size: int) -> np.ndarray:
    return np.concatenate([values, np.full(size - values.size, np.nan)])


def _uncertainties(points: Points) -> np.ndarray:
    if points.covariance is None:
        return np.full(points.size, np.nan)
    return np.sqrt(np.diag(points.covariance))


def _one(measured: Experiment, fit: ContactFit, longest: int, samples: int) -> xr.Dataset:
    """One experiment."""
    points = fit.points
    order = np.argsort(points.speeds, kind="stable")
    ends = points.speeds.min(), points.speeds.max()
    speeds = np.geomspace(ends[0] / 1.1, ends[1] * 1.1, samples)
    laws = [fit.law(name) for name in CURVES]
    judged = judge(fit)
    verdicts = [judged[each.law] for each in laws]
    bands = np.array([each.band(speeds) for each in laws])
    return xr.Dataset(
        {
            "measured_speed": ("measured_impact", _padded(points.speeds[order], longest)),
            "experiment_restitution": (
                "measured_impact",
                _padded(points.restitutions[order], longest),
            ),
            "measured_uncertainty": (
                "measured_impact",
                _padded(_uncertainties(points)[order], longest),
            ),
            "measured_scatter": float(np.sqrt(noise(replace(points, covariance=None))[0])),
            "curve_speed": ("sample", speeds),
            "fitted_restitution": (
                ("fitted_law", "sample"),
                np.array([each.restitution_at(speeds) for each in laws]),
            ),
            "fitted_low": (("fitted_law", "sample"), bands[:, 0]),
            "fitted_high": (("fitted_law", "sample"), bands[:, 1]),
            "fit_rms": ("fitted_law", [each.rms for each in laws]),
            "left_out_rms": ("fitted_law", [each.left_out for each in laws]),
            **_verdicts(verdicts),
        }
    )


def _verdicts(judgements: list[Judgement]) -> dict[str, tuple[str, list]]:
    return {
        "extrapolation_rms": ("fitted_law", [each.extrapolation for each in judgements]),
        "left_out_probability": ("fitted_law", [each.left_out for each in judgements]),
        "extrapolation_probability": ("fitted_law", [each.extrapolated for each in judgements]),
        "law_verdict": ("fitted_law", [str(each.verdict) for each in judgements]),
    }


def on_shakers(parameters: Shaker) -> xr.Dataset:
    """The balls of the experiments on shakers, and both errors of the restitution model there.

    The dataset has ``by_duration`` and ``by_constant`` over (experiment, shaker_frequency,
    quantity), and the other variables over (experiment, shaker_frequency). What needs a contact
    time is NaN for an experiment without one.
    """
    found = [experiment(name) for name in parameters.experiments]
    rows = [_on_shakers(each.fit(), parameters) for each in found]
    data = xr.concat(rows, "experiment")
    return described(
        {
            **{str(name): data[name].variable for name in data.data_vars},
            "useful_below": VALID_BELOW,
        },
        coords={
            "experiment": [each.name for each in found],
            "experiment_title": ("experiment", [each.title for each in found]),
            "shaker_frequency": list(parameters.frequencies),
            "quantity": [str(quantity) for quantity in COMPARED],
        },
        variables=VARIABLES,
    )


def _on_shakers(fit: ContactFit, parameters: Shaker) -> xr.Dataset:
    """One experiment on all shakers."""
    each = [_on_shaker(fit, frequency, parameters) for frequency in parameters.frequencies]
    return xr.concat(each, "shaker_frequency").assign(
        shaker_law=fit.best.law, mean_restitution=fit.law(CONSTANT).restitution
    )


def _on_shaker(fit: ContactFit, frequency: float, parameters: Shaker) -> xr.Dataset:
    n = parameters.n
    best = fit.best
    speed = best.speed_on(Table(frequency=frequency, acceleration=STANDARD_GRAVITY), n)
    r = float(best.restitution_at(speed))
    fold = float(restitution_branch.saddle_node(n, r))
    doubling = float(restitution_branch.period_doubling(n, r))
    amplitude = fold + parameters.position * (doubling - fold)
    slowest = fit.points.speeds.min()
    fastest = fit.points.speeds.max()
    ratio = delta = np.nan
    by_duration = np.full(len(COMPARED), np.nan)
    if best.has_stiffness:
        ratio, by_duration, delta = _by_duration(best, speed, frequency, n, amplitude)
    return xr.Dataset(
        {
            "shaker_speed": speed,
            "shaker_within": bool(slowest <= speed <= fastest),
            "shaker_ratio": ratio,
            "shaker_restitution": r,
            "by_duration": ("quantity", by_duration),
            "by_constant": ("quantity", _by_constant(fit, r, n, amplitude)),
            "shaker_small": delta,
        }
    )


def _by_duration(
    best: LawFit, speed: float, frequency: float, n: int, amplitude: float
) -> tuple[float, np.ndarray, float]:
    """ϖ, the errors by the error law and its small parameter δ."""
    motion = Table(frequency=frequency, acceleration=STANDARD_GRAVITY).motion
    r = float(best.restitution_at(speed))
    time = float(best.duration_at(speed))
    duration = time / motion.time
    unit = SpringDamper(1.0, float(damping_ratio(r)))
    impact = speed * motion.time / motion.length
    assert best.curve.kind is not None
    law = law_of_impact(best.curve.kind, r, duration, impact)
    instant = Signature(law)(impact)
    errors = first_order(n, instant, amplitude)
    return (
        float(unit.free_duration) / duration,
        np.array([float(errors[quantity]) for quantity in COMPARED]),
        float(small_parameter(n, instant, amplitude)),
    )


def _by_constant(fit: ContactFit, r: float, n: int, amplitude: float) -> list[float]:
    """Relative errors of the restitution model whose r is the mean one, of :data:`COMPARED`; NaN
    where it has no orbit.
    """
    constant = fit.law(CONSTANT).restitution
    folds = [float(restitution_branch.saddle_node(n, each)) for each in (constant, r)]
    height = np.nan
    if amplitude >= folds[0]:
        tops = [
            amplitude * np.sin(float(restitution_branch.phase(n, each, amplitude)))
            + (n * np.pi) ** 2 / 2
            for each in (constant, r)
        ]
        height = tops[0] / tops[1] - 1
    return [height, folds[0] / folds[1] - 1]
