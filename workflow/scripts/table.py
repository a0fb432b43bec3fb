"""One table as CSV and Markdown from its dataset."""

from pathlib import Path

from adapter import function

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import tables_by_suffix
from bouncing_ball.pipeline.jobs import logged, read_input

with logged(snakemake) as lines:
    columns = function(snakemake.params.figures, snakemake.params.table)
    table = tables_by_suffix(*columns(read_input(snakemake.input.data)))
    for path in snakemake.output:
        write_text(path, table[Path(path).suffix])
    lines += snakemake.output
