"""Copy results over the accepted record."""

import os
from pathlib import Path

from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.diff.accept import accept
from bouncing_ball.pipeline.jobs import conclude, logged

with logged(snakemake) as lines:
    given = snakemake.params
    only = os.environ.get("ONLY", "").replace(",", " ").split()
    try:
        lines += accept(Path(given.record), Path("results"), given.files, snakemake.config, only)
        print(*lines, sep="\n", flush=True)
    except ModelError as error:
        conclude(f"accept: {error}")
