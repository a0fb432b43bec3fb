"""Make the results the new reference, and print the files that changed."""

import sys
from pathlib import Path

from paper_replication.provenance import from_source

TOP = Path(__file__).resolve().parents[2]

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
results = Path(snakemake.log[0]).parents[1]
with from_source(TOP / "src", TOP / "workflow"):
    from project import PROJECT

    from paper_replication.acceptance import accept

    try:
        written = accept(PROJECT, results, snakemake.input)
    except (OSError, ValueError) as error:
        sys.exit(str(error))
print(*written, f"{len(written)} files of the reference changed.", sep="\n")
