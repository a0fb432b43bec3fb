"""The verdict on each claim as a dataset, and the tables and the page that show it."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import xarray as xr

from paper_replication.datasets import Datasets
from paper_replication.texts import markdown
from paper_replication.verdicts import RAISED, ROUNDING, VERDICTS, Claim, answer

NOTHING = {
    "claim": "",
    "group": "",
    "item": "",
    "statement": "",
    "decided_by": "",
    "beside": "",
    "printed_text": "",
    "found": np.nan,
    "deviation_units": np.nan,
    "deviation": np.nan,
    "verdict": "",
    "own_sense": "",
    "condition": [],
    "reason": "",
    "remark": "",
}
"""The variables of the dataset, for what a claim does not have."""


def judged(
    datasets: Datasets, claims: Iterable[Claim], formulas: Iterable[Sequence[str]], checked_by: str
) -> xr.Dataset:
    """Judge claims: the verdict on each, and the restored formulas, over the dimension `claim`.

    Parameters
    ----------
    datasets
        The datasets of the figures and tables by name. A claim whose datasets are missing is not
        computed.
    claims
        The claims.
    formulas
        Equations that were restored, what they give, and the functions that compute them.
    checked_by
        The file of the tests of these formulas.
    """
    rows = [
        NOTHING
        | {
            "claim": claim.name,
            "group": group_of(claim),
            "item": claim.place,
            "statement": claim.text,
            "decided_by": ", ".join(claim.datasets),
            "beside": claim.beside,
            "printed_text": claim.printed,
            "remark": claim.remark,
        }
        | answer(claim, datasets)
        for claim in claims
    ]
    rows += [
        NOTHING
        | {
            "claim": equations,
            "group": "restored formula",
            "item": equations,
            "statement": text,
            "decided_by": members,
            "condition": [checked_by],
        }
        for equations, text, members in formulas
    ]
    most = max(len(row["condition"]) for row in rows)
    padded = [[*row["condition"], *[""] * (most - len(row["condition"]))] for row in rows]
    names = [name for name in NOTHING if name != "condition"]
    columns = {name: ("claim", [row[name] for row in rows]) for name in names}
    dataset = xr.Dataset(columns).assign(condition=(("claim", "sense"), padded))
    return dataset.set_coords("claim")


def raised(data: xr.Dataset) -> list[str]:
    """The claims of a dataset whose functions raised an exception, each with the reason."""
    if "claim" not in data.dims or "reason" not in data:
        return []
    reasons = zip(data["claim"].values, data["reason"].values, strict=True)
    return [f"{claim} is not asked, {why}" for claim, why in reasons if why.startswith(RAISED)]


def group_of(claim: Claim) -> str:
    """The group of a claim: those that the paper does not say are "own claim"."""
    if not claim.place:
        return "own claim"
    return "printed number" if claim.printed else "statement"


# Tables


def computed_text(number: float, printed: str) -> str:
    """Print a computed number with two digits more than the printed one.

    >>> computed_text(1.0383008, "1.032"), computed_text(82.177, "82"), computed_text(np.nan, "6")
    ('1.03830', '82.18', '–')
    """
    decimals = len(printed.partition(".")[2]) + 2
    return "–" if np.isnan(number) else f"{number:.{decimals}f}"


def distance_text(units: float, share: float) -> str:
    """Print the distance from a printed number; empty if there is none.

    >>> distance_text(6.3, 0.0061), distance_text(0.8, 0.0008)
    ('+6.3 units, +0.61 %', '+0.8 units, +0.08 %, within one unit of the last digit')
    """
    if np.isnan(units):
        return ""
    near = ", within one unit of the last digit" if 0.5 + ROUNDING < abs(units) <= 1 else ""
    return f"{units:+.1f} units, {100 * share:+.2f} %{near}"


def claims_of(data: xr.Dataset, group: str) -> list[dict]:
    """Return the claims of a group, each as a mapping from variables to values.

    Besides, `computed` and `distance` have the number found beside a printed one as texts, and
    `notes` the reason for the verdict and the remark.
    """
    of_group = data.isel(claim=data["group"].values == group)
    columns = {str(name): of_group[name].values.tolist() for name in of_group.variables}
    rows = []
    for values in zip(*columns.values(), strict=True):
        row = dict(zip(columns, values, strict=True))
        row["senses"] = list(filter(None, row["condition"]))
        row["condition"] = "; ".join(row["senses"])
        printed = row["printed_text"]
        row["computed"] = computed_text(row["found"], printed) if printed else ""
        row["distance"] = distance_text(row["deviation_units"], row["deviation"])
        row["notes"] = "; ".join(filter(None, (row["reason"], row["remark"])))
        rows.append(row)
    return rows


GROUPS = ("printed number", "statement")
"""The groups of claims that are counted."""
SECTIONS = {
    "printed number": {
        "claim": "claim",
        "where": "item",
        "number": "statement",
        "printed": "printed_text",
        "computed": "computed",
        "distance": "distance",
        "verdict": "verdict",
        "remark": "notes",
    },
    "statement": {
        "claim": "claim",
        "where": "item",
        "what the paper says": "statement",
        "verdict": "verdict",
        "literal sense": "own_sense",
        "found": "condition",
        "decided by": "decided_by",
        "remark": "notes",
    },
    "own claim": {
        "claim": "claim",
        "what it says": "statement",
        "verdict": "verdict",
        "literal sense": "own_sense",
        "found": "condition",
        "decided by": "decided_by",
        "remark": "notes",
    },
    "restored formula": {
        "equations": "item",
        "what they give": "statement",
        "computed by": "decided_by",
    },
}
"""The tables of claims, one for each group, with their columns."""
EVERYTHING = {
    "claim": "claim",
    "group": "group",
    "where": "item",
    "what the paper says": "statement",
    "printed": "printed_text",
    "computed": "computed",
    "distance": "distance",
    "verdict": "verdict",
    "literal sense": "own_sense",
    "found, or checked by": "condition",
    "remark": "notes",
    "decided by, or computed by": "decided_by",
}
"""The columns of the CSV file."""


def counted(data: xr.Dataset) -> list[dict]:
    """Return the claims of the groups that are counted."""
    return [claim for group in GROUPS for claim in claims_of(data, group)]


def chosen(columns: Mapping[str, str], claims: list[dict]) -> list[list[str]]:
    """Select columns of claims: rows of texts, the header first."""
    return [[*columns], *([claim[name] for name in columns.values()] for claim in claims)]


def all_claims(data: xr.Dataset) -> list[list[str]]:
    """Return rows of texts for all claims and restored formulas, with all columns."""
    return chosen(EVERYTHING, [claim for group in SECTIONS for claim in claims_of(data, group)])


def counts(data: xr.Dataset) -> dict[str, dict[str, int]]:
    """Count the claims by group and verdict; restored formulas are not counted."""
    tally = Counter(
        zip(data["group"].values.tolist(), data["verdict"].values.tolist(), strict=True)
    )
    return {group: {verdict: tally[group, verdict] for verdict in VERDICTS} for group in GROUPS}


def summary(data: xr.Dataset) -> list[list[str]]:
    """Return the counts as rows of texts, the header first."""
    tally = counts(data)
    used = [verdict for verdict in VERDICTS if any(by[verdict] for by in tally.values())]
    rows = [["claims", "in all", *used]]
    for group, by in tally.items():
        numbers = [sum(by.values()), *(by[verdict] for verdict in used)]
        rows.append([f"{group}s", *map(str, numbers)])
    return rows


def claims_markdown(data: xr.Dataset, introduction: str, elsewhere: str) -> str:
    """Return the claims with their verdicts as a page in Markdown, after an introduction.

    Claims of the table `elsewhere` are left out, because they stand in that table, and so are the
    restored formulas, which no verdict judges.
    """
    text = f"{introduction}\n## How many\n\n{markdown(summary(data))}"
    for group in (*GROUPS, "own claim"):
        if claims := [claim for claim in claims_of(data, group) if claim["item"] != elsewhere]:
            text += f"\n## {group.capitalize()}s\n\n{markdown(chosen(SECTIONS[group], claims))}"
    return text
