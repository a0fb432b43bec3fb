"""The paper's comparison for contact laws that engineers use (beyond the paper).

All laws have the same restitution coefficient r and the same centroid t_c of the force of the free
impact. If D is the duration of the free impact and κ = -δ_b/δ′_b at its end,
t_c = r (D + κ)/(1 + r) for every law, and to first order the errors depend on D only through t_c. A
Hertz contact has no ϖ. It is replaced by π/(D + κ), the ϖ of the elastic linear contact with the
same D + κ. Errors are relative to the simple model as in Eqs. 37-38.

For most laws r and t_c depend on the impact speed, so that a contact must be *calibrated*: it gets
the given r and t_c at one speed. This is the relative speed |δ′_i| at which the ball hits the
contact on the orbit in question, which is found together with the contact. Thresholds are also
given for contacts that are calibrated at the impact speed of the restitution model's orbit,
v₀ = 2nπ/(1 + r). Both speeds differ by a term of order 1/ϖ. If r depends on the speed, this changes
the error of the restitution model in its first order, and so a threshold by a share that does not
vanish for small tolerances.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from itertools import product
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from bouncing_ball_beyond.accuracy.errors import paper_error, values
from bouncing_ball_beyond.accuracy.simple_models import SIMPLE
from bouncing_ball_beyond.accuracy.thresholds import last_zero
from bouncing_ball_beyond.exhibits.orbit_parameters import OrbitParameters, OrbitsAlongRatio
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.datasets.parameters import Many, Tolerance, number
from bouncing_ball_beyond.inherited.datasets.variables import Variable, described
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.named_laws import LAWS
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.law_at_orbit import orbit_of_law
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

VARIABLES = {
    "law": Variable("law of the contact"),
    "centroid_ratio": Variable(
        "π over D + κ of the free impact, which stands for the frequency ratio", symbol="π/(D+κ)"
    ),
    "calibration": Variable(
        "orbit at whose relative impact speed |δ′_i| the contact has the given r and centroid"
    ),
    "error_calibration": Variable("calibration of the contacts of the relative errors"),
    "law_error_zero": Variable(
        "π over D + κ at which the error passes through zero", symbol="π/(D+κ)", budget=1e-08
    ),
    "stable_at_threshold": Variable("whether the orbit at the threshold is stable and admissible"),
}


class Calibration(StrEnum):
    """The orbit at whose impact speed a contact has the given r and centroid."""

    CONTACT = "orbit on the contact"
    """At |δ′_i| of the orbit on the contact itself."""
    RESTITUTION = "orbit of the restitution model"
    """At v₀ = 2nπ/(1 + r)."""


HERTZ = ("hunt-crossley", "tsuji", "kuwabara-kono")
LINEAR = {"linear": Release.DISPLACEMENT, "linear, force release": Release.FORCE}
NAMES = (*LINEAR, *HERTZ)
BOUNDS = (Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING)
# Distances in ln ϖ from a first estimate of a threshold to the orbits that locate it.
_BESIDE = np.linspace(-0.02, 0.02, 5)
QUANTITIES = (Quantity.MAX_HEIGHT, Quantity.BOUNCE_VELOCITY, Quantity.PHASE, *BOUNDS)


LawRestitution = Annotated[
    float, number("restitution coefficient r that contacts of every law can have", ge=0.3, le=0.99)
]


class LawOrbit(OrbitParameters):
    """An orbit on contacts of all laws."""

    restitution: LawRestitution


class LawErrors(OrbitsAlongRatio):
    """One orbit on contacts of several durations, and the tolerated relative error of its greatest
    height; ``frequency_ratio`` stands for π/(D + κ). Of ``further`` orbits only the thresholds of
    the height are computed.
    """

    restitution: LawRestitution
    tolerance: Tolerance
    further: Many[LawOrbit]


@lru_cache
def share_in_contact(name: str, restitution: float) -> float:
    """D/(D + κ) of the free impact, which depends on the law and on r alone.

    Examples
    --------
    A contact that ends at δ = 0 has κ = 0:

    >>> share_in_contact("linear", 0.5)
    1.0
    """
    impact = exact_model(name, restitution, 1.0, 1.0).signature(1.0)
    return float(impact.restitution / ((1 + impact.restitution) * impact.delay))


def exact_model(name: str, restitution: float, duration: ArrayLike, speed: ArrayLike) -> Model:
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

    >>> float(exact_model("linear", 1.0, np.pi, 2.0).law.frequency_ratio)
    1.0
    """
    duration, speed = np.broadcast_arrays(duration, speed)
    if name in LINEAR:
        return ContactModel(SpringDamper.of_impact(restitution, duration, LINEAR[name]))
    return ContactModel(law_of_impact(LAWS[name], restitution, duration, speed))


