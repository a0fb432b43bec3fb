"""The tables as texts, each as Markdown and as CSV."""

import sys
from pathlib import Path

from bouncing_ball.datasets import read
from bouncing_ball.tables import TABLES, comma_separated, markdown

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
files = zip(snakemake.input.data, snakemake.output.md, snakemake.output.csv, strict=True)
for path, *outputs in files:
    rows = TABLES[Path(path).stem](read(path))
    for output, text in zip(outputs, (markdown(rows), comma_separated(rows)), strict=True):
        Path(output).write_text(text, encoding="utf-8", newline="\n")
