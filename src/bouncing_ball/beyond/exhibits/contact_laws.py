"""The paper's comparison for contact laws that engineers use (beyond the paper).

All laws have the same restitution coefficient r and the same centroid t_c of the force of the free
impact, at the impact speed of the orbit in question. If D is the duration of the free impact and
κ = -δ_b/δ′_b at its end, t_c = r (D + κ)/(1 + r) for every law, and to first order the errors
depend on D only through t_c. A Hertz contact has no ϖ. It is replaced by π/(D + κ), the ϖ of the
elastic linear contact with the same D + κ. Errors are relative to the simple model as in
Eqs. 37-38.
"""

from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from bouncing_ball.beyond.corrected.errors import SIMPLE
from bouncing_ball.beyond.corrected.instant import instant_of
from bouncing_ball.beyond.corrected.orbits import CorrectedModel
from bouncing_ball.beyond.corrected.signature import Signature
from bouncing_ball.beyond.laws.law_of_impact import law_of_impact
from bouncing_ball.beyond.laws.orbits import LawModel, law_at_orbit
from bouncing_ball.beyond.laws.registry import LAWS
from bouncing_ball.datasets.parameters import LawRestitution, Tolerance
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.paper.comparison.errors import Quantity, relative, values
from bouncing_ball.paper.contact.damping import Release, damping_ratio
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.orbit_parameters import OrbitsAlongRatio
from bouncing_ball.paper.orbits.model import ImpactModel
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel

VARIABLES = {
    "law": Variable("law of the contact"),
    "centroid_ratio": Variable(
        "π over D + κ of the free impact, which stands for the frequency ratio", symbol="π/(D+κ)"
    ),
}
HERTZ = ("hunt-crossley", "tsuji", "kuwabara-kono")
LINEAR = {"linear": Release.DISPLACEMENT, "linear, force release": Release.FORCE}
NAMES = (*LINEAR, *HERTZ)
BOUNDS = (Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING)
# Distances in ln ϖ from a first estimate of a threshold to the orbits that locate it.
_BESIDE = np.linspace(-0.02, 0.02, 5)
QUANTITIES = (Quantity.MAX_HEIGHT, Quantity.BOUNCE_VELOCITY, Quantity.PHASE, *BOUNDS)


class LawErrors(OrbitsAlongRatio):
    """One orbit on contacts of several durations, and the tolerated relative error of its greatest
    height; ``frequency_ratio`` stands for π/(D + κ).
    """

    restitution: LawRestitution
    tolerance: Tolerance


@lru_cache
def share_in_contact(name: str, restitution: float) -> float:
    """D/(D + κ) of the free impact, which depends on the law and on r alone.

    Examples
    --------
    A contact that ends at δ = 0 has κ = 0:

    >>> share_in_contact("linear", 0.5)
    1.0
    """
    impact = instant_of(exact_model(name, restitution, 1.0, 1.0), 1.0)
    return float(impact.restitution / ((1 + impact.restitution) * impact.delay))


def exact_model(
    name: str, restitution: float, duration: ArrayLike, speed: ArrayLike
) -> ImpactModel:
    """The exact models of contacts that have r and D at given speeds, arrays of one shape.

    Parameters
    ----------
    name : str
        One of :data:`NAMES`.
    restitution : float
    duration, speed : array_like
        D, and the impact speed at which the contact has r and D.

    Raises
    ------
    ModelError
        If no law of this name has these r and D.

    Examples
    --------
    A linear contact has the same r and D at every speed:

    >>> float(exact_model("linear", 1.0, np.pi, 2.0).contact.frequency_ratio)
    1.0
    """
    duration, speed = np.broadcast_arrays(duration, speed)
    if name in LINEAR:
        unit = SpringDamper(1.0, damping_ratio(restitution, LINEAR[name]), LINEAR[name])
        omega = unit.free_duration / duration
        return SpringDamperModel(SpringDamper(omega, unit.damping_ratio, unit.release))
    return LawModel(law_of_impact(LAWS[name], restitution, duration, speed))


def own_models(name: str, orbit: LawErrors, ratios: np.ndarray) -> Any:
    """The exact models of contacts with r and π/(D + κ) at the impact speeds of their orbits.

    ``ratios`` are the values of π/(D + κ), shape (m,).

    Raises
    ------
    NoOrbitError, ModelError
        If a contact has no such orbit, for example because D exceeds the cycle.
    """
    r = orbit.restitution
    duration = np.pi / ratios * share_in_contact(name, r)
    if name in LINEAR:
        return exact_model(name, r, duration, 1.0)
    return LawModel(law_at_orbit(LAWS[name], r, duration, orbit.n, orbit.amplitude))


