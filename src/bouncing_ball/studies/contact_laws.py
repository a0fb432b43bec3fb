r"""The paper's comparison on the contacts that engineers use (beyond the paper).

All laws have the same restitution coefficient r and the same duration D of the
free impact, at the impact speed of the orbit in question. What stands for ϖ, which a
Hertz contact does not have, is π/D: that of the elastic linear contact of the
same duration. Errors are relative to the value of the exact orbit on the contact.
"""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.accuracy.errors import SIMPLE, relative
from bouncing_ball.accuracy.quantities import Quantity, values
from bouncing_ball.accuracy.thresholds import thresholds
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.laws import LAWS
from bouncing_ball.contacts.permanent_contact import permanent_contact
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import LawSignature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.law_model import LawModel, law_at_orbit
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side
from bouncing_ball.parameters import (
    Family,
    FrequencyRatio,
    LawRestitution,
    Many,
    Parameters,
    Span,
    Tolerance,
)
from bouncing_ball.studies.parameters import BranchEnd, OrbitParameters, Points

HERTZ = ("hunt-crossley", "tsuji", "kuwabara-kono")
LINEAR = {"linear": Release.DISPLACEMENT, "linear, force release": Release.FORCE}
NAMES = (*LINEAR, *HERTZ)
BOUNDS = (Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING)
QUANTITIES = (Quantity.MAX_HEIGHT, Quantity.BOUNCE_VELOCITY, Quantity.PHASE, *BOUNDS)


class OneOrbit(OrbitParameters):
    """One orbit on contacts of several durations; ϖ stands for π over the duration."""

    restitution: LawRestitution
    frequency_ratio: Span


class LawErrors(OneOrbit):
    """The error tolerated of its greatest height."""

    tolerance: Tolerance


class FiguresOfLaws(Parameters):
    """Families whose branches are followed, and the orbit whose greatest height is shown."""

    n: Many[Family]
    restitution: LawRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd
    points: Points
    heights: OneOrbit


def linear_contact(restitution: float, duration: ArrayLike, release: Release) -> SpringDamper:
    """The spring-damper with r and D under a release rule, at every speed.

    Examples
    --------
    >>> float(linear_contact(1.0, np.pi, Release.DISPLACEMENT).frequency_ratio)
    1.0
    """
    unit = SpringDamper(1.0, damping_ratio(restitution, release), release)
    omega = float(unit.free_duration) / np.asarray(duration, dtype=float)
    return SpringDamper(omega, unit.damping_ratio, release)


def exact_model(
    name: str, restitution: float, duration: ArrayLike, speed: ArrayLike
) -> ImpactModel:
    """The exact models of contacts with r and D at their speeds, arrays of one shape."""
    duration, speed = np.broadcast_arrays(duration, speed)
    if name in LINEAR:
        return SpringDamperModel(linear_contact(restitution, duration, LINEAR[name]))
    return LawModel(law_of_impact(LAWS[name], restitution, duration, speed))


def exact_models(name: str, parameters: OneOrbit, duration: np.ndarray) -> ImpactModel:
    """The exact models of contacts with r and D at their own orbits' speeds."""
    r, n, lam = parameters.restitution, parameters.n, parameters.amplitude
    if name in LINEAR:
        return SpringDamperModel(linear_contact(r, duration, LINEAR[name]))
    return LawModel(law_at_orbit(LAWS[name], r, duration, n, lam))


def stiff_enough(
    name: str, parameters: OneOrbit, ratios: np.ndarray
) -> tuple[slice, ImpactModel | None]:
    """The contacts, from some π/D on, that all have their orbit, and their models.

    Softer ones may have none: a contact longer than the cycle, for one, has no orbit
    whose impact it is. No model where there is no such contact.
    """
    first, last, middle, models = 0, len(ratios), 0, None
    while first < last:
        try:
            models = exact_models(name, parameters, np.pi / ratios[middle:])
        except (ModelError, NoOrbitError):
            first = middle + 1
        else:
            last = middle
        middle = (first + last) // 2
    return slice(first, None), models


def corrected_model(exact: Any) -> CorrectedModel:
    """The corrected restitution model of one contact."""
    if isinstance(exact, SpringDamperModel):
        return CorrectedModel.of_contact(exact.contact)
    return CorrectedModel(LawSignature(exact.law))


def _errors(name: str, parameters: OneOrbit, ratios: np.ndarray) -> np.ndarray:
    """Relative errors of both simple models, (model, quantity, ratio)."""
    orbit = parameters.n, parameters.amplitude, QUANTITIES
    errors = np.full((len(SIMPLE), len(QUANTITIES), len(ratios)), np.nan)
    part, models = stiff_enough(name, parameters, ratios)
    if models is None:
        return errors
    exact: Any = models
    wanted = values(exact, *orbit)
    rigid = values(RestitutionModel(parameters.restitution), *orbit)[:, np.newaxis]
    each = [values(corrected_model(exact[k]), *orbit) for k in range(len(exact))]
    errors[..., part] = np.abs([relative(x, wanted) for x in (rigid, np.stack(each, axis=-1))])
    return errors


