"""Judge the claims of the paper from all datasets, and write the verdicts."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.claims import INTRODUCTION, TABLE, judge
    from paper_replication.datasets import read, save, save_record, write
    from paper_replication.judgements import all_claims, claims_markdown, raised
    from paper_replication.texts import comma_separated

    datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
    verdicts = judge(datasets)
    for line in raised(verdicts):
        # In the log, and on the console.
        print(line, file=sys.stderr)
        print(line, file=sys.__stderr__)
    title = "Verdicts on the paper's claims"
    save(verdicts, snakemake.output.nc, title, {}, sources, PROJECT)
    write(Path(snakemake.output.md), claims_markdown(verdicts, INTRODUCTION, TABLE).encode())
    write(Path(snakemake.output.csv), comma_separated(all_claims(verdicts)).encode())
    save_record(snakemake, sources, PROJECT)
