"""The verdicts on printed numbers, decided by certified intervals."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.certified_verdicts import certified_verdicts

with logged(snakemake):
    make_dataset(snakemake, certified_verdicts)
