"""Where these studies lie, and what their records and comparisons need."""

from pathlib import Path

import xarray as xr

from bouncing_ball_beyond import __version__
from carbonelli2011.variables import REFERENCE
from paper_replication.datasets import Project
from studies.variables import described


def side_by_side(name: str, datasets: list[xr.Dataset]) -> list[bytes]:
    """Draw a figure for several datasets, with the same axes, as PNG."""
    from paper_replication.drawing import on_the_same_axes
    from studies.figures import draw

    return on_the_same_axes([draw(name, data) for data in datasets])


def make(name: str, data: xr.Dataset, folder: Path) -> None:
    """Write the pictures, the tables and the page of a dataset into a folder, for a comparison."""
    # A stage depends on none of them.
    from carbonelli2011.curves import SALT
    from paper_replication.drawing import save_picture
    from paper_replication.texts import save_table
    from studies.explorer import page
    from studies.figures import FIGURES, draw
    from studies.tables import TABLES

    if name in FIGURES:
        save_picture(draw(name, data), folder / f"{name}.png", folder / f"{name}.svg", SALT)
    if name in TABLES:
        save_table(TABLES[name](data), folder / f"{name}.md", folder / f"{name}.csv")
    if name == "explorer":
        (folder / "explorer.html").write_text(page(data), encoding="utf-8")


TOP = Path(__file__).resolve().parents[2]

PROJECT = Project(
    top=TOP,
    checkout=TOP.parents[1],
    code=(*(f"extras/beyond/{name}" for name in ("Snakefile", "config", "src", "workflow")), "src"),
    texts=("article.md", "appendix.md", "phase.md", "laid.md"),
    references=REFERENCE,
    source=f"bouncing-ball-beyond {__version__}",
    license="BSD-3-Clause",
    describe=described,
    described_in=("extras/beyond/workflow/studies/variables.py",),
    side_by_side=side_by_side,
    make=make,
)
