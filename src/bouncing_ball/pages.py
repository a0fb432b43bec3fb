"""The page of the results and the list of figures: for each figure and table what the paper says,
what we find, the verdict and the data.

Both are templates over the same parts. What we find is, in words, in the template `findings`; for a
claim that is not there it is the number found, or the conditions that decided.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from bouncing_ball import article, tables
from bouncing_ball.datasets import Datasets

# That of libyaml, if there is one, takes a tenth of the time.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
CONFIGURATION = Path(__file__).parents[2] / "config" / "config.yaml"
SEVERAL = {"several": "Several figures", "": "Statements that no figure shows"}
"""Parts with claims that belong to no single figure or table."""


@dataclass(frozen=True)
class Row:
    """A claim beside a figure or table: what the paper says, what we find, and the verdict."""

    said: str
    found: str
    verdict: str


@dataclass(frozen=True)
class Part:
    """A figure, a table or a dataset, with its claims: `files` by what they are, rows of texts of a
    table, the header first.
    """

    name: str
    title: str
    caption: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    rows: Sequence[Row] = ()
    table: Sequence[Sequence[str]] = ()


def registered(configuration: Path = CONFIGURATION) -> dict[str, dict]:
    """The figures, tables and datasets that a configuration registers, by name."""
    sections = yaml.load(configuration.read_text(encoding="utf-8"), LOADER).values()
    stages = [section for section in sections if isinstance(section, dict)]
    return {
        name: entry for stage in stages for name, entry in stage.items() if isinstance(entry, dict)
    }


def filled_in(
    kind: str, datasets: Datasets, entries: Mapping[str, Mapping] | None = None, **more
) -> str:
    """The list of figures, Markdown ("md"), or the page of the results ("html").

    `entries` are the registered figures, tables and datasets, by default those of config.yaml.
    """
    findings = yaml.load(article.filled_in("findings", datasets, "yaml"), LOADER)
    answer = findings.pop("answer")
    found = parts(datasets, registered() if entries is None else entries, findings)
    return article.filled_in(
        "figures",
        datasets,
        kind,
        answer=answer,
        markdown=tables.markdown,
        counts=tables.summary(datasets["claims"]),
        figures=[part for part in found if "PNG" in part.files],
        tabulated=[part for part in found if part.table],
        others=[part for part in found if part.files.keys() == {"dataset"}],
        general=[part for part in found if not part.files],
        **more,
    )


def parts(
    datasets: Datasets, entries: Mapping[str, Mapping], findings: Mapping[str, Mapping[str, str]]
) -> list[Part]:
    """All figures in the order of the paper, tables and datasets, then `SEVERAL`."""
    rows = rows_of(datasets, findings)
    found = []
    for name in sorted(entries, key=lambda name: (not name.startswith("fig"), name)):
        entry = entries[name]
        kinds = {"dataset": "nc"} if name in datasets else {}
        if "caption" in entry:
            kinds |= {"PNG": "png", "SVG": "svg"}
        if entry.get("table"):
            kinds |= {"CSV": "csv", "Markdown": "md"}
        found.append(
            Part(
                name,
                entry["title"],
                entry.get("caption", ""),
                {label: f"{name}.{kind}" for label, kind in kinds.items()},
                rows.get(name, ()),
                tables.TABLES[name](datasets[name]) if entry.get("table") else (),
            )
        )
    return found + [Part(name, title, rows=rows.get(name, ())) for name, title in SEVERAL.items()]


def rows_of(datasets: Datasets, findings: Mapping[str, Mapping[str, str]]) -> dict[str, list[Row]]:
    """The claims beside each figure or table, by its name: those with a finding in its order, and
    then the others. The ends of Table 1 are in the table itself.
    """
    judged = {
        claim["claim"]: claim
        for group in tables.GROUPS
        for claim in tables.claims_of(datasets["claims"], group)
        if claim["item"] != "Table 1"
    }
    rows = {
        name: [row(judged.get(said, {"statement": said}), text) for said, text in texts.items()]
        for name, texts in findings.items()
    }
    for name, claim in judged.items():
        if not any(name in texts for texts in findings.values()):
            decided_by = claim["decided_by"].partition(", ")[0]
            rows.setdefault(decided_by, []).append(row(claim, ""))
    return rows


def row(claim: Mapping[str, str], finding: str) -> Row:
    """A claim as it is shown; without a finding in words, with what decided it."""
    said = ": ".join(filter(None, (claim["statement"], claim.get("printed_text"))))
    known = (claim.get("computed"), claim.get("condition"), claim.get("reason"))
    return Row(said, finding or "; ".join(filter(None, known)), claim.get("verdict", ""))