def _height_threshold(
    name: str, parameters: LawErrors, ratios: np.ndarray, errors: np.ndarray
) -> float:
    """ϖ from which the restitution model's greatest height is right; NaN outside the range."""
    n, lam = parameters.n, parameters.amplitude
    rigid = RestitutionModel(parameters.restitution).require_orbit(n, lam).max_height

    def error(ratio: np.ndarray, _: np.ndarray) -> np.ndarray:
        try:
            exact = exact_models(name, parameters, np.pi / ratio)
        except (ModelError, NoOrbitError):
            return np.full(ratio.shape, np.nan)
        return relative(rigid, exact.orbit(n, lam).max_height)

    return float(thresholds(error, ratios, errors[np.newaxis], [parameters.tolerance]).ratio[0, 0])


def law_errors(parameters: LawErrors) -> xr.Dataset:
    """Errors of the restitution model and of the corrected one on all laws, along π/D.

    Moduli, shape (law, model, quantity, π/D), and the π/D from which the greatest height of the
    restitution model is right, shape (law,); NaN where there is none.
    """
    ratios = parameters.frequency_ratio.grid()
    errors = np.array([_errors(name, parameters, ratios) for name in NAMES])
    threshold = [
        _height_threshold(name, parameters, ratios, errors[k, 0, 0]) for k, name in enumerate(NAMES)
    ]
    return described(
        {
            "relative_error": (("law", "model", "quantity", "duration_ratio"), errors),
            "error_threshold": ("law", np.array(threshold)),
        },
        coords={
            "law": list(NAMES),
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "duration_ratio": ratios,
        },
    )


def _bounds(name: str, r: float, ratios: np.ndarray, n: np.ndarray) -> np.ndarray:
    """Λ of both bifurcations, shape (bound, ratio, n)."""
    model = exact_model(name, r, np.pi / ratios[:, np.newaxis], rigid_speed(n, r))
    families = np.broadcast_to(n, (len(ratios), len(n)))
    return np.array([getattr(model, bound)(families).amplitude for bound in BOUNDS])


def _domains(
    name: str, r: float, ratios: np.ndarray, n: int, top: float, points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Λ and φ along branches from the unstable side over the fold, shape (ratio, point)."""
    speed = rigid_speed(n, r)
    fold = exact_model(name, r, np.pi / ratios, speed).saddle_node(n)
    lowest, turn = fold.amplitude[:, np.newaxis], fold.phase[:, np.newaxis]
    lam = lowest + np.linspace(0.0, 1.0, points)[1:] ** 2 * (top - lowest)
    model = exact_model(name, r, np.pi / ratios[:, np.newaxis], speed)
    left, right = (model.orbit(n, lam, side).phase for side in (Side.UNSTABLE, Side.STABLE))
    return np.hstack([lam[:, ::-1], lowest, lam]), np.hstack([left[:, ::-1], turn, right])


def _held(name: str, restitution: float, ratio: float) -> float:
    """Threshold of permanent contact; NaN where no contact that just touches was found."""
    speed = rigid_speed(1, restitution)
    if name in LINEAR:
        law: Any = linear_contact(restitution, np.pi / ratio, LINEAR[name])
    else:
        law = law_of_impact(LAWS[name], restitution, np.pi / ratio, speed)
    try:
        return permanent_contact(law).amplitude
    except ModelError:
        return np.nan


def figures_of_laws(parameters: FiguresOfLaws) -> xr.Dataset:
    """Table 1 and Figs. 8, 14 and 16 on contacts of the same r and duration.

    Λ of the bifurcations, shape (law, bound, π/D, n); Λ and φ along branches, shape
    (law, π/D, point); greatest height and threshold of permanent contact, shape (law, π/D), NaN
    where a contact has no such orbit.
    """
    heights, lossy, families = parameters.heights, parameters.restitution, np.array(parameters.n)
    r, n, lam = heights.restitution, heights.n, heights.amplitude
    shown, top = np.array(parameters.frequency_ratio), parameters.amplitude_max
    points = parameters.points
    ratios = heights.frequency_ratio.grid()
    names = ("linear", *HERTZ)

    bounds = [_bounds(name, lossy, shown, families) for name in names]
    branches = [_domains(name, lossy, shown, int(families[0]), top, points) for name in names]
    amplitude, phase = map(np.array, zip(*branches, strict=True))
    height = np.full((len(names), len(ratios)), np.nan)
    for k, name in enumerate(names):
        part, models = stiff_enough(name, heights, ratios)
        if models is not None:
            height[k, part] = models.orbit(n, lam).max_height
    held = [[_held(name, r, x) for x in ratios] for name in names]
    return described(
        {
            "bifurcation_amplitude": (("law", "bound", "shown_ratio", "n"), np.array(bounds)),
            "amplitude": (("law", "shown_ratio", "point"), amplitude),
            "phase": (("law", "shown_ratio", "point"), phase),
            "max_height": (("law", "duration_ratio"), height),
            "restitution_max_height": ((), float(RestitutionModel(r).orbit(n, lam).max_height)),
            "threshold_amplitude": (("law", "duration_ratio"), np.array(held)),
        },
        coords={
            "law": list(names),
            "bound": list(BOUNDS),
            "shown_ratio": shown,
            "n": families,
            "duration_ratio": ratios,
            "point": np.arange(phase.shape[-1]),
        },
    )
