"""Compare results with the reference, print what differs, and write a page about it."""

import sys
from pathlib import Path

from bouncing_ball import compare
from studies.products import PRODUCTS

given = snakemake.params
log = Path(snakemake.log[0])
# A terminal may not know all letters.
sys.stdout.reconfigure(errors="replace")
try:
    report = compare.compare(given.results, given.reference, PRODUCTS, given.artifacts, given.names)
except ValueError as error:
    log.write_text(str(error), encoding="utf-8")
    sys.exit(str(error))
page = Path(given.results) / "diff" / "index.html"
page.parent.mkdir(parents=True, exist_ok=True)
page.write_text(compare.page(report, Path(given.template)), encoding="utf-8", newline="\n")
print("\n".join([*report.lines, f"See {page}."]))
# Snakemake shows the log of a failed job last.
*told, verdict = report.lines
log.write_text("\n".join([verdict, *told]), encoding="utf-8")
sys.exit(1 if report.findings else 0)
