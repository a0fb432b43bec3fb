from pathlib import Path

from pendulum import PROJECT

from paper_replication.acceptance import accept

print(accept(PROJECT, Path("results"), snakemake.input))
