"""The stiffness that a tolerance needs, from a root of the exact error over ϖ."""

import numpy as np

from bouncing_ball.accuracy.error_law import law_thresholds
from bouncing_ball.accuracy.quantities import OF_ORBITS, Quantity
from bouncing_ball.accuracy.thresholds import search
from bouncing_ball.calculator.families import finite
from bouncing_ball.calculator.results import Needed
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import NoOrbitError

# From contacts that last a considerable part of the table's period to contacts stiffer than those
# of any simulation. The grid is fine, so that two crossings hardly fall between neighbours.
RATIOS = np.geomspace(1.0, 1e6, 97)

NO_ORBIT = "no orbit"
"""A status in addition to :class:`~bouncing_ball.accuracy.thresholds.ThresholdStatus`."""


def needed(
    quantity: str, tolerance: float, contact: SpringDamper, n: int, amplitude: float
) -> Needed:
    """The ϖ that a tolerance needs, for contacts with the ζ and the release of a given contact.

    Parameters
    ----------
    quantity : str
        One of :class:`~bouncing_ball.accuracy.quantities.Quantity`.
    tolerance : float
        Largest relative error allowed.
    contact : SpringDamper
    n : int
    amplitude : float
        Λ.

    Examples
    --------
    Λ_SD = 1 - 1/ϖ² without damping:

    >>> found = needed("permanent_contact", 0.01, SpringDamper(5.0, 0.0), 1, 1.0)
    >>> round(found.frequency_ratio, 12), round(found.by_law, 12)
    (10.0, 10.0)
    """
    zeta, rule = contact.damping_ratio, contact.release
    # The error law of a limit does not depend on Λ. A Λ too small for an orbit is therefore
    # replaced by nπ, which is above the saddle-node.
    there = amplitude if quantity in OF_ORBITS else max(amplitude, n * np.pi)
    try:
        by_law = finite(law_thresholds(n, zeta, there, rule, tolerance)[Quantity(quantity)])
    except NoOrbitError:
        return Needed(quantity, tolerance, None, None, None, NO_ORBIT, NO_ORBIT)
    found = search(zeta, rule, n, amplitude, RATIOS, tolerance, (quantity,))
    ratio, corrected = map(finite, found.threshold[:, 0, 0])
    return Needed(quantity, tolerance, ratio, by_law, corrected, *map(str, found.status[:, 0, 0]))
