"""The last line of a run: the number of claims with each verdict."""

import numpy as np
import xarray as xr

from bouncing_ball.claims.verdict import Verdict

_WORDS = {
    Verdict.QUALIFIED: "reproduced in one reading only",
    Verdict.CLOSE: "reproduced closely",
}


def tally(claims: xr.Dataset) -> str:
    """The numbers of claims and of verdicts in one line, without restatements.

    Parameters
    ----------
    claims : Dataset
        ``verdict``, ``group`` and ``explained`` over ``claim``.

    Examples
    --------
    >>> claims = xr.Dataset({"verdict": ("claim", ["close", "close", "reproduced"]),
    ...                      "group": ("claim", ["number", "restatement", "number"]),
    ...                      "explained": ("claim", [True, True, True])})
    >>> tally(claims)
    '2 claims of the paper: 1 reproduced, 1 reproduced closely'
    """
    verdicts = claims.verdict.values[claims.group.values != "restatement"]
    found = [one for one in Verdict if str(one) in verdicts]
    counts = [f"{np.sum(verdicts == str(one))} {_WORDS.get(one, one)}" for one in found]
    unexplained = int(np.sum(~claims.explained.values.astype(bool)))
    counts += [f"{unexplained} without explanation"] if unexplained else []
    return f"{verdicts.size} claims of the paper: {', '.join(counts)}"
