"""The change of a variable from the accepted record that the comparison allows: its budget.

A drift is |new - record| over the range of the record's values, or over ``scale``. Texts,
counts and truth values are compared exactly. The budget of a variable is in its row of
:mod:`bouncing_ball.datasets.variables`; those of single artifacts are in ``budgets.csv``, each
with its source. Where that says nothing else they come from the convergence study, a test that
varies tolerances, grids and rounding: each is the power of ten next above ten times the largest
change.
"""

import math
from typing import NamedTuple

from bouncing_ball.datasets.files import rows_beside
from bouncing_ball.datasets.variables import BUDGETS


class Budget(NamedTuple):
    """The largest change allowed of a variable, as a share of its scale: "1", or another variable.

    Without a scale it is a share of the range of the record's values.
    With ``over`` two curves are compared, through the samples along the dimension
    ``point`` and over that variable, because the samples may slide along the curve.
    So large a ``share`` of the entries, of texts and counts too, may be beyond the budget, because
    rounding decides there.
    """

    size: float
    scale: str = ""
    over: str = ""
    share: float = 0.0


ROUNDING = 1e-13
"""The smallest budget, for variables without another one."""
IGNORED = math.inf
"""The budget of variables that another dataset has as well, or that rounding decides about;
``inf`` in the tables."""
PICTURE = 1.0
"""Root mean square difference of two pictures allowed, in grey levels of 255.

Parameters that differ by two units in the last place, which change every rounding as another
processor does, move the pixels of a figure by 0.092 at most (Fig. 15). The budget is the power of
ten next above ten times that."""

PICTURES = {"ext_diagram": 60.0, "ext_locking": 40.0, "ext_means": 60.0, "ext_locked": 40.0}
"""Pictures of motions about which rounding decides: three times the 19 and 12 grey levels by which
a change of 1e-15 in the start moves them."""

ARTIFACTS: dict[str, dict[str, Budget]] = {}
"""Budgets of single artifacts, by variable; ``*`` stands for all variables that are not named."""
for _row in rows_beside(__file__):
    _budget = Budget(float(_row["size"]), _row["scale"], _row["over"], float(_row["share"] or 0))
    for _name in _row["artifact"].split():
        ARTIFACTS.setdefault(_name, {}).update(dict.fromkeys(_row["variable"].split(), _budget))


def budget_of(artifact: str, variable: str) -> Budget:
    """The budget of a variable of an artifact's dataset.

    Examples
    --------
    >>> budget_of("fig05", "phase").size, budget_of("fig08", "phase").over
    (1e-13, 'amplitude')
    """
    own = ARTIFACTS.get(artifact, {})
    return own.get(variable, own.get("*", Budget(*BUDGETS.get(variable, (ROUNDING,)))))
