"""The results against the accepted record."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.page import to_html, to_terminal
from bouncing_ball.pipeline.jobs import conclude, logged

table_file, page = Path("results/diff/diff.txt"), Path("results/diff/index.html")
with logged(snakemake) as lines:
    comparison = compare_folders(Path(snakemake.params.record), Path("results"))
    table = to_terminal(comparison)
    lines += table.splitlines()
    write_text(table_file, table)
    write_text(page, to_html(comparison))
    print(table, end="", flush=True)
    if comparison.outcome.status:
        conclude(f"diff: the results differ from the record, see {page}")
