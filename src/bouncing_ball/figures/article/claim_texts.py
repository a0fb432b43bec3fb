"""Claims and their verdicts as an article needs them."""

from types import SimpleNamespace

import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.figures.article.places import places
from bouncing_ball.figures.tables.rows import found_text

# One claim: the dataset's variables over ``claim`` by name, its ``id``, and
# ``found`` as in the table of claims.
ClaimRow = SimpleNamespace


class Claims:
    """Access to the claims of a dataset by name, by place and by verdict."""

    def __init__(self, data: xr.Dataset) -> None:
        self._data = data
        self._shown: set[str] = set()
        columns = [name for name, values in data.data_vars.items() if values.dims == ("claim",)]
        self._claims = []
        for index, name in enumerate(data.claim.values.tolist()):
            row = data[columns].isel(claim=index)
            texts = {str(key): row[key].item() for key in columns}
            self._claims.append(ClaimRow(**texts | {"id": name, "found": found_text(row)}))

    def __call__(self, name: str) -> ClaimRow:
        """A claim by its id."""
        for claim in self._claims:
            if claim.id == name:
                return claim
        raise ModelError(f"no claim {name!r} in the ledger")

    def about(self, *items: str) -> list[ClaimRow]:
        """The claims about a figure or equation, each only the first time; entries of
        tables are left out."""
        wanted = set(items)
        found = [
            claim
            for claim in self._claims
            if places(claim.item) & wanted
            and not claim.printed_table
            and claim.id not in self._shown
        ]
        self._shown |= {claim.id for claim in found}
        return found

    def count(self, verdict: str = "", *, table: str = "", group: str = "independent") -> int:
        """How many claims have a verdict, or how many there are; of one table if named.

        ``group`` is what they are counted as: ``independent`` for all but
        restatements, ``all``, or one group.
        """
        return sum(
            group in ("all", claim.group, _counted_as(claim))
            and verdict in ("", claim.verdict)
            and table in ("", claim.printed_table)
            for claim in self._claims
        )

    def all(self, verdict: str) -> list[ClaimRow]:
        """All claims with a verdict."""
        return [claim for claim in self._claims if claim.verdict == verdict]

    def asked(self, name: str) -> bool:
        """Whether a claim has a verdict: the run has the paper's parameters for it."""
        return self(name).verdict != "not asked"

    def not_asked(self) -> list[str]:
        """Which parameters are not the paper's, so that claims are not asked."""
        return sorted({claim.reason for claim in self.all("not asked")})

    def explanations(self) -> list[dict[str, object]]:
        """Explanations of the claims that are asked and not reproduced, with those claims."""
        names = ("explanation", "explanation_text", "explanation_holds", "explanation_checks")
        columns = [self._data[name].values.tolist() for name in names]
        found: list[dict[str, object]] = []
        for name, text, holds, checks in zip(*columns, strict=True):
            about = [
                claim
                for claim in self._claims
                if claim.explained_by == name and claim.verdict not in ("reproduced", "not asked")
            ]
            if about:
                said = {"name": name, "text": text.strip(), "holds": holds, "checks": checks}
                found.append(said | {"claims": about})
        return found


def _counted_as(claim: ClaimRow) -> str:
    return "restatement" if claim.group == "restatement" else "independent"
