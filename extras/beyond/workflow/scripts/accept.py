"""Make the results the new reference, and print the files that changed."""

import sys
from pathlib import Path

from project import PROJECT

from paper_replication.compare import accept

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
try:
    written = accept(PROJECT, Path("results"), snakemake.input)
except ValueError as error:
    sys.exit(str(error))
print(*written, f"{len(written)} files of the reference changed.", sep="\n")
