"""Draw figures, each from its dataset if it has one."""

import sys
from pathlib import Path

from bouncing_ball.datasets import read
from bouncing_ball.drawing import save_picture
from bouncing_ball.figures import draw
from bouncing_ball.history import commit

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
datasets = {Path(file).stem: read(file) for file in snakemake.input.get("data", [])}
for png, svg in zip(snakemake.output.png, snakemake.output.svg, strict=True):
    name = Path(png).stem
    shown = [datasets[name]] if name in datasets else []
    save_picture(draw(name, *shown), png, svg, commit(snakemake.input.code))
