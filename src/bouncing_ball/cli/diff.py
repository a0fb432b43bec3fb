"""``bouncing-ball diff``: two folders of artifacts, and reports about them."""

import sys
from pathlib import Path
from typing import NoReturn

import bouncing_ball
from bouncing_ball.cli.output import fail, print_lines
from bouncing_ball.compare.reports import compare_and_report
from bouncing_ball.record.reading import printable, read_file
from bouncing_ball.record.revision import checkout

_TOLERANCES = Path("config", "tolerances.yaml")


def tolerance_file(given: Path | None, record: Path) -> Path:
    """The file named, else that of this checkout, else that of the record.

    A folder that was sent says what its own budgets are only where there is no
    checkout of this workflow, neither here nor where the package is.

    Raises
    ------
    ValueError
        If there is none.
    """
    if given is not None:
        return given
    own = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    if own is not None:
        return own / _TOLERANCES
    read_file(record, _TOLERANCES.as_posix())
    return record / _TOLERANCES


def diff(
    record: Path,
    results: Path,
    artifacts: tuple[str, ...] = (),
    /,
    *,
    tolerances: Path | None = None,
    json: Path | None = None,
    markdown: Path | None = None,
    html: Path | None = None,
) -> NoReturn:
    """Compare, write the reports asked for, print the short table.

    Exits with 0 if the artifacts say the same, 1 if they differ, and 2 if
    something could not be compared.

    Parameters
    ----------
    record
        Folder with the accepted artifacts.
    results
        Folder with the new artifacts.
    artifacts
        As fig08 or table1; all of them if none is named.
    tolerances
        config/tolerances.yaml of this checkout by default, else of RECORD.
    json
        Everything that was found, as JSON.
    markdown
        A summary for continuous integration.
    html
        One page with all pictures.
    """
    try:
        budgets = tolerance_file(tolerances, record)
        table, status = compare_and_report(
            record, results, budgets, artifacts, json=json, markdown=markdown, html=html
        )
        if budgets.is_relative_to(Path.cwd()):
            budgets = budgets.relative_to(Path.cwd())
        lines = [f"Budgets: {printable(budgets)}", *table.splitlines()]
    # By intent: 1 means that something differs, and a traceback would exit with it.
    except Exception as error:
        fail(printable(" ".join(str(error).split()) or type(error).__name__), status=2)
    print_lines(lines)
    sys.exit(status)
