"""The results against the accepted record, with a page about all artifacts or about some."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.page import to_html, to_terminal
from bouncing_ball.pipeline.jobs import conclude, logged

FOLDER = Path("results/diff")

with logged(snakemake) as lines:
    given = snakemake.params
    comparison = compare_folders(Path(given.record), Path("results"), given.artifacts)
    report = to_terminal(comparison)
    lines += report.splitlines()
    write_text(FOLDER / f"{given.name or 'diff'}.txt", report)
    page = FOLDER / f"{given.name or 'index'}.html"
    write_text(page, to_html(comparison))
    print(report, end="", flush=True)
    if comparison.outcome.status:
        conclude(f"diff: the results differ from the record (exit status 1), see {page}")
