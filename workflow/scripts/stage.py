"""Compute the datasets of a stage."""

import sys
from importlib import import_module

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from bouncing_ball.orbits import NoOrbit
    from paper_replication.datasets import save_stage

    stage = import_module(f"carbonelli2011.stages.{snakemake.params.stage}")
    try:
        save_stage(stage.STAGE, snakemake, sources, PROJECT)
    except NoOrbit as error:
        sys.exit(f"configuration: {': '.join([*error.__notes__, str(error)])}")
