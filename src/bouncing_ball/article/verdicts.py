"""Claims and their verdicts as an article needs them."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from bouncing_ball.article.places import places
from bouncing_ball.errors import ModelError
from bouncing_ball.tables.claims import deviation_text, found_text


@dataclass(frozen=True)
class ClaimText:
    """One claim of the ledger with its verdict, as text.

    ``found``, ``required`` and ``deviation`` are as in the table of claims.
    """

    id: str
    item: str
    statement: str
    printed: str
    required: str
    verdict: str
    reason: str
    explanation: str
    found: str
    deviation: str


class Claims:
    """Access to the claims of a dataset by name, by place and by verdict."""

    def __init__(self, data: xr.Dataset) -> None:
        self._data = data
        rows = [data.isel(claim=index) for index in range(data.sizes["claim"])]
        self._claims = [
            ClaimText(
                id=row.claim.item(),
                item=row["item"].item(),
                statement=row.statement.item(),
                printed=row.printed_text.item(),
                required=row.required.item(),
                verdict=row.verdict.item(),
                reason=row.reason.item(),
                explanation=row.explained_by.item(),
                found=found_text(row),
                deviation=deviation_text(row),
            )
            for row in rows
        ]

    def __call__(self, name: str) -> ClaimText:
        """A claim by its id."""
        for claim in self._claims:
            if claim.id == name:
                return claim
        raise ModelError(f"no claim {name!r} in the ledger")

    def about(self, *items: str) -> list[ClaimText]:
        """The claims that stand at a figure, table or equation, tables left out."""
        wanted = set(items)
        return [
            claim
            for claim in self._claims
            if places(claim.item) & wanted and not claim.id.startswith("Table 1:")
        ]

    def count(self, verdict: str = "") -> int:
        """How many claims have a verdict, or how many there are."""
        return sum(1 for claim in self._claims if verdict in ("", claim.verdict))

    def foreign(self) -> list[str]:
        """Why claims are open because of parameters that are not the paper's."""
        reasons = (claim.reason for claim in self._claims)
        return sorted({reason for reason in reasons if "was computed with" in reason})

    def explanations(self) -> list[dict[str, object]]:
        """Explanations of the claims that are not reproduced, with those claims."""
        found = []
        data = self._data
        for index, name in enumerate(data.explanation.values):
            about = [c for c in self._claims if c.explanation == name and c.verdict != "reproduced"]
            if about:
                found.append(
                    {
                        "name": str(name),
                        "text": str(data.explanation_text.values[index]).strip(),
                        "holds": bool(data.explanation_holds.values[index]),
                        "checks": str(data.explanation_checks.values[index]),
                        "claims": about,
                    }
                )
        return found

    def because(self, name: str) -> str:
        """The text of an explanation if its checks hold, else that they do not."""
        there = np.flatnonzero(self._data.explanation.values == name)
        if there.size != 1:
            raise ModelError(f"no explanation {name!r} in the ledger")
        if not self._data.explanation_holds.values[there[0]]:
            return "The checks of the explanation do not hold in this run."
        return str(self._data.explanation_text.values[there[0]]).strip()
