from pendulum import PROJECT, period

from paper_replication.datasets import save_stage

save_stage({"fig1": period}, snakemake, PROJECT)
