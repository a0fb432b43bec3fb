"""The results against the accepted record, with a page about all artifacts or about some."""

from pathlib import Path

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.diff.report import write_reports

with job.logged(snakemake):
    given = snakemake.params
    if sentence := write_reports(Path(given.house), given.artifacts):
        job.conclude(sentence)
