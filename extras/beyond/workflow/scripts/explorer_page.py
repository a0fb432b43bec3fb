"""The explorer's page from its reference orbits."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from paper_replication.datasets import read, save_record
    from studies.explorer import page

    data = read(snakemake.input.data)
    Path(snakemake.output.html).write_text(page(data), encoding="utf-8", newline="\n")
    save_record(snakemake, sources, PROJECT)
