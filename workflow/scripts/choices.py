"""Judge the claims again, with other choices of what cannot be read in the paper."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.choices import changed_verdicts
    from paper_replication.datasets import read, save, save_record

    verdicts = changed_verdicts({Path(path).stem: read(path) for path in snakemake.input.data})
    title = "Verdicts that depend on what cannot be read in the paper"
    save(verdicts, snakemake.output.nc, title, {}, sources, PROJECT)
    save_record(snakemake, sources, PROJECT)
