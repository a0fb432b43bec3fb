"""Make results the reference: those of the figures named, or all that differ."""

import sys
from pathlib import Path

from bouncing_ball import compare
from studies.products import CODE, PRODUCTS

options = snakemake.params
try:
    compare.refuse_other_settings(options.config, options.accepted)
    files = compare.accept(
        options.results, options.reference, PRODUCTS, options.artifacts, options.names, CODE
    )
except ValueError as error:
    Path(snakemake.log[0]).write_text(str(error), encoding="utf-8")
    sys.exit(str(error))
none = ["Nothing was written, because the reference has these results already."]
written = [*files, f"{len(files)} files of the reference were written."]
print("\n".join(written if files else none))
