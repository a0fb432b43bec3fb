"""The explorer's page from its reference orbits."""

from bouncing_ball_beyond.accuracy.errors import QUANTITIES
from bouncing_ball_beyond.explorer.document import to_html
from bouncing_ball_beyond.inherited.datasets.files import write_text
from bouncing_ball_beyond.inherited.pipeline.job import logged, read_input

with logged(snakemake):
    page = to_html(read_input(snakemake.input.data), QUANTITIES)
    write_text(snakemake.output.html, page)
