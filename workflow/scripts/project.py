"""Where this replication lies, and what its records and comparisons need."""

from pathlib import Path

import xarray as xr

from bouncing_ball import __version__
from carbonelli2011.variables import REFERENCE, described
from paper_replication.datasets import Project


def side_by_side(name: str, datasets: list[xr.Dataset]) -> list[bytes]:
    """Draw a figure for several datasets, with the same axes, as PNG."""
    from carbonelli2011.figures import draw
    from paper_replication.drawing import on_the_same_axes

    return on_the_same_axes([draw(name, data) for data in datasets])


def make(name: str, data: xr.Dataset | None, folder: Path) -> None:
    """Write the pictures and the tables of a dataset into a folder, for a comparison."""
    # A stage depends on neither figures nor tables.
    from carbonelli2011.curves import SALT
    from carbonelli2011.figures import FIGURES, draw, moving
    from carbonelli2011.tables import TABLES
    from paper_replication.drawing import save_picture
    from paper_replication.texts import save_table

    if name in FIGURES:
        shown = [] if data is None else [data]
        pictures = [folder / f"{name}.{kind}" for kind in ("png", "svg")]
        save_picture(draw(name, *shown), *pictures, SALT, moving(name, *shown))
    if name in TABLES:
        save_table(TABLES[name](data), folder / f"{name}.md", folder / f"{name}.csv")


TOP = Path(__file__).resolve().parents[2]

PROJECT = Project(
    top=TOP,
    checkout=TOP,
    code=("Snakefile", "config", "src", "workflow"),
    texts=("paper.md", "supplement.md"),
    references=REFERENCE,
    source=f"bouncing-ball {__version__}",
    license="BSD-3-Clause",
    describe=described,
    described_in=("src/carbonelli2011/variables.py",),
    side_by_side=side_by_side,
    make=make,
)
