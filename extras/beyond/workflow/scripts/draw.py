"""Draw figures, each from its dataset."""

import sys
from pathlib import Path

from bouncing_ball.datasets import read
from bouncing_ball.drawing import save_picture
from bouncing_ball.history import commit
from studies.figures import draw

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
files = zip(snakemake.input.data, snakemake.output.png, snakemake.output.svg, strict=True)
for data, png, svg in files:
    save_picture(draw(Path(data).stem, read(data)), png, svg, commit(snakemake.input.code))
