"""The article, its supplement and the list of figures, from all datasets."""

import sys
from pathlib import Path

from bouncing_ball import article
from bouncing_ball.datasets import read

sys.stderr = open(snakemake.log[0], "w")  # what goes wrong is in the log
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
texts = {
    "paper": article.paper(datasets),
    "supplement": article.supplement(datasets),
    "figures": article.figure_list(datasets),
}
for name, text in texts.items():
    Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")
