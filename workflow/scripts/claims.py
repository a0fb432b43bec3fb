"""The verdicts on the claims of the paper, from all datasets, and their texts."""

import sys
from pathlib import Path

from bouncing_ball.claims import judge
from bouncing_ball.datasets import printed_table, read, save
from bouncing_ball.tables import all_claims, claims_markdown, comma_separated

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
verdicts = judge(datasets, printed_table(snakemake.input.printed))
title = "Verdicts on the paper's claims"
save(verdicts, snakemake.output.nc, title, {}, snakemake.input.code)
texts = {
    snakemake.output.md: claims_markdown(verdicts),
    snakemake.output.csv: comma_separated(all_claims(verdicts)),
}
for path, text in texts.items():
    Path(path).write_text(text, encoding="utf-8", newline="\n")
