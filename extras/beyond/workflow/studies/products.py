"""The files of beyond that follow from datasets: pictures, tables, the explorer and texts."""

from functools import partial

from bouncing_ball import accept, drawing
from bouncing_ball import tables as replicated_tables
from bouncing_ball.artifacts import Code, Product, picture, table, text
from studies import article, explorer, figures, tables

CODE = (*accept.CODE, "../../src", "../../workflow")
"""What must be committed, so that the commit that a reference names is the code that made it: that
of this package, and that of the replication."""

DRAWING: Code = (figures.__file__, drawing.__file__)
TABULATING: Code = (tables.__file__, replicated_tables.__file__)
WRITING: Code = (article.__file__, *sorted(article.TEMPLATES.glob("*.md.j2")))
EXPLORING: Code = (explorer.__file__, *explorer.FILES)

DATASETS = (*figures.FIGURES, "ext_basin", "explorer")
"""All datasets."""


def figure(name: str) -> Product:
    """A figure, drawn from its dataset."""
    return picture(name, (name,), lambda data: figures.draw(name, data[name]), DRAWING)


TABULATED = [
    *((f"{name}.md", rows, replicated_tables.markdown) for name, rows in tables.TABLES.items()),
    *(
        (f"{name}.csv", rows, replicated_tables.comma_separated)
        for name, rows in tables.TABLES.items()
    ),
]
PRODUCTS = [
    *(figure(name) for name in figures.FIGURES),
    *(table(file, rows, write, TABULATING) for file, rows, write in TABULATED),
    text(
        "figures/explorer.html",
        ("explorer",),
        lambda data: explorer.page(data["explorer"]),
        EXPLORING,
    ),
    text("article.md", DATASETS, partial(article.filled_in, "article"), WRITING),
    text("phase.md", DATASETS, partial(article.filled_in, "phase"), WRITING),
    text("appendix.md", DATASETS, partial(article.filled_in, "appendix"), WRITING),
    text("figures/README.md", DATASETS, partial(article.filled_in, "figures"), WRITING),
]
"""All files that follow from datasets, and how."""
