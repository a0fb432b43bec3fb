"""The error law on random orbits, from the summary that is accepted by hand."""

import csv
import io

from bouncing_ball.figures.tables.formats import to_markdown

_SHOWN = ("orbits", "stated", "exceed", "exceed elsewhere", "largest M", "5 %", "50 %", "95 %")


def law_table(summary: str) -> str:
    r"""The rows of the whole range of ϖ as Markdown.

    Parameters
    ----------
    summary : str
        The text of ``config/error_law.csv``.

    Examples
    --------
    >>> header = "release,quantity,from,to," + ",".join(_SHOWN)
    >>> law_table(header + "\nforce,phase,1,10000,9,8,0,0,3.1,1,1,1\n").splitlines()[-1]
    '| force | phase | 9 | 8 | 0 | 0 | 3.1 | 1 | 1 | 1 |'
    """
    body = [
        [row["release"], row["quantity"].replace("_", " "), *(row[name] for name in _SHOWN)]
        for row in csv.DictReader(io.StringIO(summary))
        if (row["from"], row["to"]) == ("1", "10000")
    ]
    return to_markdown(["release", "quantity", *_SHOWN], body)
