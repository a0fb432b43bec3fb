"""The explorer's page from its reference orbits."""

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.job import logged, read_input
from bouncing_ball.render.explorer.document import to_html

with logged(snakemake) as lines:
    write_text(snakemake.output.html, to_html(read_input(snakemake.input.data)))
    lines += snakemake.output
