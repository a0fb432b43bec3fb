"""A table as text, as Markdown and as CSV."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from paper_replication.datasets import read, save_record
    from paper_replication.texts import save_table
    from studies.tables import TABLES

    data = snakemake.input.data
    rows = TABLES[Path(data).stem](read(data))
    save_table(rows, snakemake.output.md, snakemake.output.csv)
    save_record(snakemake, sources, PROJECT)
