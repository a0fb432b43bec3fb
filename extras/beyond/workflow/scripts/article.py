"""The article, its appendices and the list of figures, from all datasets."""

import sys
from pathlib import Path

from bouncing_ball.datasets import read
from studies.article import filled_in

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
for name, path in snakemake.output.items():
    Path(path).write_text(filled_in(name, datasets), encoding="utf-8", newline="\n")
