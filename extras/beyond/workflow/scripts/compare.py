"""Compare results with the reference, print what differs, and write a page about it.

Snakemake runs this for the target `diff`; results from elsewhere are compared by

    python workflow/scripts/compare.py RESULTS_FOLDER [REFERENCE_FOLDER]
"""

import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PACKAGE / folder) for folder in ("src", "workflow", "../../src")]

from bouncing_ball.compare import main  # noqa: E402
from studies.products import PRODUCTS  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(PRODUCTS, PACKAGE, globals().get("snakemake")))
