"""Make results the reference: those of the figures and tables named, or all that differ."""

import sys

from bouncing_ball import compare

options = snakemake.params
try:
    files = compare.accept("results", options.reference, options.artifacts, options.names)
except ValueError as error:
    sys.exit(str(error))
print("\n".join([*files, f"{len(files)} files of the reference were written."]))
