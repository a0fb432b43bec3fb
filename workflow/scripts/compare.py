"""Compare results with the reference, print what differs, and write a page with both pictures.

Snakemake runs this script for the target `diff`. Results from elsewhere, such as those of
continuous integration, are compared with the reference, or with each other:

    python workflow/scripts/compare.py RUN [NAME ...]
    python workflow/scripts/compare.py RUN OTHER [NAME ...]

The exit status is 0 if what was asked for is present and agrees, 1 if something differs, and 2 if
it could not be compared.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "src"))

from paper_replication.provenance import from_source  # noqa: E402

with from_source(TOP / "src", TOP / "workflow"):
    from project import PROJECT

    from paper_replication.compare import main, report_of_run

    if "snakemake" not in globals():
        sys.exit(main(PROJECT, sys.argv[1:]))

    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    sys.exit(report_of_run(PROJECT, Path(snakemake.log[0]).parents[1], snakemake))
