"""Small tables as CSV, Markdown and LaTeX text."""

import csv
import io
from collections.abc import Sequence

Rows = Sequence[Sequence[str]]


def to_csv(header: Sequence[str], rows: Rows) -> str:
    """Comma-separated values.

    Examples
    --------
    >>> to_csv(["n", "from"], [["1", "0.255"]])
    'n,from\\n1,0.255\\n'
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def to_markdown(header: Sequence[str], rows: Rows) -> str:
    """A pipe table.

    Examples
    --------
    >>> print(to_markdown(["n"], [["1"]]), end="")
    | n |
    | --- |
    | 1 |
    """
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def to_latex(header: Sequence[str], rows: Rows) -> str:
    """A tabular environment with rules of the booktabs package.

    Examples
    --------
    >>> print(to_latex(["$n$"], [["1"]]), end="")
    \\begin{tabular}{l}
    \\toprule
    $n$ \\\\
    \\midrule
    1 \\\\
    \\bottomrule
    \\end{tabular}
    """
    body = [" & ".join(line) + r" \\" for line in (header, *rows)]
    lines = [
        rf"\begin{{tabular}}{{{'l' * len(header)}}}",
        r"\toprule",
        body[0],
        r"\midrule",
        *body[1:],
        r"\bottomrule",
        r"\end{tabular}",
    ]
    return "".join(f"{line}\n" for line in lines)
