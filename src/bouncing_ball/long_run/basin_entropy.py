r"""The basin entropy of a map of basins: how uncertain the end of a ball is.

The map is covered by boxes of ε × ε starts. In box i a share p_ij of the starts ends on motion j,
and the entropy of the box is ``S_i = -Σ_j p_ij ln p_ij``. The basin entropy S_b is the mean of S_i
over all boxes, and the boundary basin entropy S_bb that over the boxes with more than one motion.
If S_bb > ln 2, the boundary is fractal: on a smooth boundary all boxes but those at isolated points
have two motions, and then S_i ≤ ln 2. The condition is sufficient and not necessary.

Source: A. Daza, A. Wagemakers, B. Georgeot, D. Guéry-Odelin and M. A. F. Sanjuán, *Basin entropy: a
new tool to analyze uncertainty in dynamical systems*, Scientific Reports 6 (2016) 31416.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError, ParameterError, suggesting


@dataclass(frozen=True)
class BasinEntropy:
    """The basin entropy of a map of basins.

    ``entropy`` is S_b, ``boundary_entropy`` S_bb, NaN if no box has more than one motion, ``boxes``
    the number of boxes, ``boundary_boxes`` that of the boxes with more than one motion, and ``box``
    the number of starts along an edge of a box.
    """

    entropy: float
    boundary_entropy: float
    boxes: int
    boundary_boxes: int
    box: int

    @property
    def is_fractal(self) -> bool:
        """Whether S_bb > ln 2, so that the boundary must be fractal; otherwise it may be."""
        return bool(self.boundary_entropy > np.log(2))


@suggesting
def basin_entropy(found: xr.Dataset, box: int = 5) -> BasinEntropy:
    """The basin entropy of a map of basins, from boxes of ``box`` × ``box`` starts.

    Parameters
    ----------
    found : Dataset
        A result of :func:`bouncing_ball.basins`. Starts that fill no whole box, at the largest
        phases and speeds, are left out.
    box : int
        The number of starts along an edge of a box, at least 2.

    Raises
    ------
    ModelError
        If the dataset is no map of basins, or if the box is larger than it.

    Examples
    --------
    Two motions whose boundary cuts through the middle of each second box:

    >>> import xarray as xr
    >>> halves = np.tile([[0, 0, 0, 1], [0, 0, 0, 1]], (2, 1))
    >>> map = xr.Dataset({"destination": (("start_speed", "start_phase"), halves)})
    >>> found = basin_entropy(map, box=2)
    >>> found.boxes, found.boundary_boxes, round(found.boundary_entropy / float(np.log(2)), 12)
    (4, 2, 1.0)
    """
    if not isinstance(found, xr.Dataset) or "destination" not in found:
        raise ModelError("basin_entropy needs the result of basins, with its destinations")
    which = found["destination"].values
    if which.ndim != 2:
        raise ModelError("basin_entropy needs the basins of one ball: select one with isel")
    if not _is_whole(box) or not 2 <= box <= min(which.shape):
        allowed = f"a whole number from 2 to {min(which.shape)}"
        raise ParameterError(f"{{box}} = {{}} is not {allowed}", repr(box))
    rows, columns = (size // box for size in which.shape)
    part = which[: rows * box, : columns * box].reshape(rows, box, columns, box)
    boxes = part.swapaxes(1, 2).reshape(rows * columns, box * box)
    motions = np.unique(boxes)
    share = np.stack([(boxes == each).mean(axis=1) for each in motions], axis=1)
    entropy = -np.sum(share * np.log(np.where(share > 0, share, 1.0)), axis=1)
    boundary = (share > 0).sum(axis=1) > 1
    return BasinEntropy(
        entropy=float(entropy.mean()),
        boundary_entropy=float(entropy[boundary].mean()) if boundary.any() else float("nan"),
        boxes=len(boxes),
        boundary_boxes=int(boundary.sum()),
        box=int(box),
    )


def _is_whole(value: Any) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)
