"""One dataset by the study of its stage."""

from adapter import function

from bouncing_ball.pipeline.configuration import typed
from bouncing_ball.pipeline.jobs import logged, make_dataset

with logged(snakemake) as lines:
    study = function(snakemake.params.module, snakemake.params.study)
    lines += make_dataset(snakemake, typed(study))
