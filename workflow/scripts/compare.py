"""Compare results with the reference, print what differs, and write a page about it.

Snakemake runs this for the target `diff`. Results from elsewhere, for example those that continuous
integration uploaded, are compared in the same way by

    python workflow/scripts/compare.py RESULTS_FOLDER [REFERENCE_FOLDER]

with the parameters of config/config.yaml; the reference is by default that of this checkout. The
page is diff/index.html in the folder of the results. The exit status is 0 if all agrees, and 1 if
something differs or could not be compared.
"""

import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CHECKOUT / "src"))

from bouncing_ball.compare import main  # noqa: E402
from bouncing_ball.products import PRODUCTS  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(PRODUCTS, CHECKOUT, globals().get("snakemake")))
