"""The distribution of the errors of random orbits over what the error law predicts."""

from bouncing_ball.datasets.files import write_text
from bouncing_ball.figures.tables.formats import to_csv
from bouncing_ball.pipeline.job import logged
from bouncing_ball.studies.law_distribution import HEADER, sample, summary

with logged(snakemake) as lines:
    given = snakemake.params
    rows = []
    for release in ("displacement", "force"):
        rows += summary(sample(given.size, given.seed, given.span, release), release)
        lines.append(release)
    write_text(snakemake.output.summary, to_csv(HEADER, rows))
