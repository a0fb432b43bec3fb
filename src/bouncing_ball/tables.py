"""Table 1, the thresholds, hypotheses on the printed numbers and the claims, as Markdown and CSV.

Each table is a function of its dataset that returns rows of texts, the header first.
"""

import csv
import io
from collections import Counter
from collections.abc import Mapping

import numpy as np
import xarray as xr

from bouncing_ball.claims import table1_ends
from bouncing_ball.datasets import parameters
from bouncing_ball.measures import ROUNDING
from bouncing_ball.paper import QUANTITIES
from bouncing_ball.verdicts import VERDICTS, answer

NOT_FOLLOWED = ", which no ball follows"
"""What is added to the number of an orbit that is not admissible."""
MAPS = {"exact": "restitution model, Eq. 5", "holmes": "restitution model, Eqs. 7 and 8"}


def markdown(rows: list[list[str]]) -> str:
    """Print rows of texts, the header first, as a Markdown table."""
    header, *body = rows
    lines = [header, ["---"] * len(header), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def comma_separated(rows: list[list[str]]) -> str:
    """Print rows of texts, the header first, as CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def number(value: xr.DataArray | float, form: str, none: str = "–") -> str:
    """Print a number in a format; `none` if it is NaN or infinite."""
    plain = float(value)
    return f"{plain:{form}}" if np.isfinite(plain) else none


def distance_text(units: float, share: float) -> str:
    """Print the distance from a printed number; empty if there is none.

    >>> distance_text(6.3, 0.0061), distance_text(0.8, 0.0008)
    ('+6.3 units, +0.61 %', '+0.8 units, +0.08 %, within one unit of the last digit')
    """
    if np.isnan(units):
        return ""
    near = ", within one unit of the last digit" if 0.5 + ROUNDING < abs(units) <= 1 else ""
    return f"{units:+.1f} units, {100 * share:+.2f} %{near}"


# Numbers


def table1(data: xr.Dataset) -> list[list[str]]:
    """Table 1: each end of a range of stable orbits, computed and printed, with the verdict.

    A range goes from the saddle-node to the next period doubling. The table omits further stable
    ranges of the same family. The paper prints Λ to three decimals. An end that rounds to the
    printed Λ has no distance. The last rows are the ranges of the restitution model, which the
    paper does not print.
    """
    rows = [["ϖ", "n", "end", "computed", "printed", "distance", "verdict"]]
    ends = {claim.name: claim for claim in table1_ends()}
    for end in each(data, "frequency_ratio", "n", "bound"):
        place = [number(end["frequency_ratio"], "g"), str(end["n"].item()), end["bound"].item()]
        printed = number(end["printed"], ".3f", "")
        claim = ends.get(f"Table 1: {', '.join(place)}") if printed else None
        judged = answer(claim, {"table1": data}) if claim else {}
        distance = distance_text(judged.get("deviation_units", np.nan), judged.get("deviation", 0))
        if judged.get("verdict") == "reproduced":
            distance = f"rounds to {printed}"
        computed = number(end["computed"], ".5f", "no such bifurcation")
        if not end["admissible"] and np.isfinite(end["computed"]):
            computed += NOT_FOLLOWED
        rows.append([*place, computed, printed, distance, judged.get("verdict", "")])
    for end in each(data, "impact_map", "n", "bound"):
        place = [MAPS[end["impact_map"].item()], str(end["n"].item()), end["bound"].item()]
        rows.append([*place, number(end["restitution_range"], ".5f"), "", "", ""])
    return rows


def thresholds(data: xr.Dataset) -> list[list[str]]:
    """Frequency ratios above which each error stays within each tolerance, as in `errors.errors`.

    A threshold outside of the range scanned is printed as "< lowest" or "> largest".
    """
    lowest, highest = data["frequency_ratio"].values[[0, -1]]
    instead = {
        "within": f"< {lowest:g}",
        "exceeded": f"> {highest:g}",
        "first orbit": "from where the orbit begins",
        "no orbit": f"no orbit at {highest:g}",
    }
    given = parameters(data)
    orbit = f"n = {given['n']}, r = {given['restitution']:g}, Λ = {given['amplitude']:g}"
    tolerances = [f"{100 * tolerance:g} %" for tolerance in data["tolerance"].values]
    rows = [[f"error of an orbit with {orbit}, relative; of the phase in periods", *tolerances]]
    for line in each(data, "quantity"):
        status = line["threshold_status"].values.tolist()
        ratios = line["error_threshold"].values
        entries = []
        for kind, ratio in zip(status, ratios, strict=True):
            has_orbit = kind != "no orbit"
            note = NOT_FOLLOWED * (has_orbit and not is_followed(line, ratio))
            entries.append(instead.get(kind, number(ratio, ".5g")) + note)
        rows.append([QUANTITIES[line["quantity"].item()], *entries])
    return rows


def is_followed(line: xr.Dataset, threshold: float) -> bool:
    """Whether the orbits of the scan next to a threshold are admissible; true without one."""
    after = int(np.searchsorted(line["frequency_ratio"].values, threshold))
    return bool(line["admissible"].values[max(after - 1, 0) : after + 1].all())


def hypotheses(data: xr.Dataset) -> list[list[str]]:
    """All printed numbers under each hypothesis on what the authors computed.

    The columns are:

    - for each row of Table 1, the number of its ends that are reproduced;
    - the root mean square distance of the compliant rows, in units of the last printed digit;
    - the other numbers, each with its distance in these units.
    """
    row = data["row"].values
    rows = list(dict.fromkeys(row[np.isfinite(row)]))
    single = data["number"].values[np.isnan(row)]
    printed = data["printed_text"].sel(number=single).values.tolist()
    heads = [f"Table 1, ϖ = {ratio:g}" for ratio in rows]
    names = [f"{name}, printed {text}" for name, text in zip(single, printed, strict=True)]
    mean = "root mean square distance, compliant rows"
    found = [["hypothesis", *heads, mean, *names, "reproduced"]]
    for line in each(data, "hypothesis"):
        agrees = line["agrees"].values
        ends = [agrees[row == ratio] for ratio in rows]
        others = line[["found", "deviation_units"]].sel(number=single)
        numbers = []
        for text, one in zip(printed, each(others, "number"), strict=True):
            value = computed_text(float(one["found"]), text)
            units = number(one["deviation_units"], "+.2f")
            numbers.append(value if value == units else f"{value} ({units})")
        cells = [f"{hits.sum()} of {hits.size}" for hits in ends]
        cells += [number(line["rms_difference"], ".2f"), *numbers]
        found.append([line["hypothesis"].item(), *cells, f"{agrees.sum()} of {agrees.size}"])
    return found


def each(data: xr.Dataset, *dimensions: str) -> list[xr.Dataset]:
    """Split a dataset along dimensions; the last dimension varies fastest."""
    parts = [data]
    for name in dimensions:
        parts = [part.isel({name: place}) for part in parts for place in range(data.sizes[name])]
    return parts


def choices(data: xr.Dataset) -> list[list[str]]:
    """Our choices, the alternatives that were tried, and the verdicts that change."""
    found = [["choice", "instead", "verdicts that depend on it"]]
    for choice in dict.fromkeys(data["choice"].values.tolist()):
        tried = data.isel(alternative=data["choice"].values == choice)
        pairs = list(zip(tried["instead"].values, tried["changes"].values, strict=True))
        changes = [": ".join(pair) for pair in pairs if pair[1]]
        instead = "; ".join(instead for instead, _ in pairs)
        found.append([choice, instead, "<br>".join(changes) or "none"])
    return found


TABLES = {"table1": table1, "thresholds": thresholds, "hypotheses": hypotheses, "choices": choices}
"""The tables by name."""


# Claims


def computed_text(found: float, printed: str) -> str:
    """Print a computed number with two digits more than the printed one.

    >>> computed_text(1.0383008, "1.032"), computed_text(82.177, "82"), computed_text(np.nan, "6")
    ('1.03830', '82.18', '–')
    """
    decimals = len(printed.partition(".")[2]) + 2
    return "–" if np.isnan(found) else f"{found:.{decimals}f}"


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
    "restored formula": {
        "equations": "item",
        "what they give": "statement",
        "computed by": "decided_by",
        "checked by": "condition",
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


def chosen(columns: Mapping[str, str], claims: list[dict]) -> list[list[str]]:
    """Select columns of claims: rows of texts, the header first."""
    return [[*columns], *([claim[name] for name in columns.values()] for claim in claims)]


def all_claims(data: xr.Dataset) -> list[list[str]]:
    """Return rows of texts for all claims and restored formulas, with all columns."""
    return chosen(EVERYTHING, [claim for group in SECTIONS for claim in claims_of(data, group)])


def counts(data: xr.Dataset) -> dict[str, dict[str, int]]:
    """Count the claims by group and verdict; restored formulas are not counted."""
    found = Counter(
        zip(data["group"].values.tolist(), data["verdict"].values.tolist(), strict=True)
    )
    return {group: {verdict: found[group, verdict] for verdict in VERDICTS} for group in GROUPS}


def summary(data: xr.Dataset) -> list[list[str]]:
    """Return the counts as rows of texts, the header first."""
    found = counts(data)
    used = [verdict for verdict in VERDICTS if any(by[verdict] for by in found.values())]
    rows = [["claims", "in all", *used]]
    for group, by in found.items():
        numbers = [sum(by.values()), *(by[verdict] for verdict in used)]
        rows.append([f"{group}s", *map(str, numbers)])
    return rows


INTRODUCTION = """\
# The claims of the paper and the verdict on each

A row is one claim of the paper, in our words.
[Section 3 of the article](../paper.md) defines the four verdicts.
A distance is in units of the last printed digit, and in per cent of the printed number.
A statement is judged by a condition for each sense of its words: "yes" if it holds, "no" if not.
The column *literal sense* says whether the first one holds, if they differ.
Formulas were *restored* from the damaged text by deriving them again, and are not counted.
"""


def claims_markdown(data: xr.Dataset) -> str:
    """Return the claims with their verdicts as a page in Markdown."""
    text = f"{INTRODUCTION}\n## How many\n\n{markdown(summary(data))}"
    for group, columns in SECTIONS.items():
        rows = chosen(columns, claims_of(data, group))
        text += f"\n## {group.capitalize()}s\n\n{markdown(rows)}"
    return text
