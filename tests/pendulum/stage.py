from paper_replication.provenance import reading

with reading(snakemake.input) as sources:
    from pendulum import PROJECT, period

    from paper_replication.datasets import save_stage

    save_stage({"fig1": period}, snakemake, sources, PROJECT)
