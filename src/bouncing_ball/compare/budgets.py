"""The change of a variable from the accepted record that the comparison allows: its budget.

A drift is |new - record| divided by the range of the record's values, or by ``scale``. Texts,
counts and truth values are compared exactly. The budget of a variable is in its row of
:mod:`bouncing_ball.datasets.variables`; budgets of single artifacts are in ``budgets.csv``, each
with its source. A budget without another source comes from the convergence study, a test that
varies tolerances, grids and rounding: it is the next power of ten above ten times the largest
change.
"""

import math
from typing import NamedTuple

from bouncing_ball.datasets.files import rows_beside
from bouncing_ball.datasets.variables import BUDGETS


class Budget(NamedTuple):
    """The largest change allowed of a variable, relative to a scale: "1", or another variable.

    Without a scale the change is relative to the range of the record's values. With ``over`` two
    curves over that variable are compared, through the samples along the dimension ``point``,
    because the samples may slide along the curve. The share ``share`` of the entries, of texts and
    counts as well, may exceed the budget, because rounding decides about some entries.
    """

    size: float
    scale: str = ""
    over: str = ""
    share: float = 0.0


ROUNDING = 1e-13
"""The smallest budget, for variables without another one."""
IGNORED = math.inf
"""The budget, ``inf`` in the tables, of variables that another dataset also has, or about which
rounding decides."""
PICTURE = 1.0
"""The largest root mean square difference of two pictures, in grey levels of 255.

Changing parameters by two units in the last place changes all rounding errors, as another processor
does, and moves the pixels of a figure by at most 0.092 (Fig. 15). The budget is the next power of
ten above ten times this value."""

PICTURES = {"ext_diagram": 60.0, "ext_locking": 40.0, "ext_means": 60.0, "ext_locked": 40.0}
"""Budgets of pictures of motions about which rounding decides: three times the 19 and 12 grey
levels by which a change of 1e-15 in the start moves these pictures."""

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
