"""Make the results the new reference, and print the files that changed."""

import sys
from pathlib import Path

from project import PROJECT

from carbonelli2011.article import unlike_the_paper
from paper_replication.compare import accept
from paper_replication.datasets import read

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
results = Path(snakemake.log[0]).parents[1]
try:
    if why := unlike_the_paper({path.stem: read(path) for path in results.glob("figures/*.nc")}):
        raise ValueError(f"nothing is accepted, because the article is of another run: {why[0]}")
    written = accept(PROJECT, results, snakemake.input)
except (OSError, ValueError) as error:
    sys.exit(str(error))
print(*written, f"{len(written)} files of the reference changed.", sep="\n")
