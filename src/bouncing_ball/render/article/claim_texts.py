"""Claims and their verdicts as an article needs them."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.render.article.places import places
from bouncing_ball.render.tables.claims import found_text


@dataclass(frozen=True)
class ClaimText:
    """One claim of the ledger with its verdict, as text.

    ``found`` and ``required`` are as in the table of claims.
    """

    id: str
    kind: str
    item: str
    statement: str
    condition: str
    legibility: str
    printed: str
    printed_table: str
    required: str
    verdict: str
    reason: str
    foreign: bool
    explanation: str
    found: str


class Claims:
    """Access to the claims of a dataset by name, by place and by verdict."""

    def __init__(self, data: xr.Dataset) -> None:
        self._data = data
        self._told: set[str] = set()
        rows = [data.isel(claim=index) for index in range(data.sizes["claim"])]
        self._claims = [
            ClaimText(
                id=row.claim.item(),
                kind=row.kind.item(),
                item=row["item"].item(),
                statement=row.statement.item(),
                condition=row.condition.item(),
                legibility=row.legibility.item(),
                printed=row.printed_text.item(),
                printed_table=row.printed_table.item(),
                required=row.required.item(),
                verdict=row.verdict.item(),
                reason=row.reason.item(),
                foreign=bool(row.foreign.item()),
                explanation=row.explained_by.item(),
                found=found_text(row),
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
        """The claims that stand at a figure or equation, each where it is first asked
        for; entries of tables are left out."""
        wanted = set(items)
        found = [
            claim
            for claim in self._claims
            if places(claim.item) & wanted
            and not claim.printed_table
            and claim.id not in self._told
        ]
        self._told |= {claim.id for claim in found}
        return found

    def count(self, verdict: str = "", *, table: str = "") -> int:
        """How many claims have a verdict, or how many there are; of one table if named."""
        return sum(
            1
            for claim in self._claims
            if verdict in ("", claim.verdict) and table in ("", claim.printed_table)
        )

    def all(self, verdict: str) -> list[ClaimText]:
        """All claims with a verdict."""
        return [claim for claim in self._claims if claim.verdict == verdict]

    def restored(self) -> int:
        """How many of the reproduced claims are formulas whose signs had to be restored."""
        return sum(
            1
            for claim in self._claims
            if (claim.kind, claim.legibility, claim.verdict) == ("formula", "damaged", "reproduced")
        )

    def foreign(self) -> list[str]:
        """Why claims are open because of parameters that are not the paper's."""
        return sorted({claim.reason for claim in self._claims if claim.foreign})

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
        """The text of an explanation if its checks hold, else nothing."""
        there = np.flatnonzero(self._data.explanation.values == name)
        if there.size != 1:
            raise ModelError(f"no explanation {name!r} in the ledger")
        if not self._data.explanation_holds.values[there[0]]:
            return ""
        return str(self._data.explanation_text.values[there[0]]).strip()
