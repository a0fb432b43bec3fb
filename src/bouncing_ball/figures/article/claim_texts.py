"""Claims and their verdicts in the form in which an article needs them."""

import re
from typing import Any

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.tables.rows import found_text


class Claims:
    """Access to the claims of a dataset by name, by place and by verdict.

    A claim has the dataset's variables over ``claim`` as attributes, its ``id``, and ``found`` as
    in the table of claims.
    """

    def __init__(self, data: xr.Dataset) -> None:
        self._data = data
        self._shown: set[str] = set()
        rows = data[[name for name, values in data.items() if values.dims == ("claim",)]]
        found = [found_text(row) for row in each(rows, "claim")]
        frame = rows.assign(found=("claim", found)).to_dataframe().rename_axis("id").reset_index()
        self._claims: dict[str, Any] = {row.id: row for row in frame.itertuples()}

    def __call__(self, name: str) -> Any:
        """The claim with an id.

        Raises
        ------
        ModelError
            If the ledger has no such claim.
        """
        if name not in self._claims:
            raise ModelError(f"no claim {name!r} in the ledger")
        return self._claims[name]

    def about(self, *items: str) -> list[Any]:
        """The claims about figures or equations, except entries of tables.

        Each claim is returned once, by the first call that names its place.
        """
        found = [
            claim
            for name, claim in self._claims.items()
            if places(claim.item) & set(items) and not claim.printed_table
            if name not in self._shown
        ]
        self._shown |= {claim.id for claim in found}
        return found

    def count(self, verdict: str = "", *, table: str = "", group: str = "independent") -> int:
        """Number of claims with a verdict, or of all without one; of one table if it is named.

        ``group`` is ``independent`` for all claims but restatements, ``all``, or the name of one
        group.
        """
        groups = {claim.group for claim in self._claims.values()} - {"restatement"}
        counted = {"independent": groups, "all": groups | {"restatement"}}.get(group, {group})
        return sum(
            claim.group in counted
            and verdict in ("", claim.verdict)
            and table in ("", claim.printed_table)
            for claim in self._claims.values()
        )

    def asked(self, name: str) -> bool:
        """Whether a claim has a verdict, because the run has the paper's parameters for it."""
        return self(name).verdict != "not asked"

    def not_asked(self) -> list[str]:
        """The reasons for which claims have no verdict: parameters that are not the paper's."""
        return sorted({self(name).reason for name in self._claims if not self.asked(name)})

    def explanations(self) -> list[dict[str, object]]:
        """The explanations of claims that are not reproduced, each with its claims.

        Each has ``name``, ``text``, ``holds``, ``checks`` and ``claims``.
        """
        parts = ("text", "holds", "checks")
        found: list[dict[str, object]] = []
        for one in each(self._data, "explanation"):
            about = [
                claim
                for claim in self._claims.values()
                if claim.explained_by == one.explanation
                and claim.verdict not in ("reproduced", "not asked")
            ]
            if about:
                said = {part: one[f"explanation_{part}"].item() for part in parts}
                found.append({"name": one.explanation.item(), "claims": about, **said})
        return found


def places(text: str) -> set[str]:
    """The figures, tables and equations named in a text such as "Figs. 8-10 and Table 1".

    Examples
    --------
    >>> sorted(places("Figs. 5, 6 and 8-10, Table 1"))
    ['Fig. 10', 'Fig. 5', 'Fig. 6', 'Fig. 8', 'Fig. 9', 'Table 1']
    """
    found = set()
    for kind, numbers in re.findall(r"(Fig|Eq|Table)s?\.? ((?:\d+(?:-\d+)?(?:, | and )?)+)", text):
        dot = "" if kind == "Table" else "."
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", numbers):
            span = range(int(first), int(last or first) + 1)
            found |= {f"{kind}{dot} {number}" for number in span}
    return found
