"""Table 1, the thresholds, and hypotheses on the printed numbers.

Each table is a function of its dataset that returns rows of texts, the header first.
"""

import numpy as np
import xarray as xr

from carbonelli2011.claims import table1_ends
from carbonelli2011.paper import QUANTITIES, end_of_range
from paper_replication.datasets import parameters
from paper_replication.judgements import computed_text, distance_text
from paper_replication.texts import number, parts_along
from paper_replication.verdicts import answer

NOT_FOLLOWED = ", which no ball follows"
"""What is added to the number of an orbit that is not admissible."""


# Numbers


def table1(data: xr.Dataset) -> list[list[str]]:
    """Table 1: each end of a range of stable orbits, computed and printed, with the verdict.

    A range goes from the saddle-node to the next period doubling. The table omits further stable
    ranges of the same family. The paper prints Λ to three decimals. An end that rounds to the
    printed Λ has no distance.
    """
    rows = [["ϖ", "n", "end", "computed", "printed", "distance", "verdict"]]
    ends = {claim.name: claim for claim in table1_ends()}
    for end in parts_along(data, "frequency_ratio", "n", "bound"):
        ratio, n, bound = (end[name].item() for name in ("frequency_ratio", "n", "bound"))
        printed = number(end["printed"], ".3f", "")
        claim = ends.get(end_of_range(ratio, n, bound)) if printed else None
        judged = answer(claim, {"table1": data}) if claim else {}
        distance = distance_text(judged.get("deviation_units", np.nan), judged.get("deviation", 0))
        if judged.get("verdict") == "reproduced":
            distance = f"rounds to {printed}"
        computed = number(end["computed"], ".5f", "no such bifurcation")
        if not end["admissible"] and np.isfinite(end["computed"]):
            computed += NOT_FOLLOWED
        named = [number(ratio, "g"), str(n), bound]
        rows.append([*named, computed, printed, distance, judged.get("verdict", "")])
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
    for line in parts_along(data, "quantity"):
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
    ratios = list(dict.fromkeys(row[np.isfinite(row)]))
    single = data["number"].values[np.isnan(row)]
    printed = data["printed_text"].sel(number=single).values.tolist()
    heads = [f"Table 1, ϖ = {ratio:g}" for ratio in ratios]
    names = [f"{name}, printed {text}" for name, text in zip(single, printed, strict=True)]
    mean = "root mean square distance, compliant rows"
    rows = [["hypothesis", *heads, mean, *names, "reproduced"]]
    for line in parts_along(data, "hypothesis"):
        agrees = line["agrees"].values
        ends = [agrees[row == ratio] for ratio in ratios]
        others = line[["found", "deviation_units"]].sel(number=single)
        numbers = []
        for text, one in zip(printed, parts_along(others, "number"), strict=True):
            value = computed_text(float(one["found"]), text)
            units = number(one["deviation_units"], "+.2f")
            numbers.append(value if value == units else f"{value} ({units})")
        cells = [f"{hits.sum()} of {hits.size}" for hits in ends]
        cells += [number(line["rms_difference"], ".2f"), *numbers]
        rows.append([line["hypothesis"].item(), *cells, f"{agrees.sum()} of {agrees.size}"])
    return rows


TABLES = {"table1": table1, "thresholds": thresholds, "hypotheses": hypotheses}
"""The tables by name."""
