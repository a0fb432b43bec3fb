"""The results against the accepted record."""

import sys
from pathlib import Path

from bouncing_ball.compare.reports import compare_and_report
from bouncing_ball.pipeline.job import logged

reports = Path("results", "diff")
with logged(snakemake) as lines:
    table, status = compare_and_report(
        Path(snakemake.params.record),
        Path("results"),
        snakemake.input.tolerances,
        json=reports / "diff.json",
        markdown=reports / "diff.md",
        html=reports / "index.html",
    )
    lines += table.splitlines()
    print(table, end="", flush=True)
if status:
    sys.exit(f"diff: see {reports / 'index.html'}, or diff.md and diff.json beside it")
