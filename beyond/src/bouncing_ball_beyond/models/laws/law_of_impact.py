"""The contact law with a given restitution coefficient and contact duration.

In units of the scales P and P/v the restitution of a free impact depends on a single number,
the law's *group*, which is C v, C, C v/P or ζ. The group follows from r and is computed once;
the duration D then gives P, and the group and P give the parameters of the law.
"""

from functools import lru_cache
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, require
from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw

Law = TypeVar("Law", bound=ContactLaw)
# Groups tried in turn until r is below the required one, and the absolute error of the result.
_GROUPS = [0.25 * 2.0**k for k in range(8)]
_SETTLED = 1e-15


def _free(kind: type[ContactLaw], group: float):
    """r and D of the free impact with this group, in units of the scales."""
    impact = kind.of_scales(group, 1.0, 1.0).signature(1.0)
    return float(impact.restitution), float(impact.duration)


@lru_cache(maxsize=1024)
def reference(kind: type[ContactLaw], restitution: float) -> tuple[float, float]:
    """The group that gives a restitution coefficient r, and D v/P of its free impact.

    Raises
    ------
    ModelError
        If r is not in (0, 1], or so small that no group was found that gives it.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji
    >>> group, _ = reference(Tsuji, 1.0)
    >>> group
    0.0
    """
    require(0 < restitution <= 1, restitution, "restitution coefficient r", "in (0, 1]")
    exact = kind.group_of(restitution)
    if exact is None:
        exact = 0.0 if restitution == 1 else _search(kind, restitution)
    return exact, _free(kind, exact)[1]


def _search(kind: type[ContactLaw], restitution: float) -> float:

    def surplus(group):
        return np.log(_free(kind, group)[0] / restitution)

    # A law that cannot be given by its impact raises its error here.
    kind.of_scales(_GROUPS[0], 1.0, 1.0)
    try:
        enough = next(group for group in _GROUPS if surplus(group) <= 0)
    except (ModelError, StopIteration):
        raise ModelError(
            f"restitution coefficient r = {restitution:g} is too small: no {kind.name} contact "
            "with it was found; damped so strongly, the ball hardly leaves"
        ) from None
    return scipy.optimize.brentq(surplus, 0.0, enough, xtol=_SETTLED, rtol=4 * np.finfo(float).eps)


def law_of_impact(
    kind: type[Law], restitution: float, duration: ArrayLike, speed: ArrayLike
) -> Law:
    """The law whose free impact of speed v has the restitution r and the duration D.

    The search answers which of all laws of a kind has an impact at a known speed. It has one
    unknown, the group, whose r it meets; D then follows in closed form.

    Parameters
    ----------
    kind : type of ContactLaw
    restitution : float
        r in (0, 1].
    duration, speed : array_like
        D > 0 and v > 0.

    Returns
    -------
    ContactLaw
        A law of this kind, of the shape to which D and v broadcast.

    Raises
    ------
    ModelError
        If an argument is out of its range, or no law of this kind has these r and D.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley
    >>> law = law_of_impact(HuntCrossley, 0.65, 0.1, 3.8)
    >>> impact = law.signature(3.8)
    >>> round(float(impact.restitution), 12), round(float(impact.duration), 12)
    (0.65, 0.1)
    """
    given = np.asarray(duration, dtype=float)
    v = np.asarray(speed, dtype=float)
    check_positive(given, "contact duration D")
    check_positive(v, "impact speed v")
    group, taken = reference(kind, float(restitution))
    try:
        with np.errstate(all="ignore"):
            return kind.of_scales(group, given * v / taken, v)
    except ModelError:
        raise ModelError(
            f"a {kind.name} contact of duration D = {given} at the impact speed v = {v} "
            "has no stiffness within the range of floating-point numbers"
        ) from None
