"""Measured impacts against every law, and what a constant r costs.

Each experiment of the package (:mod:`bouncing_ball_contacts.measured.experiment`) is fitted by each
contact law, and the law is judged by points that the fit has not seen
(:mod:`bouncing_ball_contacts.measured.verdicts`). The paper's two models have a constant r: they
are the laws ``restitution``, without a contact, and ``linear``.

An experiment without uncertainties is judged by the scatter of its points, in which a systematic
error of the measurement does not show. The dataset says which those are, and with which size of the
errors each law would pass.

On a shaker the ball of an n-T orbit lands with 2nπ/(1 + r) g/Ω at every amplitude, often below the
measured speeds. The law that fits best gives r(v) there and, if a contact time is known, the
duration of the contact, and so the ϖ of the linear contact with the same r and duration. The error
of the restitution model has two parts, signed and relative to the restitution model with r(v). The
first is that by the duration, of the error law (:mod:`bouncing_ball_beyond.accuracy.error_law`),
which r(v) does not remove. The second is that by a constant r. The constant r is the best one for
this shaker: the r(v) at the impact speed of the first family of orbits. For this family it leaves
the saddle-node and the heights as they are, because the impact speed is the same on all its orbits.
It does not leave the period doubling, on which b = d(r v)/dv acts: with ``X = nπ (1 - r)/(1 + r)``
it is at ::

    Λ² = X² + Y²,    Y = 2 (1 + r b)/((1 + r)(1 + b))

which is Eq. 8 for the exact map if b = r. The balls of the other families land faster, with another
r(v).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.error_law import (
    VALID_BELOW,
    curvature_of,
    doubling_lift,
    law_errors,
    small_parameter,
)
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.datasets.variables import Variable, described
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import phase
from bouncing_ball_contacts.contact.table import Table, TableMotion
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.measured.curves import CURVES
from bouncing_ball_contacts.measured.experiment import Experiment, experiment
from bouncing_ball_contacts.measured.fit import ContactFit
from bouncing_ball_contacts.measured.law_fit import LEVEL, LawFit, MeasuredPoints
from bouncing_ball_contacts.measured.verdicts import (
    ACCEPTED,
    REJECTED,
    JudgedLaw,
    error_size,
    judge,
    scatter,
    smooth,
    trend_of_scatter,
)

# Ten times the largest change when a fit starts elsewhere, see tests/documents.
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
        "standard deviation by the scatter about the parabola of least squares in ln v",
        budget=_FITTED,
    ),
    "errors_given": Variable("whether the experiment gives the uncertainties of its points"),
    "errors_size": Variable(
        "root mean square of the standard deviations, given or by the scatter", budget=_FITTED
    ),
    "scatter_trend": Variable(
        "probability of a stronger trend of the scatter with the speed", symbol="p", budget=_FITTED
    ),
    "errors_needed": Variable(
        "size of the errors with which the law would not be rejected", budget=_FITTED
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
    "rejected_below": Variable("a law is rejected if a probability is below", symbol="p"),
    "accepted_above": Variable("a law may be compatible if both probabilities are above"),
    "band_level": Variable("probability of the bands"),
    "useful_below": Variable("small parameter below which the error law is useful", symbol="η"),
    "shaker_frequency": Variable("frequency of the shaker", symbol="Ω/2π", units="Hz"),
    "shaker_law": Variable("contact law that fits the experiment best"),
    "shaker_speed": Variable(
        "impact speed of the orbits on the shaker", symbol="v", units="m s-1", budget=_FITTED
    ),
    "shaker_within": Variable("whether this speed is within the measured ones"),
    "shaker_ratio": Variable(
        "frequency ratio of the linear contact with the same r and contact time",
        symbol="ϖ",
        budget=_FITTED,
    ),
    "shaker_restitution": Variable(
        "restitution coefficient of the law at this speed", symbol="r(v)", budget=_FITTED
    ),
    "shaker_measured": Variable(
        "restitution coefficient of the parabola through the points at this speed, if it is "
        "within the measured ones",
        symbol="r(v)",
        budget=_FITTED,
    ),
    "fold_by_points": Variable(
        "relative error of the saddle-node by the r of the first family, both by this parabola",
        budget=_FITTED,
    ),
    "by_duration": Variable(
        "relative error of the restitution model by the duration of the contact", budget=_FITTED
    ),
    "by_constant": Variable(
        "relative error of the restitution model by the r of the first family", budget=_FITTED
    ),
    "shaker_small": Variable(
        "small parameter of the error law, useful below 0.3", symbol="η", budget=_FITTED
    ),
}

COMPARED = (Quantity.MAX_HEIGHT, Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING)


TITLE = "Measured impacts against every contact law"
SHAKER_TITLE = "The balls of the experiments on shakers, and the cost of a constant r"


@dataclass(frozen=True)
class MeasuredImpacts:
    """The experiments that are fitted, and the number of points of the curves r(v)."""

    experiments: Sequence[str]
    samples: int


@dataclass(frozen=True)
class Shaker:
    """Shakers of frequencies in Hz, and the families of orbits on them: Λ at a share of the way
    from the saddle-node to the period doubling. The constant r is that of the first family.
    """

    experiments: Sequence[str]
    n: Sequence[int]
    frequencies: Sequence[float]
    position: float


def measured_impacts(parameters: MeasuredImpacts) -> xr.Dataset:
    """Every law on every experiment: curves with bands, errors and verdicts.

    The dataset has the measured points over (experiment, measured_impact), NaN beyond the last
    one, with their uncertainties, NaN where the experiment gives none, and their standard
    deviations by the scatter; the curves and their bands over (experiment, fitted_law, sample) with
    their speeds over (experiment, sample); and errors, probabilities and verdicts over (experiment,
    fitted_law).
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


