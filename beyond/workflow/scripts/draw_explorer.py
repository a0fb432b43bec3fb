"""The explorer's page from its reference orbits."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.datasets import read_input
from bouncing_ball_beyond.accuracy.errors import QUANTITIES
from bouncing_ball_beyond.explorer.document import to_html

with job.logged(snakemake):
    page = to_html(read_input(snakemake.input.data), QUANTITIES)
    write_text(snakemake.output.html, page)
