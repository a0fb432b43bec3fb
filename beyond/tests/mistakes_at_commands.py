"""Tables of what a user types wrong, with the lines that answer it."""

import shlex
from collections.abc import Callable, Mapping


def rows(table: str) -> list[tuple[str, str]]:
    """Each command of a table, and the line below it, which is what the answer says."""
    lines = table.strip().splitlines()
    return [(typed, says.strip()) for typed, says in zip(lines[::2], lines[1::2], strict=True)]


def answered(refused: Callable, typed: str, says: str, short: Mapping[str, str]) -> tuple[int, str]:
    """The status and the line of a command, which begins with ``says`` up to ``…`` and ends with
    what is behind it. ``short`` are abbreviations in the command.
    """
    for name, options in short.items():
        typed = typed.replace(name, options)
    status, line = refused(*shlex.split(typed))
    beginning, _, end = says.partition(" … ")
    assert line.startswith(f"bouncing-ball: {beginning}") and line.endswith(end)
    return status, line
