"""The distribution of the errors of random orbits over what the error law predicts."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.datasets.files import write_text
from bouncing_ball.figures.tables.formats import to_csv
from bouncing_ball.pipeline.job import logged
from bouncing_ball.studies.law_distribution import HEADER, sample, summary
from bouncing_ball.studies.model_errors import Orders

with logged(snakemake) as lines:
    given, rows = Orders(**snakemake.params.orders), []
    for release in Release:
        drawn = sample(snakemake.params.size, given.random.seed, given.frequency_ratio, release)
        rows += summary(drawn, release)
        lines.append(release)
    write_text(snakemake.output.summary, to_csv(HEADER, rows))
