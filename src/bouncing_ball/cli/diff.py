"""``bouncing-ball diff``: two folders of artifacts, and reports about them."""

import argparse
import sys
from pathlib import Path
from typing import NoReturn

from bouncing_ball.cli.output import fail, print_lines

_TOLERANCES = Path("config", "tolerances.yaml")


def tolerance_file(given: str | None, record: Path) -> Path:
    """The file named, else that of the record, else that of the working directory.

    Raises
    ------
    ValueError
        If none is named and neither folder has one.
    """
    if given is not None:
        return Path(given)
    for folder in (record, Path()):
        if (folder / _TOLERANCES).is_file():
            return folder / _TOLERANCES
    raise ValueError(f"no {_TOLERANCES} in {record} or here: name one with --tolerances")


def run(args: argparse.Namespace) -> NoReturn:
    """Compare, write the reports asked for, print the short table.

    Exits with 0 if the artifacts say the same, 1 if they differ, and 2 if
    something could not be compared.
    """
    # Imported here, so that --help and a mistyped argument need none of it.
    from bouncing_ball.record.diff.folders import compare_folders
    from bouncing_ball.record.diff.outcome import status
    from bouncing_ball.record.diff.report_terminal import to_terminal
    from bouncing_ball.record.diff.reports import write_reports
    from bouncing_ball.record.diff.tolerance_file import read_tolerances

    record, results = Path(args.record), Path(args.results)
    try:
        rules = read_tolerances(tolerance_file(args.tolerances, record))
        comparison = compare_folders(record, results, rules)
        write_reports(comparison, json=args.json, markdown=args.markdown, html=args.html)
    except (OSError, ValueError) as error:
        fail(str(error), status=2)
    print_lines(to_terminal(comparison).splitlines())
    sys.exit(status(comparison.outcome))
