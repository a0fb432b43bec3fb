from pathlib import Path

from pendulum import PROJECT, draw

from paper_replication.datasets import read, save_record

draw("fig1", read(snakemake.input.data), Path(snakemake.output.png).parent)
save_record(snakemake, PROJECT)
