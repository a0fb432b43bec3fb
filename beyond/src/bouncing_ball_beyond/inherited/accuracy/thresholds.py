r"""The frequency ratio ϖ above which an error stays within a tolerance (Eqs. 37-38).

The paper calls ϖ_h,1% and ϖ_PC,1% the values of ϖ at which the errors of the greatest height
(Eq. 37) and of the threshold of permanent contact (Eq. 38) are 1 %. Here the threshold of any
quantity is the largest ϖ in a scanned range at which the modulus of its error crosses the
tolerance. Where a model lacks the quantity, the error is infinite.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.accuracy.errors import Quantity, modulus, relative_errors
from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    TOLERANCE,
    AmplitudeOfOrbitAxis,
    FamilyAxis,
    ToleranceAxis,
    checked,
    chosen,
)
from bouncing_ball_beyond.inherited.errors import ParameterError, suggesting
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.model import Model, a_ball
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper

if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.drawing.result import Result

Numbered = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Values, at ratios ϖ, of the functions with given numbers; all three arrays have one shape."""

RATIOS = np.geomspace(1.0, 1e6, 97)
"""ϖ at which errors are scanned, from contacts that last a considerable part of the table's period
to contacts stiffer than those of any simulation. The steps are fine, so that two crossings hardly
fall between neighbours."""
# Errors are bounded for the root finder, because they may be zero or infinite.
_SMALLEST, _LARGEST = 1e-300, 1e3
# Tolerance of ln ϖ: rounding an error of 0.1 % moves its threshold by about this much.
_CLOSE = 1e-13


class ThresholdStatus(StrEnum):
    """Outcome of the search for a threshold: found, within the tolerance at every ϖ scanned, or
    outside it at the largest.
    """

    FOUND = "found"
    ALWAYS_WITHIN = "within"
    NEVER_WITHIN = "outside"


class Thresholds(NamedTuple):
    """Thresholds and the outcomes of the searches for them, arrays of one shape."""

    ratio: np.ndarray
    """ϖ; NaN where the status is not ``FOUND``."""
    status: np.ndarray


def last_crossing(function: Numbered, ratios: np.ndarray, scanned: np.ndarray) -> np.ndarray:
    """The largest ϖ at which each function changes its sign.

    The last change between two samples is located to the last digit; an even number of changes
    between two samples is not noticed.

    Parameters
    ----------
    function : callable
        Values of the functions; see :data:`Numbered`.
    ratios : ndarray, shape (N,)
        Increasing grid.
    scanned : ndarray, shape (k, N)
        The k functions on the grid; a change next to a NaN does not count.

    Returns
    -------
    ndarray, shape (k,)
        NaN for a function that does not change its sign.

    Examples
    --------
    >>> grid, levels = np.geomspace(1, 1e4, 9), np.array([0.01, 2.0])
    >>> scanned = 1 / grid - levels[:, np.newaxis]
    >>> last_crossing(lambda ratio, which: 1 / ratio - levels[which], grid, scanned).round(9)
    array([100.,  nan])
    """
    # This module of scipy is not loaded on first use, and its import takes a third of a second.
    from scipy.optimize.elementwise import find_root

    known = np.isfinite(scanned)
    turns = (scanned[:, 1:] > 0) != (scanned[:, :-1] > 0)
    turns &= known[:, 1:] & known[:, :-1]
    which = np.flatnonzero(turns.any(axis=1))
    found = np.full(len(scanned), np.nan)
    if not which.size:
        return found
    last = turns.shape[1] - 1 - np.argmax(turns[which, ::-1], axis=1)
    bracket = (np.log(ratios[last]), np.log(ratios[last + 1]))
    with np.errstate(invalid="ignore"):  # from an interpolation that find_root rejects
        root = find_root(
            lambda x, k: function(np.exp(x), k.astype(int)),
            bracket,
            args=(which,),
            tolerances={"xatol": _CLOSE},
        )
    # If a sample lies at the root, rounding may change its sign; the root is then the sample.
    at_ends = np.abs(root.f_bracket)
    end = np.where(at_ends[0] < at_ends[1], *bracket)
    found[which] = np.exp(np.where(root.success, root.x, end))
    return found


