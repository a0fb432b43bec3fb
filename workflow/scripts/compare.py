"""Compare results with the reference, print what differs, and write a page about it.

Snakemake runs this for the target `diff`. Results from elsewhere, for example those that continuous
integration uploaded, are compared by

    python workflow/scripts/compare.py RESULTS_FOLDER [REFERENCE_FOLDER]

with the parameters of config/config.yaml; the reference is by default that of this checkout. The
page is diff/index.html in the folder of the results. The exit status is 0 if all agrees, and 1 if
something differs or could not be compared.
"""

import sys
from pathlib import Path

import yaml

CHECKOUT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CHECKOUT / "src"))

from bouncing_ball import compare  # noqa: E402
from bouncing_ball.products import PRODUCTS  # noqa: E402


def configured() -> dict[str, dict]:
    """What config.yaml says of each dataset: its parameters, and the settings of the whole run."""
    text = (CHECKOUT / "config" / "config.yaml").read_text(encoding="utf-8")
    configuration = yaml.safe_load(text)
    stages = {key: value for key, value in configuration.items() if isinstance(value, dict)}
    settings = {key: value for key, value in configuration.items() if key not in stages}
    described = ("title", "caption", "table")
    return {
        name: {
            "parameters": {key: value for key, value in entry.items() if key not in described},
            "settings": settings,
        }
        for stage in stages.values()
        for name, entry in stage.items()
        if isinstance(entry, dict)
    }


def main(results: str, reference: str, artifacts: dict, names: list[str]) -> compare.Report:
    """Compare, write the page, and print the report."""
    report = compare.compare(results, reference, PRODUCTS, artifacts, names)
    page = Path(results) / "diff" / "index.html"
    page.parent.mkdir(parents=True, exist_ok=True)
    text = compare.page(report, CHECKOUT / "workflow" / "templates" / "diff.html.j2")
    page.write_text(text, encoding="utf-8", newline="\n")
    print("\n".join([*report.lines, f"See {page}."]))
    return report


if __name__ == "__main__":
    # A terminal may not know all letters.
    sys.stdout.reconfigure(errors="replace")
    try:
        if "snakemake" in globals():
            given = snakemake.params
            report = main(given.results, given.reference, given.artifacts, given.names)
            # Snakemake shows the log of a failed job last.
            *told, verdict = report.lines
            Path(snakemake.log[0]).write_text("\n".join([verdict, *told]), encoding="utf-8")
        elif len(sys.argv) in (2, 3) and not Path(sys.argv[1]).is_dir():
            sys.exit(f"there is no folder {sys.argv[1]}")
        elif len(sys.argv) in (2, 3):
            report = main(sys.argv[1], [*sys.argv, str(CHECKOUT)][2], configured(), [])
        else:
            sys.exit("usage: python workflow/scripts/compare.py RESULTS_FOLDER [REFERENCE_FOLDER]")
    except ValueError as error:
        if "snakemake" in globals():
            Path(snakemake.log[0]).write_text(str(error), encoding="utf-8")
        sys.exit(str(error))
    sys.exit(1 if report.findings else 0)
