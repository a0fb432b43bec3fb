"""The files of the replication that follow from datasets: pictures, tables, claims and texts."""

from functools import partial
from pathlib import Path

from bouncing_ball import (
    article,
    claims,
    datasets,
    drawing,
    figures,
    pages,
    paper,
    restitution,
    spring_damper,
    tables,
    verdicts,
)
from bouncing_ball.artifacts import Code, Product, picture, table, text
from bouncing_ball.datasets import Datasets
from bouncing_ball.differences import record

PRINTED = Path(__file__).parents[2] / "config" / "table1_printed.csv"
DRAWING: Code = (figures.__file__, drawing.__file__, paper.__file__)
TABULATING: Code = (tables.__file__, claims.__file__, verdicts.__file__, paper.__file__)
JUDGING: Code = (
    claims.__file__,
    verdicts.__file__,
    paper.__file__,
    restitution.__file__,
    spring_damper.__file__,
    PRINTED,
)
WRITING: Code = (
    article.__file__,
    pages.__file__,
    tables.__file__,
    *JUDGING,
    article.CHOICES,
    *sorted([*article.TEMPLATES.glob("*.md.j2"), article.TEMPLATES / "findings.yaml.j2"]),
)


def figure(name: str) -> Product:
    """A figure, drawn from its dataset, if it has one."""
    needs = (name,) if name in figures.PLOTS else ()
    return picture(
        name, needs, lambda data: figures.draw(name, *(data[need] for need in needs)), DRAWING
    )


def judge(data: Datasets, folder: Path) -> None:
    """Write the verdicts on the claims, with what the dataset of claims records of itself."""
    # A new figure is not in the reference yet.
    known = {name: data[name] for name in STUDIES if name in data}
    judged = claims.judge(known, datasets.printed_table(PRINTED))
    title = data["claims"].attrs["title"]
    path = folder / "figures" / "claims.nc"
    datasets.save(judged, path, title, record(data["claims"], "parameters"), code=[])


DECIDING = [name for claim in claims.CLAIMS for name in claim.datasets]
STUDIES = list(dict.fromkeys([*figures.PLOTS, *tables.TABLES, *DECIDING]))
"""The datasets that are computed from the models."""
ALL = (*STUDIES, "claims")
"""All datasets. The claims follow from the others."""

TABULATED = [
    *((f"{name}.md", rows, tables.markdown) for name, rows in tables.TABLES.items()),
    *((f"{name}.csv", rows, tables.comma_separated) for name, rows in tables.TABLES.items()),
]
PRODUCTS = [
    *(figure(name) for name in figures.FIGURES),
    *(table(file, rows, write, TABULATING) for file, rows, write in TABULATED),
    Product(("figures/claims.nc",), ALL, judge, JUDGING),
    text(
        "figures/claims.md",
        ("claims",),
        lambda data: tables.claims_markdown(data["claims"]),
        WRITING,
    ),
    table("claims.csv", tables.all_claims, tables.comma_separated, TABULATING),
    text("paper.md", ALL, partial(article.filled_in, "paper"), WRITING),
    text("supplement.md", ALL, partial(article.filled_in, "supplement"), WRITING),
    text("figures/README.md", ALL, partial(pages.filled_in, "md"), WRITING),
]
"""All files that follow from datasets, and how."""
