"""The tables of the run: for each table a function of its dataset, with the name of the table.

Each function returns the header and the rows as texts, made from parts of the dataset and columns
(:mod:`bouncing_ball.drawing.tables`). :class:`Claims` has the claims and their verdicts in the form
in which an article needs them.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.tables import Columns, TextTable, at, entry_of, text, text_table, value
from bouncing_ball.paper.claims.places import exhibits_in
from bouncing_ball.paper.claims.verdict import Verdict, compared_text, decimals

# A claim about more figures than these is not repeated at each of them.
_FEW = 3


def formulas(data: xr.Dataset) -> TextTable:
    """Printed formulas: the comparison, the disagreement, the functions of the package that compute
    with the formula, their disagreement with the printed form, and the disagreement allowed.

    For a disagreement of the size of rounding the entry is its bound.
    """

    def disagreement(name: str) -> Callable[[xr.Dataset], str]:
        return lambda part: compared_text(float(part[name]), float(part.budget), ".1e")

    def in_use(part: xr.Dataset) -> str:
        return disagreement("disagreement_in_use")(part) if part.used.item() else ""

    def functions(part: xr.Dataset) -> str:
        return ", ".join(name.rpartition(".")[2] for name in part.used.item().split(", "))

    columns: Columns = {
        "formula": text("formula"),
        "compared with": text("compared_with"),
        "largest disagreement": disagreement("disagreement"),
        "functions in use": functions,
        "their disagreement": in_use,
        "allowed": value("budget", ".0e"),
    }
    return text_table(each(data, "formula"), columns)


def forensics(data: xr.Dataset) -> TextTable:
    """Readings of Table 1, the closest first; differences in units of the last digit.

    The entry is a dash if a reading has no orbit.
    """
    columns: Columns = {"rank": text("rank"), "reading": text("reading")}
    for name in data.rows.values[:2]:
        columns[f"largest, {name}"] = at(value("largest_difference", ".2f"), rows=name)
        columns[f"rms, {name}"] = at(value("rms_difference", ".2f"), rows=name)
    for name in data.rows.values[:2]:
        columns[f"reproduced, {name}"] = at(
            lambda part: f"{int(part.reproduced)} of {int(part.entries)}", rows=name
        )
    columns["printed below every orbit"] = text("unreachable")
    return text_table(each(data, "reading"), columns)


def witness(data: xr.Dataset) -> TextTable:
    """Largest disagreement between the routes to the orbits of each figure or table.

    An entry is a bound of the largest disagreement, which is the budget unless this is exceeded,
    and the number of orbits in brackets. The disagreement itself is not printed, because it
    consists of rounding errors, which differ between processors.
    """

    def entry(part: xr.Dataset) -> str:
        found = float(part.disagreement)
        allowed = float(part.budget)
        text = f"≤ {allowed:.0e}" if found <= allowed else f"{found:.1e}"
        return f"{text} ({int(part.orbits)})" if part.orbits else "–"

    kinds = {str(kind): at(entry, comparison=kind) for kind in data.comparison.values}
    header, body = text_table(each(data, "artifact"), {"artifact": text("artifact"), **kinds})
    return header, [["budget", *(f"{float(value):.0e}" for value in data.budget.values)], *body]


def claims(data: xr.Dataset) -> TextTable:
    """Claims of the paper: place, statement, number, deviation, verdict.

    The number compared is named with the r, n, Λ, ϖ and ζ at which it is found. The column
    "printed or required" has the printed number, or the bound that a formula or a statement must
    meet.
    """
    columns: Columns = {
        "claim": text("claim"),
        "where": text("item"),
        "what the paper says": text("statement"),
        "number compared": compared_of,
        "at": text("parameters"),
        "printed or required": text("required"),
        "found": found_text,
        "deviation": deviation_text,
        "verdict": text("verdict"),
    }
    return text_table(each(data, "claim"), columns)


def compared_of(claim: xr.Dataset) -> str:
    """What the number is that decides a claim, or what is missing to decide it."""
    if claim.verdict.item() == Verdict.UNDECIDABLE:
        return f"{claim.compared.item()}; the text does not have {claim.missing.item()}"
    return str(claim.compared.item())


def found_text(claim: xr.Dataset) -> str:
    """The number found, with two digits more than printed, or four digits if nothing is printed.

    For a number of the size of rounding the text is its bound.
    """
    printed = claim.printed_text.item()
    if not printed and np.isfinite(claim.found):
        return compared_text(float(claim.found), float(claim.limit))
    return entry_of(claim.found, f".{decimals(printed) + 2}f")


def deviation_text(claim: xr.Dataset) -> str:
    """The deviation in units of the last printed digit, and in per cent."""
    units = float(claim.deviation_units)
    share = float(claim.deviation)
    return "" if np.isnan(units) else f"{units:+.2f} ({100 * share:+.3g} %)"


class Claims:
    """Access to the claims of a dataset by name and by verdict, or to ``all`` in their order.

    A claim has as attributes its ``id``, the variables of the dataset over ``claim``, and ``found``
    in the form of the table of claims.
    """

    def __init__(self, data: xr.Dataset) -> None:
        rows = data[[name for name, values in data.items() if values.dims == ("claim",)]]
        found = [found_text(row) for row in each(rows, "claim")]
        frame = rows.assign(found=("claim", found)).to_dataframe().rename_axis("id").reset_index()
        self._claims: dict[str, Any] = {row.id: row for row in frame.itertuples()}
        self.all = list(self._claims.values())

    def __call__(self, name: str) -> Any:
        """The claim with this id."""
        return self._claims[name]

    def count(self, verdict: str = "", *, table: str = "", group: str = "") -> int:
        """Number of claims with a verdict, of a table and of a group; of all if that is empty."""
        return sum(
            verdict in ("", claim.verdict)
            and table in ("", claim.printed_table)
            and group in ("", claim.group)
            for claim in self.all
        )

    def printed(self, *, beyond: float = 0.0, table: str = "") -> list[Any]:
        """Claims of printed numbers that differ from the computed ones by more than a share, the
        largest relative difference first; of one table if that is named.
        """
        chosen = [
            claim
            for claim in self.all
            if claim.printed_text
            and abs(claim.deviation) > beyond
            and table in ("", claim.printed_table)
        ]
        return sorted(chosen, key=lambda claim: -abs(claim.deviation))

    def about(self, name: str) -> list[Any]:
        """Claims about a figure or a table, but for the entries of a printed table, and for those
        about many figures.
        """
        few = (claim for claim in self.all if len(exhibits_in(claim.item)) <= _FEW)
        return [x for x in few if name in exhibits_in(x.item) and not x.printed_table]

    def about_many(self) -> list[Any]:
        """Claims about so many figures that they are not repeated at each of them."""
        return [claim for claim in self.all if len(exhibits_in(claim.item)) > _FEW]

    def asked(self, name: str) -> bool:
        """Whether a claim has a verdict, for which the run must have the paper's parameters."""
        return self(name).verdict != "not asked"

    def not_asked(self) -> list[str]:
        """The reasons why claims have no verdict: parameters that differ from the paper's."""
        return sorted({self(name).reason for name in self._claims if not self.asked(name)})
