"""The results against the accepted record."""

from pathlib import Path

from bouncing_ball.compare.report import compared
from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.conclusion import conclude
from bouncing_ball.pipeline.job import logged

table_file, page = Path("results/diff/diff.txt"), Path("results/diff/index.html")
with logged(snakemake) as lines:
    table, status = compared(Path(snakemake.params.record), Path("results"), page=page)
    lines += table.splitlines()
    write_text(table_file, table)
    print(table, end="", flush=True)
    if status:
        conclude(f"diff: the results differ from the record, see {page}")
