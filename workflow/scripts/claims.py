"""The verdicts on the claims of the paper, from all datasets, and their texts."""

import sys
from pathlib import Path

from bouncing_ball import claims
from bouncing_ball.datasets import read, save
from bouncing_ball.tables import comma_separated

sys.stderr = open(snakemake.log[0], "w")  # what goes wrong is in the log
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
verdicts = claims.judge(datasets, claims.printed_table(snakemake.input.printed))
title = "Verdicts on the paper's claims"
save(verdicts, snakemake.output.nc, title, {}, snakemake.input.code)
texts = {
    snakemake.output.md: claims.claims_markdown(verdicts),
    snakemake.output.csv: comma_separated(claims.all_rows(verdicts)),
}
for path, text in texts.items():
    Path(path).write_text(text, encoding="utf-8", newline="\n")
