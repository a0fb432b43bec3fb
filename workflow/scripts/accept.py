"""Make the results the accepted record."""

import os
from pathlib import Path

from bouncing_ball.pipeline.job import logged
from bouncing_ball.record.accept import accept
from bouncing_ball.record.recipe import Run

with logged(snakemake) as lines:
    results = Path("results")
    files = sorted({Path(path).relative_to(results).as_posix() for path in snakemake.input})
    # Not by --config, which takes a colon or a hash of the reason for its own.
    reason, only = (os.environ.get(name, "") for name in ("REASON", "ONLY"))
    run = Run.of(Path(snakemake.params.record).resolve(), snakemake.config)
    lines += accept(run, results, snakemake.params.recipes, files, reason, only, lambda *_: None)
