"""The last line of a run: how many claims got which verdict."""

import numpy as np
import xarray as xr

from bouncing_ball.audit.claims.verdict import Verdict


def tally(claims: xr.Dataset, figures: int) -> str:
    """Figures made, claims and verdicts in one line.

    Claims that were not asked are counted where there are any.

    Examples
    --------
    >>> claims = xr.Dataset({"verdict": ("claim", ["close", "close", "reproduced"]),
    ...                      "explained": ("claim", [True, True, True])})
    >>> tally(claims, 16)
    '16 figures, Table 1, 3 claims: 1 reproduced, 2 close, 0 contradicted, 0 undecidable'
    """
    verdicts = claims.verdict.values
    numbers = {verdict: int(np.sum(verdicts == str(verdict))) for verdict in Verdict}
    if not numbers[Verdict.NOT_ASKED]:
        del numbers[Verdict.NOT_ASKED]
    counts = ", ".join(f"{number} {verdict}" for verdict, number in numbers.items())
    line = f"{figures} figures, Table 1, {verdicts.size} claims: {counts}"
    unexplained = int(np.sum(~claims.explained.values.astype(bool)))
    return f"{line}; {unexplained} without explanation" if unexplained else line
