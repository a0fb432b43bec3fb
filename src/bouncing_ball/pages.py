"""The page of the results and the list of figures, both templates over the same parts.

A part is a figure, a table or a dataset, with the claims that are shown beside it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from bouncing_ball import article, tables
from bouncing_ball.datasets import Datasets

SEVERAL = {"several": "Several figures", "": "Statements that no figure shows"}
"""Parts with claims that belong to no single figure or table."""


@dataclass(frozen=True)
class Row:
    """A claim: what the paper says, what we find, and the verdict."""

    said: str
    found: str
    verdict: str


@dataclass(frozen=True)
class Part:
    """A figure, a table or a dataset, with its claims.

    Attributes
    ----------
    name, title, caption
        Those of config.yaml.
    files
        Names of the files, by what they are.
    rows
        The claims.
    table
        Rows of texts, the header first.
    """

    name: str
    title: str
    caption: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    rows: Sequence[Row] = ()
    table: Sequence[Sequence[str]] = ()


def filled_in(kind: str, datasets: Datasets, entries: Mapping[str, Mapping], **more) -> str:
    """Return the list of figures in Markdown ("md"), or the page of the results ("html").

    `entries` are the registered figures, tables and datasets by name.
    """
    found = parts(datasets, entries)
    return article.filled_in(
        "figures",
        datasets,
        kind,
        markdown=tables.markdown,
        counts=tables.summary(datasets["claims"]),
        figures=[part for part in found if "PNG" in part.files],
        tabulated=[part for part in found if part.table],
        others=[part for part in found if part.files.keys() == {"dataset"}],
        general=[part for part in found if not part.files],
        **more,
    )


def parts(datasets: Datasets, entries: Mapping[str, Mapping]) -> list[Part]:
    """All figures in the order of the paper, tables and datasets, then `SEVERAL`."""
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
                rows_beside(name, datasets),
                tables.TABLES[name](datasets[name]) if entry.get("table") else (),
            )
        )
    general = [Part(key, title, rows=rows_beside(key, datasets)) for key, title in SEVERAL.items()]
    return found + general


def rows_beside(name: str, datasets: Datasets) -> list[Row]:
    """The claims beside a figure or table; the ends of Table 1 are in the table itself."""
    return [
        row(claim)
        for group in tables.GROUPS
        for claim in tables.claims_of(datasets["claims"], group)
        if claim["beside"] == name and claim["item"] != "Table 1"
    ]


def row(claim: Mapping[str, str]) -> Row:
    """A claim as it is shown: with the number found, or with what decided it."""
    said = ": ".join(filter(None, (claim["statement"], claim["printed_text"])))
    known = (claim["computed"], claim["condition"], claim["reason"])
    return Row(said, "; ".join(filter(None, known)), claim["verdict"])
