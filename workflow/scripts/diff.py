"""The results against the accepted record."""

from pathlib import Path

from bouncing_ball.compare.report import compared
from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.job import logged

reports = Path("results", "diff")
with logged(snakemake) as lines:
    table, status = compared(
        Path(snakemake.params.record), Path("results"), page=reports / "index.html"
    )
    lines += table.splitlines()
    print(table, end="", flush=True)
    write_text(reports / "diff.txt", table)
verdict = Path("results/diff/differs")
verdict.unlink(missing_ok=True)
if status:
    write_text(verdict, f"The results differ from the record: see {reports / 'index.html'}\n")
