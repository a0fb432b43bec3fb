"""The paper's comparison on the contacts that engineers use (beyond the paper).

All laws have the same restitution coefficient r and the same duration D of the
free impact, at the impact speed of the orbit in question. A Hertz contact has no ϖ; π/D takes
its place, which is ϖ of the elastic linear contact with the same
duration. Errors are relative to the value of the exact orbit on the contact.
"""

from collections.abc import Callable
from contextlib import suppress
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
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import Signature
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
from bouncing_ball.parameters import FrequencyRatio, LawRestitution, Many, Tolerance
from bouncing_ball.studies.parameters import FamilyBranches, OrbitsAlongRatio

HERTZ = ("hunt-crossley", "tsuji", "kuwabara-kono")
LINEAR = {"linear": Release.DISPLACEMENT, "linear, force release": Release.FORCE}
NAMES = (*LINEAR, *HERTZ)
BOUNDS = (Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING)
QUANTITIES = (Quantity.MAX_HEIGHT, Quantity.BOUNCE_VELOCITY, Quantity.PHASE, *BOUNDS)


class OneOrbit(OrbitsAlongRatio):
    """One orbit on contacts of several durations; ϖ stands for π over the duration."""

    restitution: LawRestitution


class LawErrors(OneOrbit):
    """One orbit along π/D, and the relative error tolerated of its greatest height."""

    tolerance: Tolerance


class FiguresOfLaws(FamilyBranches):
    """Families whose branches are followed, and the orbit whose greatest height is shown."""

    restitution: LawRestitution
    frequency_ratio: Many[FrequencyRatio]
    heights: OneOrbit


def exact_model(
    name: str, restitution: float, duration: ArrayLike, speed: ArrayLike
) -> ImpactModel:
    """The exact models of contacts with r and D at their speeds, arrays of one shape.

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
    A linear contact has them at every speed:

    >>> float(exact_model("linear", 1.0, np.pi, 2.0).contact.frequency_ratio)
    1.0
    """
    duration, speed = np.broadcast_arrays(duration, speed)
    if name in LINEAR:
        unit = SpringDamper(1.0, damping_ratio(restitution, LINEAR[name]), LINEAR[name])
        omega = unit.free_duration / duration
        return SpringDamperModel(SpringDamper(omega, unit.damping_ratio, unit.release))
    return LawModel(law_of_impact(LAWS[name], restitution, duration, speed))


def own_models(name: str, orbit: OneOrbit, ratios: np.ndarray) -> Any:
    """The exact models of contacts with r and π/D at the impact speeds of their orbits.

    ``ratios`` are the values of π/D, shape (m,).

    Raises
    ------
    NoOrbitError, ModelError
        If a contact has no such orbit, for example because D exceeds the cycle.
    """
    r, duration = orbit.restitution, np.pi / ratios
    if name in LINEAR:
        return exact_model(name, r, duration, 1.0)
    return LawModel(law_at_orbit(LAWS[name], r, duration, orbit.n, orbit.amplitude))


def along(name: str, orbit: OneOrbit, value: Callable[[Any], np.ndarray]) -> np.ndarray:
    """A quantity of the exact models along π/D, shape (..., ϖ).

    It is NaN below the most compliant contact from which on all contacts have their orbit.

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

    The errors are moduli, shape (model, quantity, ratio); the threshold is the π/D from which on
    the error of the restitution model's greatest height is tolerable.
    """
    n, lam = parameters.n, parameters.amplitude
    rigid, asked = RestitutionModel(parameters.restitution), (n, lam, QUANTITIES)

    def both(exact: Any) -> np.ndarray:
        wanted, constant = values(exact, *asked), values(rigid, *asked)[:, np.newaxis]
        repaired = corrected_values(exact, *asked)
        return np.abs([relative(x, wanted) for x in (constant, repaired)])

    def height(ratio: np.ndarray, _: np.ndarray) -> np.ndarray:
        exact = own_models(name, parameters, ratio).orbit(n, lam)
        return relative(rigid.orbit(n, lam).max_height, exact.max_height)

    errors, ratios = along(name, parameters, both), parameters.frequency_ratio.grid()
    found = thresholds(height, ratios, errors[0, :1], [parameters.tolerance])
    return errors, float(found.ratio[0, 0])


