"""Verdicts on the claims of the ledger, and the tally."""

from pathlib import Path

from bouncing_ball.audit.claims.assessment import assess
from bouncing_ball.audit.claims.ledger import parse_ledger
from bouncing_ball.audit.claims.tally import tally
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.pipeline.job import REFERENCE, logged, provenance

with logged(snakemake) as lines:
    paths = map(Path, snakemake.input.data)
    data = {path.stem: read_dataset(path) for path in paths}
    ledger = parse_ledger(snakemake.params.ledger)
    verdicts = assess(ledger, data)
    verdicts.attrs |= {
        "title": snakemake.rule,
        "references": REFERENCE,
        **provenance(snakemake, dict(snakemake.params.items())).attributes(),
    }
    write_dataset(verdicts, snakemake.output.data)
    last = tally(verdicts, snakemake.params.figures)
    write_text(snakemake.output.tally, last + "\n")
    lines.append(last)
