"""Write a table as Markdown and as CSV, from its dataset."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.tables import TABLES
    from paper_replication.datasets import read, save_record
    from paper_replication.texts import save_table

    rows = TABLES[Path(snakemake.output.md).stem](read(snakemake.input.data))
    save_table(rows, snakemake.output.md, snakemake.output.csv)
    save_record(snakemake, sources, PROJECT)
