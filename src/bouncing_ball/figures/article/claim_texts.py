"""Claims and their verdicts in the form in which an article needs them."""

from typing import Any

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.rows import found_text


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

    def count(self, verdict: str = "", *, table: str = "", group: str = "independent") -> int:
        """Number of claims with a verdict, or of all if it is empty; of one table if that is named.

        ``group`` is ``independent`` for all claims except restatements, ``all``, or the name of a
        group.
        """
        return sum(
            (claim.group == group or group == "all")
            or (group == "independent" and claim.group != "restatement")
            for claim in self.all
            if verdict in ("", claim.verdict) and table in ("", claim.printed_table)
        )

    def asked(self, name: str) -> bool:
        """Whether a claim has a verdict, for which the run must have the paper's parameters."""
        return self(name).verdict != "not asked"

    def not_asked(self) -> list[str]:
        """The reasons why claims have no verdict: parameters that differ from the paper's."""
        return sorted({self(name).reason for name in self._claims if not self.asked(name)})