@dataclass(frozen=True)
class CalibratedContacts:
    """Contacts of one law with the r of an orbit and with several π/(D + κ), at one impact speed.

    ``law`` is one of :data:`NAMES`.
    """

    law: str
    orbit: OrbitParameters
    calibration: Calibration = Calibration.CONTACT

    def orbits(self, ratios: np.ndarray) -> Orbit:
        """The orbits on the contacts; ``ratios`` are π/(D + κ), shape (m,).

        Raises
        ------
        NoOrbitError, ModelError
            If a contact has no such orbit, for example because D exceeds the cycle.
        """
        one = self.orbit
        r = one.restitution
        duration = np.pi / ratios * share_in_contact(self.law, r)
        # A linear contact has the same r and D at every speed.
        if self.law in LINEAR or self.calibration is Calibration.RESTITUTION:
            model = exact_model(self.law, r, duration, rigid_speed(one.n, r))
            return n_t.orbit(model, one.n, one.amplitude)
        return orbit_of_law(LAWS[self.law], r, duration, one.n, one.amplitude)

    def along(self, ratios: np.ndarray, value: Callable[[Orbit], np.ndarray]) -> np.ndarray:
        """A quantity of the orbits along π/(D + κ), shape (..., m).

        It is NaN for contacts below the smallest π/(D + κ) above which all contacts have the orbit.

        Raises
        ------
        NoOrbitError
            If no contact has the orbit.
        """
        for first in range(ratios.size):
            with suppress(ModelError, NoOrbitError):
                found = value(self.orbits(ratios[first:]))
                return np.concatenate([np.full((*found.shape[:-1], first), np.nan), found], axis=-1)
        one = self.orbit
        raise NoOrbitError(
            f"no {self.law} contact has the {one.n}-T orbit at Λ = {one.amplitude:g}"
        )

    def height_error(self, ratios: np.ndarray) -> np.ndarray:
        """Moduli of the relative errors of the restitution model's greatest height, shape (m,)."""
        one = self.orbit
        simple = n_t.orbit(RestitutionModel(one.restitution), one.n, one.amplitude).max_height
        exact = self.along(ratios, lambda orbits: orbits.max_height)
        return np.abs(paper_error(exact=exact, simple=simple))

    def threshold(self, ratios: np.ndarray, error: np.ndarray, tolerance: float) -> float:
        """The π/(D + κ) at which the error of the greatest height is the tolerance.

        It is searched for along ``ratios``, which increase and have these errors, and NaN if it is
        not among them.
        """
        outside = np.flatnonzero(error > tolerance)
        if not outside.size or outside[-1] == ratios.size - 1:
            return np.nan
        # ln(error/tolerance) is nearly a straight line in ln ϖ. Its zero is first interpolated
        # between two nodes, and then by the polynomial through nearby orbits, which is exact to
        # rounding.
        sides = outside[-1] + np.arange(2)
        guess = np.interp(0, -np.log(error[sides] / tolerance), np.log(ratios[sides]))
        nearby = self.height_error(np.exp(guess + _BESIDE))
        line = Polynomial.fit(np.log(nearby / tolerance), _BESIDE, _BESIDE.size - 1)
        return float(np.exp(guess + line(0.0)))

    def is_stable(self, ratio: float) -> bool:
        """Whether the orbit at one π/(D + κ) is stable and admissible; False for NaN."""
        if np.isnan(ratio):
            return False
        found = self.orbits(np.array([ratio]))
        return bool(np.all(found.is_stable() & found.is_admissible()))


