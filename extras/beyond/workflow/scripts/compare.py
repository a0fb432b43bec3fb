"""Compare results with the reference, print what differs, and write a page with both pictures.

Snakemake runs this script for the target `diff`; results from elsewhere are compared with the
reference, or with each other:

    python workflow/scripts/compare.py RUN [NAME ...]
    python workflow/scripts/compare.py RUN OTHER [NAME ...]
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PACKAGES = [TOP / folder for folder in ("src", "workflow", "../../src")]
sys.path[:0] = map(str, PACKAGES)

from paper_replication.provenance import from_source  # noqa: E402

with from_source(*PACKAGES):
    from project import PROJECT

    from paper_replication.compare import main, report_of_run

    if "snakemake" not in globals():
        sys.exit(main(PROJECT, sys.argv[1:]))

    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    sys.exit(report_of_run(PROJECT, Path("results"), snakemake))
