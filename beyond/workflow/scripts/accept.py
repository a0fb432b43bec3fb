"""Copy results over the accepted record."""

import os
from pathlib import Path

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.diff.accept import accept
from bouncing_ball_beyond.inherited.pipeline.job import conclude, logged

with logged(snakemake) as lines:
    only = os.environ.get("ONLY", "").replace(",", " ").split()
    files = [str(file) for file in snakemake.input]
    try:
        lines += accept(Path(snakemake.params.house), Path("results"), files, only)
        print(*lines, sep="\n", flush=True)
    except ModelError as error:
        conclude(f"accept: {error}")
