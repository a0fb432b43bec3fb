"""``bouncing-ball diff``: the results of a run against the accepted record, or against others."""

import sys
from itertools import takewhile
from pathlib import Path
from typing import NoReturn

from bouncing_ball_beyond.inherited.cli.output import fail, say
from bouncing_ball_beyond.inherited.datasets.files import require_writable, write_text
from bouncing_ball_beyond.inherited.pipeline.diff.compare import compare_folders
from bouncing_ball_beyond.inherited.pipeline.diff.report import differences_html, to_terminal


def diff(
    names: tuple[str, ...] = (),
    /,
    *,
    against: Path | None = None,
    html: Path | None = None,
) -> NoReturn:
    """Compare, write the page if ``html`` is given, and print the differences with their causes.

    Exits with 0 if the artifacts agree, 1 if they differ, and 2 if something could not be compared.

    Parameters
    ----------
    names
        The folder with the record, by default the current one; the folder with the results, by
        default ``results`` in it; and the artifacts to compare, such as fig08 or table1, by default
        all.
    against
        Folder of another run, with which the results are compared in place of the record.
    html
        File for a page that shows both versions of all pictures.
    """
    if "" in names:
        fail("argument NAMES: the name is empty", status=2)
    folders = [Path(name) for name in takewhile(lambda name: Path(name).is_dir(), names[:2])]
    record = folders[0] if folders else Path()
    results = folders[1] if folders[1:] else record / "results"
    if against:
        record = against / "results" if (against / "results").is_dir() else against
    try:
        require_writable(html)
        comparison = compare_folders(record, results, names[len(folders) :])
        if html:
            write_text(html, differences_html(comparison))
    # A traceback would exit with status 1, which means that something differs.
    except Exception as error:
        fail(" ".join(str(error).split()) or type(error).__name__, status=2)
    say(to_terminal(comparison).rstrip("\n"))
    sys.exit(comparison.outcome.status)
