"""Make results the reference: those of the figures and tables named, or all."""

import sys

from bouncing_ball.accept import main
from bouncing_ball.products import PRODUCTS

sys.exit(main(PRODUCTS, snakemake))
