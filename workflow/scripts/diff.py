"""The results against the accepted record."""

import sys
from pathlib import Path

from bouncing_ball.pipeline.job import logged
from bouncing_ball.record.diff.folders import compare_folders
from bouncing_ball.record.diff.outcome import status
from bouncing_ball.record.diff.report_terminal import to_terminal
from bouncing_ball.record.diff.reports import write_reports
from bouncing_ball.record.diff.tolerance_file import read_tolerances

with logged(snakemake) as lines:
    reports = Path("results", "diff")
    rules = read_tolerances(snakemake.input.tolerances)
    comparison = compare_folders(Path(snakemake.params.record), Path("results"), rules)
    write_reports(
        comparison,
        json=reports / "diff.json",
        markdown=reports / "diff.md",
        html=reports / "index.html",
    )
    table = to_terminal(comparison)
    lines += table.splitlines()
    print(table, end="", flush=True)
if status(comparison.outcome):
    sys.exit(f"diff: see {reports / 'index.html'}, or diff.md and diff.json beside it")