def thresholds(
    error: Numbered, ratios: np.ndarray, scanned: np.ndarray, tolerances: ArrayLike
) -> Thresholds:
    """The ϖ above which each error stays within each tolerance, shape (k, m).

    Parameters
    ----------
    error : callable
        Signed relative errors.
    ratios : ndarray, shape (N,)
        Increasing grid.
    scanned : ndarray, shape (k, N)
        The k errors on the grid.
    tolerances : array_like, shape (m,)

    Examples
    --------
    >>> grid = np.geomspace(1, 1e4, 50)
    >>> thresholds(lambda ratio, _: 1 / ratio, grid, 1 / grid[np.newaxis], [0.01, 2.0]).ratio
    array([[100.,  nan]])
    """
    level = np.atleast_1d(np.asarray(tolerances, dtype=float))
    size = modulus(scanned)[:, np.newaxis]
    tolerance = level[:, np.newaxis]

    def crossing(ratio: np.ndarray, number: np.ndarray) -> np.ndarray:
        which, place = np.divmod(number, level.size)
        return _excess(error(ratio, which), level[place])

    outside = size > tolerance
    rows = _excess(size, tolerance).reshape(-1, ratios.size)
    found = last_crossing(crossing, ratios, rows).reshape(outside.shape[:2])
    never = outside[..., -1]
    always = ~outside.any(axis=-1)
    within = np.where(always, ThresholdStatus.ALWAYS_WITHIN, ThresholdStatus.FOUND)
    status = np.where(never, ThresholdStatus.NEVER_WITHIN, within)
    return Thresholds(np.where(never, np.nan, found), status)


def _excess(error: np.ndarray, tolerance: np.ndarray) -> np.ndarray:
    """The logarithm of an error over its tolerance, which is nearly a straight line in ln ϖ."""
    return np.log(np.clip(modulus(error), _SMALLEST, _LARGEST) / tolerance)


class Search(NamedTuple):
    """Errors along ϖ of several orbits, and the ϖ above which they are tolerable.

    ``error`` are the signed errors on the grid, shape (quantity, orbit, ϖ); ``threshold`` is a ϖ,
    NaN where the ``status`` is not ``FOUND``, shape (quantity, orbit, tolerance).
    """

    error: np.ndarray
    threshold: np.ndarray
    status: np.ndarray


def search(
    damping: ArrayLike,
    release: Release,
    restitution: ArrayLike,
    n: ArrayLike,
    amplitude: ArrayLike,
    *,
    ratios: np.ndarray,
    tolerances: Sequence[float],
    quantities: Sequence[str],
) -> Search:
    """Thresholds of the errors of the restitution model for contacts with a spring and a damper.

    Parameters
    ----------
    damping : array_like
        ζ of the contact.
    release : Release
    restitution : array_like
        r of the restitution model.
    n, amplitude : array_like
        Index of the family and Λ of each orbit. All arrays broadcast to shape (orbit,).
    ratios : ndarray, shape (N,)
        Increasing grid of ϖ.
    tolerances : sequence of float
        The tolerated moduli of the error.
    quantities : sequence of str

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² (Eq. 38):

    >>> found = search(
    ...     0.0, Release.DISPLACEMENT, 1.0, 1, 1.0,
    ...     ratios=np.geomspace(1.0, 1e3, 31), tolerances=[0.01], quantities=["permanent_contact"],
    ... )
    >>> found.threshold.round(9).tolist()
    [[[10.0]]]
    """
    orbits = np.broadcast_arrays(*map(np.atleast_1d, (damping, restitution, n, amplitude)))

    def errors(ratio: np.ndarray, orbit: np.ndarray, wanted: Sequence[str]) -> np.ndarray:
        zeta, r, family, lam = (each[orbit] for each in orbits)
        return relative_errors(
            SpringDamper(ratio, zeta, release), RestitutionModel(r), family, lam, wanted
        )

    count = orbits[0].size
    orbit, place = np.divmod(np.arange(count * ratios.size), ratios.size)
    error = errors(ratios[place], orbit, quantities).reshape(-1, count, ratios.size)

    def error_of(quantity: str) -> Numbered:
        return lambda ratio, orbit: errors(ratio, orbit, [quantity])[0]

    found = [
        thresholds(error_of(quantity), ratios, scanned, tolerances)
        for quantity, scanned in zip(quantities, error, strict=True)
    ]
    ratio = np.stack([each.ratio for each in found])
    return Search(error, ratio, np.stack([each.status for each in found]))


