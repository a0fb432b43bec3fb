"""The verdicts on printed numbers, decided by certified intervals."""

from bouncing_ball.pipeline.job import logged, make_datasets
from bouncing_ball_beyond.exhibits.certified_verdicts import certified_verdicts

with logged(snakemake):
    make_datasets(snakemake, ext_verdicts=certified_verdicts)
