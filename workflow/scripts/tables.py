"""Write a table as Markdown and as CSV, from its dataset."""

import sys
from pathlib import Path

from project import PROJECT

from carbonelli2011.tables import TABLES
from paper_replication.datasets import read, save_record
from paper_replication.texts import comma_separated, markdown

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
rows = TABLES[Path(snakemake.output.md).stem](read(snakemake.input.data))
Path(snakemake.output.md).write_text(markdown(rows), encoding="utf-8", newline="\n")
Path(snakemake.output.csv).write_text(comma_separated(rows), encoding="utf-8", newline="\n")
save_record(snakemake, PROJECT)