def law_errors(parameters: LawErrors) -> xr.Dataset:
    """Errors of the restitution model and of the corrected one on all laws, along π/D.

    The dataset has ``relative_error`` (law, model, quantity, duration_ratio), the modulus, and
    ``error_threshold`` (law,), the π/D from which the greatest height of the restitution model is
    within the tolerance; NaN where there is none.

    Raises
    ------
    NoOrbitError
        If a law has the orbit at no π/D.
    """
    errors, threshold = zip(*(_errors(name, parameters) for name in NAMES), strict=True)
    return described(
        {
            "relative_error": (("law", "model", "quantity", "duration_ratio"), np.array(errors)),
            "error_threshold": ("law", list(threshold)),
        },
        coords={
            "law": list(NAMES),
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "duration_ratio": parameters.frequency_ratio.grid(),
        },
    )


def _bounds(name: str, parameters: FiguresOfLaws) -> np.ndarray:
    """Λ of both bifurcations, shape (bound, ratio, n)."""
    r, ratios = parameters.restitution, np.array(parameters.frequency_ratio)[:, np.newaxis]
    n = np.broadcast_to(parameters.n, (len(ratios), len(parameters.n)))
    model = exact_model(name, r, np.pi / ratios, rigid_speed(n, r))
    return np.array([getattr(model, bound)(n).amplitude for bound in BOUNDS])


def _domains(name: str, parameters: FiguresOfLaws) -> np.ndarray:
    """Λ and φ along branches of the first family, from the unstable side over the fold.

    Shape (2, ratio, point).
    """
    n, r, top = parameters.n[0], parameters.restitution, parameters.amplitude_max
    duration, speed = np.pi / np.array(parameters.frequency_ratio)[:, np.newaxis], rigid_speed(n, r)
    model = exact_model(name, r, duration, speed)
    fold = model.saddle_node(n)
    steps = np.linspace(0.0, 1.0, parameters.points)[1:] ** 2
    lam = fold.amplitude + steps * (top - fold.amplitude)
    left, right = (model.orbit(n, lam, side).phase for side in (Side.UNSTABLE, Side.STABLE))
    amplitudes = np.hstack([lam[:, ::-1], fold.amplitude, lam])
    return np.array([amplitudes, np.hstack([left[:, ::-1], fold.phase, right])])


def figures_of_laws(parameters: FiguresOfLaws) -> xr.Dataset:
    """Table 1 and Figs. 8, 14 and 16 on contacts of the same r and duration.

    The dataset has ``bifurcation_amplitude`` (law, bound, shown_ratio, n), values of Λ;
    ``amplitude`` and ``phase`` in rad along branches (law, shown_ratio, point); ``max_height`` and
    ``threshold_amplitude`` of permanent contact (law, duration_ratio), NaN where a contact has no
    such orbit or threshold; and the number ``restitution_max_height``. Both ratios are π/D.

    Raises
    ------
    NoOrbitError
        If a law has the orbit at no π/D.
    ModelError
        If a law has no contact with r and D.
    """
    one, names = parameters.heights, ("linear", *HERTZ)
    r, n, lam, ratios = one.restitution, one.n, one.amplitude, one.frequency_ratio.grid()
    bounds = [_bounds(name, parameters) for name in names]
    branches = np.array([_domains(name, parameters) for name in names])
    height = [along(name, one, lambda exact: exact.orbit(n, lam).max_height) for name in names]
    # NaN where the law has no such contact, or no steady motion that just touches was found.
    held = np.full((len(names), ratios.size), np.nan)
    for place in np.ndindex(held.shape):
        with suppress(ModelError):
            model = exact_model(names[place[0]], r, np.pi / ratios[place[1]], rigid_speed(1, r))
            held[place] = model.permanent_contact_threshold()
    return described(
        {
            "bifurcation_amplitude": (("law", "bound", "shown_ratio", "n"), np.array(bounds)),
            "amplitude": (("law", "shown_ratio", "point"), branches[:, 0]),
            "phase": (("law", "shown_ratio", "point"), branches[:, 1]),
            "max_height": (("law", "duration_ratio"), np.array(height)),
            "restitution_max_height": ((), float(RestitutionModel(r).orbit(n, lam).max_height)),
            "threshold_amplitude": (("law", "duration_ratio"), held),
        },
        coords={
            "law": list(names),
            "bound": list(BOUNDS),
            "shown_ratio": np.array(parameters.frequency_ratio),
            "n": np.array(parameters.n),
            "duration_ratio": ratios,
        },
    )
