"""``snakemake --lint`` with one finding taken for answered.

``python -m bouncing_ball.pipeline.lint`` fails on every finding but the one that
asks for a conda environment or a container for each rule: the lock file is the
software environment of all of them.
"""

import re
import subprocess
import sys
from pathlib import Path

ANSWERED = "Specify a conda environment or container for each rule."

_WHERE = re.compile(r"Lints for (.*):")
_FINDING = re.compile(r" {4}\* (.*):")


def findings(report: str) -> list[tuple[str, str]]:
    """Place and title of each finding in the linter's report.

    Examples
    --------
    >>> findings("Lints for rule paper (line 4, paper.smk):\\n    * No log directive defined:\\n")
    [('rule paper (line 4, paper.smk)', 'No log directive defined')]
    """
    found = []
    where = ""
    for line in report.splitlines():
        if place := _WHERE.fullmatch(line):
            where = place[1]
        elif finding := _FINDING.fullmatch(line):
            found.append((where, finding[1]))
    return found


def main() -> None:
    """Lint the workflow in the working directory; exit 1 if anything is left."""
    snakemake = Path(sys.executable).with_name("snakemake")
    done = subprocess.run(
        [snakemake, "--lint"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    found = findings(done.stdout)
    left = [(where, title) for where, title in found if title != ANSWERED]
    if done.returncode != 0 and not found:
        # The workflow could not even be read.
        sys.exit(done.stdout)
    if left:
        sys.exit("\n".join(f"{where}: {title}" for where, title in left))
    print(f"snakemake --lint: nothing left ({len(found)} rules use the locked environment)")


if __name__ == "__main__":
    main()
