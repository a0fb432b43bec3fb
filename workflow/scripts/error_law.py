"""The distribution of the errors of random orbits over what the error law predicts."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.datasets.files import write_text
from bouncing_ball.figures.tables.formats import to_csv
from bouncing_ball.parameters import Span
from bouncing_ball.pipeline.job import logged
from bouncing_ball.studies.law_distribution import HEADER, sample, summary

with logged(snakemake) as lines:
    given, rows = snakemake.params, []
    for release in Release:
        rows += summary(sample(given.size, given.seed, Span(**given.span), release), release)
        lines.append(release)
    write_text(snakemake.output.summary, to_csv(HEADER, rows))
