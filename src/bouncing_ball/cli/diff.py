"""``bouncing-ball diff``: two folders of artifacts against each other."""

import sys
from pathlib import Path
from typing import NoReturn

from bouncing_ball.cli.output import fail, say
from bouncing_ball.datasets.files import require_writable, write_text
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.page import differences_html, to_terminal


def diff(
    record: Path, results: Path, artifacts: tuple[str, ...] = (), /, *, html: Path | None = None
) -> NoReturn:
    """Compare, write the page if ``html`` is given, and print the differences with their causes.

    Exits with 0 if the artifacts agree, 1 if they differ, and 2 if something could not be compared.

    Parameters
    ----------
    record
        Folder with the accepted artifacts.
    results
        Folder with the new artifacts.
    artifacts
        Artifacts to compare, such as fig08 or table1. By default all of them.
    html
        File for a page that shows both versions of all pictures.
    """
    try:
        require_writable(html)
        comparison = compare_folders(record, results, artifacts)
        if html:
            write_text(html, differences_html(comparison))
    # A traceback would exit with status 1, which means that something differs.
    except Exception as error:
        fail(" ".join(str(error).split()) or type(error).__name__, status=2)
    say(to_terminal(comparison).rstrip("\n"))
    sys.exit(comparison.outcome.status)
