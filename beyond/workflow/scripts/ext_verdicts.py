"""The verdicts on printed numbers, decided by certified intervals."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.certified_verdicts import certified_verdicts

with job.logged(snakemake):
    make_datasets(snakemake, ext_verdicts=certified_verdicts)
