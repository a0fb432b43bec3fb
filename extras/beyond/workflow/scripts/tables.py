"""A table as text, as Markdown and as CSV."""

import sys
from pathlib import Path

from project import PROJECT

from paper_replication.datasets import read, save_record
from paper_replication.texts import comma_separated, markdown
from studies.tables import TABLES

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
data = snakemake.input.data
rows = TABLES[Path(data).stem](read(data))
texts = {snakemake.output.md: markdown(rows), snakemake.output.csv: comma_separated(rows)}
for path, text in texts.items():
    Path(path).write_text(text, encoding="utf-8", newline="\n")
save_record(snakemake, PROJECT)
