"""The frequency ratio ϖ of a contact above which a rigid ball replaces it within a tolerance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.simple_models import SIMPLE, search
from bouncing_ball_beyond.drawing.result import Result
from bouncing_ball_beyond.inherited.accuracy import thresholds
from bouncing_ball_beyond.inherited.accuracy.thresholds import RATIOS, quantity_names
from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    TOLERANCE,
    AmplitudeOfOrbitAxis,
    FamilyAxis,
    ReleaseName,
    ToleranceAxis,
    checked,
    chosen,
)
from bouncing_ball_beyond.inherited.datasets.labelled import Grid
from bouncing_ball_beyond.inherited.datasets.variables import described
from bouncing_ball_beyond.inherited.errors import ParameterError, suggesting
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.rigid import RestitutionModel


@suggesting
@as_in(thresholds.error_thresholds)
def error_thresholds(
    ball: Ball,
    n: FamilyAxis = 1,
    *,
    amplitude: AmplitudeOfOrbitAxis,
    tolerance: ToleranceAxis = 0.01,
    quantities: Sequence[str] | None = None,
    release: ReleaseName = "displacement",
) -> Result:
    """The ϖ above which the restitution model and the corrected model are accurate for a contact.

    As :func:`bouncing_ball_beyond.inherited.error_thresholds`, for both simple models. An
    engineer's contact is assessed by deviations, over the value on the contact instead, so that its
    thresholds are others: an error e here is -e/(1 + e) there.

    Parameters
    ----------
    ball : Ball
        A ball made by :func:`bouncing_ball_beyond.rigid`.
    release : str
        Where a contact ends, "displacement" or "force"; its ζ is that with which a free impact has
        the r of the ball.

    Returns
    -------
    Result
        The variables of :func:`bouncing_ball_beyond.inherited.error_thresholds`. The last axes are
        ``simple``, the restitution model and the corrected one, and ``quantity``.

    Examples
    --------
    The paper's threshold of Fig. 14, printed as "≈ 82":

    >>> from bouncing_ball_beyond import rigid
    >>> found = error_thresholds(rigid(restitution=0.65), amplitude=1.0, quantities=["max_height"])
    >>> found.error_threshold.values.round(3).tolist()
    [[82.177], [2.29]]
    """
    given = a_ball(ball)
    if not isinstance(given, RestitutionModel):
        raise ParameterError("error_thresholds needs a ball made by rigid, because it finds ϖ")
    family = checked("n", n, FAMILY)
    lam = checked("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    level = checked("tolerance", tolerance, TOLERANCE)
    rule = Release.of(chosen("release", release, [str(each) for each in LINEAR]))
    asked = quantity_names(quantities)
    grid = Grid(n=family, amplitude=lam, tolerance=level, **given.parameters)
    found = _on_grid(grid, asked, rule)
    return Result.of(grid.unfold(found), "error_thresholds")


def _on_grid(grid: Grid, quantities: list[str], release: Release) -> xr.Dataset:
    """Thresholds and statuses over (case, simple, quantity), a search for each tolerance."""
    zeta = damping_ratio(grid.row("restitution"), release)
    n = grid.row("n")
    amplitude = grid.row("amplitude")
    tolerance = grid.row("tolerance")
    dims = (CASE, "simple", "quantity")
    threshold = np.full((grid.size, len(SIMPLE), len(quantities)), np.nan)
    status = np.full(threshold.shape, "", dtype=object)
    for level in np.unique(tolerance):
        here = tolerance == level
        found = search(
            zeta=zeta[here],
            rule=release,
            n=n[here],
            amplitude=amplitude[here],
            ratios=RATIOS,
            tolerance=float(level),
            quantities=quantities,
        )
        threshold[here] = np.moveaxis(found.threshold, -1, 0)
        status[here] = np.moveaxis(found.status, -1, 0)
    return described(
        {"error_threshold": (dims, threshold), "threshold_status": (dims, status.astype(str))},
        {"simple": list(SIMPLE), "quantity": quantities},
    )