def along(name: str, orbit: LawErrors, value: Callable[[Any], np.ndarray]) -> np.ndarray:
    """A quantity of the exact models along π/(D + κ), shape (..., ϖ).

    It is NaN for contacts below the smallest π/(D + κ) above which all contacts have the orbit.

    Raises
    ------
    NoOrbitError
        If no contact has the orbit.
    """
    ratios = orbit.frequency_ratio.grid()
    for first in range(ratios.size):
        with suppress(ModelError, NoOrbitError):
            found = value(own_models(name, orbit, ratios[first:]))
            return np.concatenate([np.full((*found.shape[:-1], first), np.nan), found], axis=-1)
    raise NoOrbitError(f"no {name} contact has the {orbit.n}-T orbit at Λ = {orbit.amplitude:g}")


def corrected_values(exact: Any, *asked: Any) -> np.ndarray:
    """Quantities in the corrected restitution models of contacts, shape (quantity, ϖ)."""
    if isinstance(exact, SpringDamperModel):
        return values(CorrectedModel.of_contact(exact.contact), *asked)
    each = (CorrectedModel(Signature(exact.law.take(k))) for k in range(exact.law.size))
    return np.stack([values(model, *asked) for model in each], axis=-1)


def _errors(name: str, parameters: LawErrors) -> tuple[np.ndarray, float]:
    """Relative errors of both simple models, and a threshold.

    The errors are moduli, shape (model, quantity, ratio); the threshold is the π/(D + κ) from which
    on the error of the restitution model's greatest height is tolerable.
    """
    n = parameters.n
    lam = parameters.amplitude
    rigid = RestitutionModel(parameters.restitution)

    def of_both_models(exact: Any) -> np.ndarray:
        wanted = values(exact, n, lam, QUANTITIES)
        constant = values(rigid, n, lam, QUANTITIES)[:, np.newaxis]
        corrected = corrected_values(exact, n, lam, QUANTITIES)
        return np.abs([relative(wanted, constant), relative(wanted, corrected)])

    errors = along(name, parameters, of_both_models)
    return errors, _threshold(name, parameters, errors[0, 0], rigid)


def _threshold(
    name: str, parameters: LawErrors, error: np.ndarray, rigid: RestitutionModel
) -> float:
    """The π/(D + κ) at which the error of the greatest height is the tolerance, NaN if none.

    ``error`` is that of the restitution model along π/(D + κ).
    """
    ratios = parameters.frequency_ratio.grid()
    outside = np.flatnonzero(error > parameters.tolerance)
    if not outside.size or outside[-1] == ratios.size - 1:
        return np.nan
    # ln(error/tolerance) is nearly a straight line in ln ϖ. Its zero is first interpolated between
    # two nodes, and then by the polynomial through nearby orbits, which is exact to rounding.
    sides = outside[-1] + np.arange(2)
    guess = np.interp(0, -np.log(error[sides] / parameters.tolerance), np.log(ratios[sides]))
    nearby = own_models(name, parameters, np.exp(guess + _BESIDE))
    exact_height = nearby.orbit(parameters.n, parameters.amplitude).max_height
    simple_height = rigid.orbit(parameters.n, parameters.amplitude).max_height
    near_error = np.abs(relative(exact_height, simple_height))
    line = Polynomial.fit(np.log(near_error / parameters.tolerance), _BESIDE, _BESIDE.size - 1)
    return float(np.exp(guess + line(0.0)))


def law_errors(parameters: LawErrors) -> xr.Dataset:
    """Errors of the restitution model and of the corrected one on all laws, along π/(D + κ).

    The dataset has ``relative_error`` (law, model, quantity, centroid_ratio), the modulus, and
    ``error_threshold`` (law,), the π/(D + κ) from which the greatest height of the restitution
    model is within the tolerance; NaN where there is none on the grid.

    Raises
    ------
    NoOrbitError
        If a law has the orbit at no π/(D + κ).
    """
    found = [_errors(name, parameters) for name in NAMES]
    errors = np.array([error for error, _ in found])
    thresholds = [threshold for _, threshold in found]
    return described(
        {
            "relative_error": (("law", "model", "quantity", "centroid_ratio"), errors),
            "error_threshold": ("law", thresholds),
        },
        coords={
            "law": list(NAMES),
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "centroid_ratio": parameters.frequency_ratio.grid(),
        },
        variables=VARIABLES,
    )
