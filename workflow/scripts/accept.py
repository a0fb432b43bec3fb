"""Make the results the accepted record."""

from pathlib import Path

from bouncing_ball.pipeline.job import logged
from bouncing_ball.record.accept import accept

with logged(snakemake) as lines:
    results = Path("results")
    files = sorted({Path(path).relative_to(results).as_posix() for path in snakemake.input})
    lines += accept(Path(snakemake.params.record), results, files, snakemake.config)