def corrected_values(exact: Any, *asked: Any) -> np.ndarray:
    """Quantities in the corrected restitution models of contacts, shape (quantity, ϖ)."""
    return values(CorrectedModel.of_contact(exact.impact_law), *asked)


def _errors(name: str, parameters: LawErrors) -> tuple[np.ndarray, np.ndarray]:
    """Relative errors of both simple models, shape (model, quantity, ratio), and the largest
    π/(D + κ) at which each is zero, shape (model, quantity).
    """
    n = parameters.n
    lam = parameters.amplitude
    rigid = RestitutionModel(parameters.restitution)

    def of_both_models(orbits: Orbit) -> np.ndarray:
        exact = orbits.model
        wanted = values(exact, n, lam, QUANTITIES)
        constant = values(rigid, n, lam, QUANTITIES)[:, np.newaxis]
        simple = constant, corrected_values(exact, n, lam, QUANTITIES)
        return np.array([paper_error(exact=wanted, simple=each) for each in simple])

    contacts = CalibratedContacts(name, parameters)
    ratios = parameters.frequency_ratio.grid()
    found = contacts.along(ratios, of_both_models)
    rows = found.reshape(-1, ratios.size)

    def single(ratio: np.ndarray, row: np.ndarray) -> np.ndarray:
        there = contacts.along(ratio, of_both_models)
        return there.reshape(-1, ratio.size)[row, np.arange(ratio.size)]

    return found, last_zero(single, ratios, rows).reshape(found.shape[:-1])


def law_errors(parameters: LawErrors) -> xr.Dataset:
    """Errors of the restitution model and of the corrected one on all laws, along π/(D + κ).

    The dataset has ``relative_error`` (law, model, quantity, centroid_ratio), the modulus, on
    contacts calibrated as ``error_calibration`` says; ``law_error_zero`` (law, model, quantity),
    the largest π/(D + κ) at which such an error is zero; and ``error_threshold`` (case,
    calibration, law), the π/(D + κ) from which on the greatest height of the restitution model is
    within the tolerance, NaN where there is none on the grid, with ``stable_at_threshold``. The
    first case is the orbit of the errors, the others are the ``further`` orbits, with ``n``,
    ``restitution`` and ``amplitude`` (case,).

    Raises
    ------
    NoOrbitError
        If a law has an orbit at no π/(D + κ).
    """
    ratios = parameters.frequency_ratio.grid()
    cases: list[OrbitParameters] = [parameters, *parameters.further]
    found = {name: _errors(name, parameters) for name in NAMES}
    errors = {name: np.abs(each) for name, (each, _) in found.items()}
    zeros = [zero for _, zero in found.values()]
    shape = len(cases), len(Calibration), len(NAMES)
    threshold = np.empty(shape)
    stable = np.empty(shape, dtype=bool)
    for place, (case, calibration, name) in zip(
        np.ndindex(shape), product(cases, Calibration, NAMES), strict=True
    ):
        contacts = CalibratedContacts(name, case, calibration)
        # Those of the first orbit are known: the first model and the first quantity.
        known = case is parameters and calibration is Calibration.CONTACT
        error = errors[name][0, 0] if known else contacts.height_error(ratios)
        threshold[place] = contacts.threshold(ratios, error, parameters.tolerance)
        stable[place] = contacts.is_stable(float(threshold[place]))
    by_case = ("case", "calibration", "law")
    return described(
        {
            "relative_error": (
                ("law", "model", "quantity", "centroid_ratio"),
                np.array(list(errors.values())),
            ),
            "law_error_zero": (("law", "model", "quantity"), np.array(zeros)),
            "error_calibration": str(Calibration.CONTACT),
            "error_threshold": (by_case, threshold),
            "stable_at_threshold": (by_case, stable),
        },
        coords={
            "n": ("case", [case.n for case in cases]),
            "restitution": ("case", [case.restitution for case in cases]),
            "amplitude": ("case", [case.amplitude for case in cases]),
            "law": list(NAMES),
            "model": list(SIMPLE),
            "quantity": list(QUANTITIES),
            "centroid_ratio": ratios,
            "calibration": list(map(str, Calibration)),
        },
        variables=VARIABLES,
    )
