"""The results against the accepted record, with a page about all artifacts or about some."""

from pathlib import Path

from bouncing_ball_beyond.inherited.pipeline.diff.report import write_reports
from bouncing_ball_beyond.inherited.pipeline.job import conclude, logged

with logged(snakemake):
    given = snakemake.params
    if sentence := write_reports(Path(given.house), given.artifacts):
        conclude(sentence)