@suggesting
def error_thresholds(
    ball: Model,
    n: FamilyAxis = 1,
    *,
    amplitude: AmplitudeOfOrbitAxis,
    tolerance: ToleranceAxis = 0.01,
    quantities: Sequence[str] | None = None,
) -> Result:
    """The ϖ above which the restitution model is accurate for a contact with a spring and a damper.

    The contact has the paper's release and, by Eq. 16, the r of the ball as the restitution
    coefficient of a free impact. The error of a quantity is its value on the contact minus its
    value in the restitution model, over the latter (Eqs. 37-38).

    Parameters
    ----------
    ball : Model
        A ball made by :func:`bouncing_ball_beyond.inherited.rigid`.
    n : int or array of int
        Index n of the family.
    amplitude : float or array
        Excitation amplitude Λ > 0 of the stable orbit.
    tolerance : float or array
        Largest modulus of this error.
    quantities : sequence of str, optional
        The quantities compared; by default all: "max_height", "bounce_velocity", "phase",
        "apparent_restitution", "saddle_node", "period_doubling" and "permanent_contact".

    Returns
    -------
    Result
        ``error_threshold``, ϖ between 1 and 10⁶, and ``threshold_status``: "found", "within" the
        tolerance at every ϖ, or "outside" at the largest ϖ; the threshold is then NaN. The last
        axis is ``quantity``.

    Raises
    ------
    ModelError
        If a parameter is of a wrong type or shape, or out of range, or the ball is not rigid.

    Examples
    --------
    The paper's threshold of Fig. 14, printed as "≈ 82":

    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = error_thresholds(rigid(restitution=0.65), amplitude=1.0, quantities=["max_height"])
    >>> found.error_threshold.values.round(3).tolist()
    [82.177]
    """
    import xarray as xr

    from bouncing_ball_beyond.inherited.datasets.labelled import Grid
    from bouncing_ball_beyond.inherited.datasets.variables import describe
    from bouncing_ball_beyond.inherited.drawing.result import Result

    if not isinstance(a_ball(ball), RestitutionModel):
        raise ParameterError("error_thresholds needs a ball made by rigid, because it finds ϖ")
    wanted = quantity_names(quantities)
    grid = Grid(
        n=checked("n", n, FAMILY),
        amplitude=checked("amplitude", amplitude, AMPLITUDE_OF_ORBIT),
        tolerance=checked("tolerance", tolerance, TOLERANCE),
        **ball.parameters,
    )
    r, family, lam = (grid.row(name) for name in ("restitution", "n", "amplitude"))
    zeta = damping_ratio(r)
    threshold = np.full((grid.size, len(wanted)), np.nan)
    status = np.full(threshold.shape, "", dtype=object)
    for level in np.unique(grid.row("tolerance")):
        here = np.flatnonzero(grid.row("tolerance") == level)
        found = search(
            zeta[here],
            Release.DISPLACEMENT,
            r[here],
            family[here],
            lam[here],
            ratios=RATIOS,
            tolerances=[level],
            quantities=wanted,
        )
        threshold[here] = found.threshold[..., 0].T
        status[here] = found.status[..., 0].T
    dims = (CASE, "quantity")
    columns = {"error_threshold": (dims, threshold), "threshold_status": (dims, status.astype(str))}
    rows = describe(xr.Dataset(columns, {"quantity": wanted}))
    return Result.of(grid.unfold(rows), "error_thresholds")


def quantity_names(quantities: Any) -> list[str]:
    """The names of the quantities that a user asks for, one name or several, or None for all.

    Raises
    ------
    ModelError
        If there is no such quantity.
    """
    if quantities is None:
        return [str(each) for each in Quantity]
    try:
        names = [quantities] if isinstance(quantities, str) else list(quantities)
    except TypeError:
        names = [quantities]
    if not names:
        raise ParameterError("{quantities} has no entries")
    return [chosen("quantities", name, [str(each) for each in Quantity]) for name in names]
