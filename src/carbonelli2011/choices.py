"""Study: which verdicts depend on what cannot be read in the paper.

Each choice of ours is varied: the ends of axes, the frequency ratios of Fig. 12, and the exponent
of the largest frequency ratio. The claims that the dataset of a choice decides are judged again,
with the other datasets of the run. Datasets of other choices have fewer points than those of the
figures. Of a run with other parameters than the paper's nothing is varied.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from carbonelli2011 import claims
from carbonelli2011.paper import TABLE_1, changed_parameters, of_paper, printed_table
from carbonelli2011.stages import (
    apparent_restitution,
    continuation,
    error_thresholds,
    permanent_contact,
    restitution_model,
    time_histories,
)
from paper_replication.datasets import Datasets, computed, parameters
from paper_replication.verdicts import Claim, answer

ALONG_RATIO = {
    "fig05": apparent_restitution.cases,
    "fig06": apparent_restitution.cases,
    "fig10": apparent_restitution.amplitudes,
    "fig13": apparent_restitution.amplitudes,
    "fig14": error_thresholds.fig14,
}
PERMANENT_CONTACT = {"fig11": permanent_contact.fig11, "fig16": permanent_contact.fig16}
ALONG_AMPLITUDE: Mapping[str, tuple[Callable, Sequence[float]]] = {
    "fig03": (restitution_model.fig03, [1.5, 4]),
    "fig08": (continuation.branches, [1.2, 3]),
    "fig09": (continuation.branches, [1.2, 3]),
    "fig15": (continuation.fig15, [1.8, 3]),
}
"""Functions of figures along Λ, and other ends of their axes."""
EXPONENTS = (2, 3, 6)
"""Other exponents of the largest frequency ratio."""
RATIOS_OF_FIG_12 = ([1.0, 2.0, 10.0, 100.0], [2.0, 10.0, 100.0, 1e3], [5.0, 10.0, 100.0, 1e4])
PER_DECADE = 20
"""Points of an axis of ϖ, of which 1, 10 and 100 are some."""
POINTS = 101
"""Points of a branch."""


class Choice(NamedTuple):
    """Another choice: what is chosen, what it is instead, and the datasets that it changes.

    `table` is the printed Table 1 with other frequency ratios.
    """

    item: str
    instead: str
    datasets: Datasets
    table: Mapping = TABLE_1


def decided_by(names: Set[str], table: Mapping = TABLE_1) -> list[Claim]:
    """The claims of the paper that some named datasets decide."""
    decided = [claim for claim in claims.CLAIMS if claim.place and names & claim.datasets.keys()]
    return decided + claims.table1_ends(table) if "table1" in names else decided


def verdicts(
    datasets: Datasets, names: Set[str], table: Mapping = TABLE_1
) -> list[tuple[str, str]]:
    """Each claim that some named datasets decide, with its verdict, whatever their parameters.

    If an axis does not reach what the claim is about, it is "beyond the axis".
    """
    asked = [
        replace(claim, datasets={name: {} for name in claim.datasets})
        for claim in decided_by(names, table)
    ]
    answers = [(claim.name, answer(claim, datasets)["verdict"]) for claim in asked]
    return [(name, verdict.replace("not asked", "beyond the axis")) for name, verdict in answers]


def axis_of(name: str) -> str:
    """What is chosen of a figure, in words."""
    return f"axis of Fig. {int(name.removeprefix('fig'))}"


def other_axes(
    data: xr.Dataset, compute: Callable, left: list[float], right: list[float]
) -> Iterator[tuple[str, xr.Dataset]]:
    """A figure along ϖ with other left or right ends of its axis, after the axis in words.

    Where a curve ends within the axis because its orbits cease, the axis ends there.
    """
    now = parameters(data)["frequency_ratio"]
    first, last = np.round(PER_DECADE * np.log10([min(left), max(right)]))
    ends = {"min": 10 ** (first / PER_DECADE), "max": 10 ** (last / PER_DECADE)}
    axis = {"frequency_ratio": ends | {"samples": int(last - first) + 1}}
    wide = computed(compute, parameters(data) | axis)
    wide = wide.assign_coords(frequency_ratio=wide.frequency_ratio.round(12))
    limits = [(end, now["max"]) for end in left] + [(now["min"], end) for end in right]
    for low, high in limits:
        part = wide.sel(frequency_ratio=slice(low * (1 - 1e-9), high * (1 + 1e-9)))
        yield f"ϖ from {low:g} to {high:g}", part.dropna("frequency_ratio")


def choices(data: Datasets) -> Iterator[Choice]:
    """All other choices; none if the run is not that of the paper."""
    if changed_parameters(data):
        return
    axes = (
        (ALONG_RATIO, [0.5, 2, 5], [100, 200, 1e4]),
        (PERMANENT_CONTACT, [0.1, 1, 2], [10, 20, 1e3]),
    )
    for functions, left, right in axes:
        for name, compute in functions.items():
            for axis, other in other_axes(data[name], compute, left, right):
                yield Choice(axis_of(name), axis, {name: other})
    for name, (compute, ends) in ALONG_AMPLITUDE.items():
        for end in ends:
            changes = {"amplitude_max": end, "points": POINTS}
            other = computed(compute, parameters(data[name]) | changes)
            yield Choice(axis_of(name), f"Λ from 0 to {end:g}", {name: other})
    yield from ratios_of_fig_12(data)
    yield from exponents(data)


def ratios_of_fig_12(data: Datasets) -> Iterator[Choice]:
    """Other frequency ratios of Fig. 12."""
    for ratios in RATIOS_OF_FIG_12:
        changes = {"frequency_ratio": ratios}
        other = computed(time_histories.fig12, parameters(data["fig12"]) | changes)
        instead = "ϖ = " + ", ".join(f"{ratio:g}" for ratio in ratios)
        yield Choice("ratios of Fig. 12", instead, {"fig12": other})


def exponents(data: Datasets) -> Iterator[Choice]:
    """Other exponents of the largest frequency ratio, in Figs. 8 and 9 and Table 1.

    All are computed at once, because the compliant contacts are the same.
    """
    printed = printed_table()
    compliant = printed.frequency_ratio.values[1:].tolist()
    every = {"frequency_ratio": [*(10.0**exponent for exponent in EXPONENTS), *compliant]}
    wide = {
        name: computed(continuation.branches, parameters(data[name]) | every | {"points": POINTS})
        for name in ("fig08", "fig09")
    }
    wide["table1"] = computed(continuation.table1, parameters(data["table1"]) | every)
    for exponent in EXPONENTS:
        ratios = [10.0**exponent, *compliant]
        other_table = printed.assign_coords(frequency_ratio=ratios)
        others = {name: whole.sel(frequency_ratio=ratios) for name, whole in wide.items()}
        others["table1"]["printed"] = other_table.astype(float)
        table = {
            (10.0**exponent if ratio == max(TABLE_1)[0] else ratio, n): texts
            for (ratio, n), texts in TABLE_1.items()
        }
        yield Choice("exponent of the largest ϖ", str(exponent), others, table)


def changed_verdicts(data: Datasets) -> xr.Dataset:
    """Each other choice with the verdicts that it changes, as texts."""
    data = of_paper(data)
    rows = []
    here: dict[frozenset[str], list[tuple[str, str]]] = {}
    for item, instead, datasets, table in choices(data):
        names = frozenset(datasets)
        if names not in here:
            here[names] = verdicts(data, names)
        there = verdicts({**data, **datasets}, names, table)
        changes = [
            f"{name}: {before} → {after}"
            for (name, before), (_, after) in zip(here[names], there, strict=True)
            if before != after
        ]
        rows.append((item, instead, "; ".join(changes)))
    columns = np.array(rows, dtype=str).reshape(-1, 3).T
    pairs = zip(("choice", "instead", "changes"), columns, strict=True)
    return xr.Dataset({name: ("alternative", texts) for name, texts in pairs})
