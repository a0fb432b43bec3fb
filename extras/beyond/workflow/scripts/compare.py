"""Compare results with the reference, print what differs, and write a page with both pictures.

Snakemake runs this script for the target `diff`; results from elsewhere are compared with the
reference, or with each other:

    python workflow/scripts/compare.py RUN
    python workflow/scripts/compare.py RUN OTHER
"""

import sys
from dataclasses import replace
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / folder) for folder in ("src", "workflow", "../../src")]

import xarray as xr  # noqa: E402
from project import PROJECT  # noqa: E402

from paper_replication.compare import main, report_of_run  # noqa: E402
from paper_replication.drawing import save_picture  # noqa: E402
from paper_replication.texts import comma_separated, markdown  # noqa: E402
from studies.explorer import page  # noqa: E402
from studies.figures import FIGURES, draw  # noqa: E402
from studies.tables import TABLES  # noqa: E402


def make(name: str, data: xr.Dataset, folder: Path) -> None:
    """Write the pictures, the tables and the page of a dataset into a folder."""
    if name in FIGURES:
        save_picture(draw(name, data), folder / f"{name}.png", folder / f"{name}.svg")
    if name in TABLES:
        rows = TABLES[name](data)
        (folder / f"{name}.md").write_text(markdown(rows), encoding="utf-8")
        (folder / f"{name}.csv").write_text(comma_separated(rows), encoding="utf-8")
    if name == "explorer":
        (folder / "explorer.html").write_text(page(data), encoding="utf-8")


PROJECT = replace(PROJECT, make=make)

if __name__ == "__main__" and "snakemake" not in globals():
    sys.exit(main(PROJECT, sys.argv[1:]))

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    given = snakemake.params.config, snakemake.params.names
    sys.exit(report_of_run(PROJECT, Path("results"), *given))
