"""Small tables as CSV, Markdown and LaTeX text."""

import csv
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from bouncing_ball.errors import ModelError

Rows = Sequence[Sequence[str]]
Table = tuple[list[str], list[list[str]]]
"""Header and rows."""


def words(name: object) -> str:
    """A name as a table has it.

    Examples
    --------
    >>> words("max_height")
    'max height'
    """
    return str(name).replace("_", " ")


def number(value: Any, form: str, none: str = "–") -> str:
    """A number in a format, or what stands where there is none.

    Examples
    --------
    >>> number(2.0, ".2f"), number(float("nan"), ".2f")
    ('2.00', '–')
    """
    return f"{float(value):{form}}" if np.isfinite(value) else none


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


def texts(header: Sequence[str], rows: Rows) -> dict[str, str]:
    """A table in all formats, by the suffix of its file.

    Examples
    --------
    >>> list(texts(["n"], [["1"]]))
    ['.csv', '.md', '.tex']
    """
    forms = {".csv": to_csv, ".md": to_markdown, ".tex": to_latex}
    return {suffix: form(header, rows) for suffix, form in forms.items()}


_LATEX = {
    **{"%": r"\%", "&": r"\&", "_": r"\_", "#": r"\#", "<": "$<$", ">": "$>$"},
    **{"≤": r"$\le$", "≥": r"$\ge$", "→": r"$\to$", "–": "--", "×": r"$\times$"},
    **{"ϖ": r"$\varpi$", "Λ": r"$\Lambda$", "ζ": r"$\zeta$", "φ": r"$\varphi$"},
    **{"π": r"$\pi$", "Ω": r"$\Omega$", "ω": r"$\omega$", "τ": r"$\tau$", "δ": r"$\delta$"},
}


def latex_text(text: str) -> str:
    """Plain text for LaTeX, signs and Greek letters as mathematics.

    Raises
    ------
    ModelError
        If a character has no LaTeX here.

    Examples
    --------
    >>> print(latex_text("ϖ ≤ 10 %"))
    $\\varpi$ $\\le$ 10 \\%
    """
    parts = [_LATEX.get(character, character) for character in text]
    for part in parts:
        if not part.isascii():
            raise ModelError(f"no LaTeX for {part!r} in {text!r}")
    return "".join(parts)


def to_latex(header: Sequence[str], rows: Rows) -> str:
    """A tabular environment with rules of the booktabs package.

    Examples
    --------
    >>> print(to_latex(["n"], [["1"]]), end="")
    \\begin{tabular}{l}
    \\toprule
    $n$ \\\\
    \\midrule
    1 \\\\
    \\bottomrule
    \\end{tabular}
    """
    # A column that is called n is called by its symbol.
    names = ["$n$" if cell == "n" else latex_text(cell) for cell in header]
    cells = [names, *([latex_text(cell) for cell in line] for line in rows)]
    body = [" & ".join(line) + r" \\" for line in cells]
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