def _errors(
    points: MeasuredPoints, order: np.ndarray, longest: int
) -> dict[str, tuple[str, np.ndarray]]:
    """The standard deviations of the points, those given and those by the scatter."""
    given = points.deviations if points.is_known else np.full(points.size, np.nan)
    by_scatter = np.sqrt(scatter(points)[0]) * points.deviations
    return {
        "measured_uncertainty": ("measured_impact", _padded(given[order], longest)),
        "measured_scatter": ("measured_impact", _padded(by_scatter[order], longest)),
    }


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
            **_errors(points, order, longest),
            "errors_given": points.is_known,
            "errors_size": error_size(points),
            "scatter_trend": trend_of_scatter(points),
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


def _verdicts(judgements: list[JudgedLaw]) -> dict[str, tuple[str, list]]:
    return {
        "extrapolation_rms": ("fitted_law", [each.extrapolation for each in judgements]),
        "left_out_probability": ("fitted_law", [each.left_out for each in judgements]),
        "extrapolation_probability": ("fitted_law", [each.extrapolated for each in judgements]),
        "law_verdict": ("fitted_law", [str(each.verdict) for each in judgements]),
        "errors_needed": ("fitted_law", [each.needed for each in judgements]),
    }


def on_shakers(parameters: Shaker) -> xr.Dataset:
    """The balls of the experiments on shakers, and both errors of the restitution model there.

    The dataset has ``by_duration`` and ``by_constant`` over (experiment, shaker_frequency, n,
    quantity), the best law over (experiment), and the other variables over (experiment,
    shaker_frequency, n). What needs a contact time is NaN for an experiment without one.
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
            "n": list(parameters.n),
            "quantity": [str(quantity) for quantity in COMPARED],
        },
        variables=VARIABLES,
    )


def _on_shakers(fit: ContactFit, parameters: Shaker) -> xr.Dataset:
    """One experiment on all shakers."""
    each = [_on_shaker(fit, frequency, parameters) for frequency in parameters.frequencies]
    return xr.concat(each, "shaker_frequency").assign(shaker_law=fit.best.law)


def _on_shaker(fit: ContactFit, frequency: float, parameters: Shaker) -> xr.Dataset:
    """One experiment on one shaker."""
    orbits = [_OrbitsOnShaker.of(fit, frequency, n, parameters.position) for n in parameters.n]
    return xr.concat([each.row(fit, orbits[0]) for each in orbits], "n")


@dataclass(frozen=True)
class _OrbitsOnShaker:
    """The n-T orbits of a ball on a shaker, whose impacts are instants with r(v).

    ``speed`` is in m/s, ``slope`` is d(r v)/dv, and ``amplitude`` is the Λ at which heights are
    compared.
    """

    motion: TableMotion
    n: int
    speed: float
    restitution: float
    slope: float
    amplitude: float

    @classmethod
    def of(cls, fit: ContactFit, frequency: float, n: int, position: float) -> Self:
        """The orbits of one family."""
        best = fit.best
        table = Table(frequency=frequency, acceleration=STANDARD_GRAVITY)
        speed = best.speed_on(table, n)
        r = float(best.restitution_at(speed))
        slope = r + float(best.trend_at(speed))
        fold = float(restitution_saddle_node(n, r))
        amplitude = fold + position * (_doubling(n, r, slope) - fold)
        return cls(table.motion, n, speed, r, slope, amplitude)

    def measured(self, points: MeasuredPoints) -> float:
        """r by the parabola through the points; NaN beyond them."""
        if not points.speeds.min() <= self.speed <= points.speeds.max():
            return float("nan")
        return float(smooth(points, np.array([self.speed]))[0])

    def row(self, fit: ContactFit, first: Self) -> xr.Dataset:
        """The orbits, and the errors of the restitution model with the r of the first family."""
        speeds = fit.points.speeds
        measured = self.measured(fit.points)
        constant = first.measured(fit.points)
        by_points = np.nan
        if np.isfinite(measured) and np.isfinite(constant):
            fold = float(restitution_saddle_node(self.n, measured))
            by_points = float(restitution_saddle_node(self.n, constant)) / fold - 1
        ratio = np.nan
        by_duration = np.full(len(COMPARED), np.nan)
        delta = np.nan
        if fit.best.has_stiffness:
            ratio, by_duration, delta = self.by_duration(fit.best)
        return xr.Dataset(
            {
                "shaker_speed": self.speed,
                "shaker_within": bool(speeds.min() <= self.speed <= speeds.max()),
                "shaker_ratio": ratio,
                "shaker_restitution": self.restitution,
                "by_duration": ("quantity", by_duration),
                "shaker_measured": measured,
                "fold_by_points": by_points,
                "by_constant": ("quantity", self.by_constant(first.restitution)),
                "shaker_small": delta,
            }
        )

    def by_duration(self, best: LawFit) -> tuple[float, np.ndarray, float]:
        """ϖ, the errors by the error law and its small parameter δ."""
        time = float(best.duration_at(self.speed))
        duration = time / self.motion.time
        linear = SpringDamper.of_impact(self.restitution, duration)
        impact = self.speed * self.motion.time / self.motion.length
        assert best.curve.kind is not None
        law = law_of_impact(best.curve.kind, self.restitution, duration, impact)
        signature = Signature(law)
        instant = signature(impact)
        curvature = curvature_of(signature, impact)
        errors = law_errors(self.n, instant, self.amplitude, curvature)
        return (
            float(linear.frequency_ratio),
            np.array([float(errors[quantity]) for quantity in COMPARED]),
            float(small_parameter(self.n, instant, self.amplitude)),
        )

    def by_constant(self, constant: float) -> np.ndarray:
        """Relative errors by a constant r, of :data:`COMPARED`; NaN where it has no orbit."""
        simple = self.values(constant, constant)
        return simple / self.values(self.restitution, self.slope) - 1

    def values(self, restitution: float, slope: float) -> np.ndarray:
        """The greatest height, the saddle-node and the period doubling."""
        fold = float(restitution_saddle_node(self.n, restitution))
        height = np.nan
        if self.amplitude >= fold:
            angle = float(phase(self.n, restitution, self.amplitude))
            height = self.amplitude * np.sin(angle) + (self.n * np.pi) ** 2 / 2
        return np.array([height, fold, _doubling(self.n, restitution, slope)])


def _doubling(n: int, restitution: float, slope: float) -> float:
    """Λ of the period doubling of impacts with r(v)."""
    lift = doubling_lift(restitution, slope)
    return float(np.hypot(restitution_saddle_node(n, restitution), lift))
