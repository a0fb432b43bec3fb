"""The frequency ratio ϖ that a tolerance needs, from a root of the exact deviation over ϖ."""

import math
from dataclasses import dataclass

import numpy as np

from bouncing_ball_beyond.accuracy.error_law import law_thresholds, permanent_contact_ratio
from bouncing_ball_beyond.accuracy.errors import OF_ORBITS, as_deviation
from bouncing_ball_beyond.accuracy.simple_models import search
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import RATIOS
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper


@dataclass(frozen=True)
class Needed:
    """The frequency ratio above which the error of a quantity stays within a tolerance ε.

    The error is the deviation (q - q_SD)/q_SD from the value q_SD on the contact
    (:func:`~bouncing_ball_beyond.accuracy.errors.deviation`).

    ``frequency_ratio`` is the largest ϖ at which the error of the restitution model crosses the
    tolerance, and ``corrected`` that of the corrected model. ``by_law`` is the ϖ that the error
    law gives (:func:`~bouncing_ball_beyond.accuracy.error_law.law_thresholds`). A value that does
    not exist is None, and ``status`` or ``corrected_status``, otherwise "found", gives the reason.
    """

    quantity: str
    tolerance: float
    frequency_ratio: float | None
    by_law: float | None
    corrected: float | None
    status: str
    corrected_status: str


def finite(value: float | np.ndarray) -> float | None:
    """The value as a Python float; None if it is NaN or infinite."""
    return float(value) if math.isfinite(value) else None


def _by_law(
    quantity: Quantity, unit: SpringDamper, n: int, amplitude: float, allowed: tuple[float, float]
) -> float | None:
    if quantity is Quantity.PERMANENT_CONTACT:
        return finite(permanent_contact_ratio(unit.damping_ratio, unit.release, allowed))
    return finite(law_thresholds(n, Signature(unit)(), amplitude, allowed)[quantity])


NO_ORBIT = "no orbit"
"""A status in addition to
:class:`~bouncing_ball_beyond.inherited.accuracy.thresholds.ThresholdStatus`."""


def needed(
    quantity: str, tolerance: float, contact: SpringDamper, n: int, amplitude: float
) -> Needed:
    """The ϖ that a tolerance needs, for contacts with the ζ and the release of a given contact.

    Parameters
    ----------
    quantity : str
        One of :class:`~bouncing_ball_beyond.inherited.accuracy.errors.Quantity`.
    tolerance : float
        Largest modulus of the deviation from the contact that is allowed.
    contact : SpringDamper
    n : int
    amplitude : float
        Λ.

    Examples
    --------
    Without damping the threshold is Λ_SD = 1 - 1/ϖ², for which the restitution model has 1, so
    that it deviates by 1/(ϖ² - 1):

    >>> found = needed("permanent_contact", 0.01, SpringDamper(5.0, 0.0), 1, 1.0)
    >>> round(found.frequency_ratio**2, 9), round(found.by_law**2, 9)
    (101.0, 101.0)
    """
    zeta = contact.damping_ratio
    rule = contact.release
    # The error law of a limit does not depend on Λ. A Λ too small for an orbit is therefore
    # replaced by nπ, which is above the saddle-node.
    there = amplitude if quantity in OF_ORBITS else max(amplitude, n * np.pi)
    # The paper's errors of which the deviations are the tolerance and its opposite.
    allowed = -tolerance / (1 + tolerance), tolerance / (1 - tolerance)
    try:
        by_law = _by_law(Quantity(quantity), SpringDamper(1.0, zeta, rule), n, there, allowed)
    except NoOrbitError:
        return Needed(
            quantity=quantity,
            tolerance=tolerance,
            frequency_ratio=None,
            by_law=None,
            corrected=None,
            status=NO_ORBIT,
            corrected_status=NO_ORBIT,
        )
    found = search(
        zeta,
        rule,
        n=n,
        amplitude=amplitude,
        ratios=RATIOS,
        tolerance=tolerance,
        quantities=(quantity,),
        measure=as_deviation,
    )
    simple, corrected = found.threshold[:, 0, 0]
    status, corrected_status = found.status[:, 0, 0]
    return Needed(
        quantity=quantity,
        tolerance=tolerance,
        frequency_ratio=finite(simple),
        by_law=by_law,
        corrected=finite(corrected),
        status=str(status),
        corrected_status=str(corrected_status),
    )
