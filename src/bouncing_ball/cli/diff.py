"""``bouncing-ball diff``: two folders of artifacts, and reports about them."""

import argparse
import sys
from pathlib import Path
from typing import NoReturn

from bouncing_ball.cli.output import fail, print_lines

_TOLERANCES = Path("config", "tolerances.yaml")


def tolerance_file(given: str | None, record: Path) -> Path:
    """The file named, else that of this checkout, else that of the record.

    A folder that was sent says what its own budgets are only where there is no
    checkout of this workflow, neither here nor where the package is.

    Raises
    ------
    ValueError
        If there is none.
    """
    import bouncing_ball
    from bouncing_ball.record.reading import read_file
    from bouncing_ball.record.revision import checkout

    if given is not None:
        return Path(given)
    own = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    if own is not None:
        return own / _TOLERANCES
    read_file(record, _TOLERANCES.as_posix())
    return record / _TOLERANCES


def _compare(args: argparse.Namespace) -> tuple[list[str], int]:
    """Lines to print and the exit status, with the reports written."""
    # Imported here, so that --help and a mistyped argument need none of it.
    from bouncing_ball.compare.reports import compare_and_report
    from bouncing_ball.record.reading import printable

    record, results = Path(args.record), Path(args.results)
    budgets = tolerance_file(args.tolerances, record)
    reports = {name: getattr(args, name) for name in ("json", "markdown", "html")}
    table, status = compare_and_report(record, results, budgets, args.artifacts, **reports)
    if budgets.is_relative_to(Path.cwd()):
        budgets = budgets.relative_to(Path.cwd())
    return [f"Budgets: {printable(budgets)}", *table.splitlines()], status


def run(args: argparse.Namespace) -> NoReturn:
    """Compare, write the reports asked for, print the short table.

    Exits with 0 if the artifacts say the same, 1 if they differ, and 2 if
    something could not be compared.
    """
    try:
        lines, status = _compare(args)
    # By intent: 1 means that something differs, and a traceback would exit with it.
    except Exception as error:
        from bouncing_ball.record.reading import printable

        fail(printable(" ".join(str(error).split()) or type(error).__name__), status=2)
    print_lines(lines)
    sys.exit(status)
