"""The text of one table, as Markdown and as CSV."""

from pathlib import Path

from bouncing_ball import datasets, tables

rows = tables.TABLES[snakemake.wildcards.table](datasets.read(snakemake.input.data))  # noqa: F821
texts = {"markdown": tables.markdown(rows), "csv": tables.comma_separated(rows)}
for name, text in texts.items():
    Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")  # noqa: F821
