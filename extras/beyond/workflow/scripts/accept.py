"""Make results the reference: those of the figures named, or all."""

import sys

from bouncing_ball.accept import main
from studies.products import CODE, PRODUCTS

sys.exit(main(PRODUCTS, snakemake, CODE))
