"""The last line of a run: the number of claims with each verdict."""

import numpy as np
import xarray as xr

from bouncing_ball.claims.verdict import Verdict

# Restatements come last, because they are counted separately.
_GROUPS = ("restored formula", "number", "statement", "restatement")


def tally(claims: xr.Dataset, figures: int) -> str:
    """The numbers of figures, of claims and of verdicts in one line, group by group.

    Restatements are counted separately from the claims that they repeat, and restored formulas
    separately from numbers.

    Parameters
    ----------
    claims : Dataset
        ``verdict``, ``group`` and ``explained`` over ``claim``.
    figures : int

    Examples
    --------
    >>> claims = xr.Dataset({"verdict": ("claim", ["close", "close", "reproduced"]),
    ...                      "group": ("claim", ["number", "restatement", "number"]),
    ...                      "explained": ("claim", [True, True, True])})
    >>> tally(claims, 16)
    '16 figures, Table 1, 2 claims; 2 numbers: 1 reproduced, 1 close; 1 restatement: 1 close'
    """
    verdicts, groups = claims.verdict.values, claims.group.values
    parts = [f"{figures} figures, Table 1, {np.sum(groups != _GROUPS[-1])} claims"]
    for group in _GROUPS:
        own = verdicts[groups == group]
        if own.size:
            plural = "s" if own.size > 1 else ""
            counts = [f"{np.sum(own == str(one))} {one}" for one in Verdict if str(one) in own]
            parts.append(f"{own.size} {group}{plural}: {', '.join(counts)}")
    unexplained = int(np.sum(~claims.explained.values.astype(bool)))
    if unexplained:
        parts.append(f"{unexplained} without explanation")
    return "; ".join(parts)
