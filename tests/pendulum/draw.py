from pathlib import Path

from paper_replication.provenance import reading

with reading(snakemake.input) as sources:
    from pendulum import PROJECT, save_drawn

    from paper_replication.datasets import read, save_record

    save_drawn("fig1", read(snakemake.input.data), Path(snakemake.output.png).parent)
    save_record(snakemake, sources, PROJECT)
