"""``bouncing-ball diff``: two folders of artifacts against each other."""

import argparse
import sys
from pathlib import Path
from typing import NoReturn

from bouncing_ball.cli.output import fail, print_lines


def run(args: argparse.Namespace) -> NoReturn:
    """Compare, write the page if it is asked for, print the short table.

    Exits with 0 if the artifacts say the same, 1 if they differ, and 2 if
    something could not be compared.
    """
    try:
        # Imported here, so that --help and a mistyped argument need none of it.
        from bouncing_ball.compare.report import compared

        table, status = compared(
            Path(args.record), Path(args.results), args.artifacts, page=args.html
        )
    # 1 means that something differs, and a traceback would exit with it.
    except Exception as error:
        fail(" ".join(str(error).split()) or type(error).__name__, status=2)
    print_lines(table.splitlines())
    sys.exit(status)
