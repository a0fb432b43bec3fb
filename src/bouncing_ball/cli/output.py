"""What the command line prints, whatever the stream takes.

Characters that the stream's encoding lacks are escaped. A reader who goes away
(``| head``) ends the output quietly, a device that is full ends it in one line.
"""

import json
import os
import sys
from contextlib import suppress
from dataclasses import asdict
from typing import Any, NoReturn

from bouncing_ball.errors import printable


def prepare() -> None:
    """Escape what the encoding of standard output has no character for."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")


def fail(message: str, status: int) -> NoReturn:
    """One line on standard error and the exit status."""
    with suppress(OSError):
        print(f"bouncing-ball: {printable(message, None)}", file=sys.stderr, flush=True)
    sys.exit(status)


def flush() -> None:
    """Hand over what is printed; exit with 2 if it cannot be written."""
    if sys.stdout is None:
        return
    try:
        sys.stdout.flush()
    except OSError as error:
        _abandon(error)


def print_lines(lines: list[str]) -> None:
    """Print, and end quietly if nobody reads on (``| head``)."""
    try:
        print("\n".join(lines))
    except OSError as error:
        _abandon(error)
    flush()


def _abandon(error: OSError) -> None:
    """Print nothing more, and say why unless the reader has gone."""
    # What is left in the buffer would fail again at the interpreter's exit.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if not isinstance(error, BrokenPipeError):
        fail(f"the output cannot be written: {error.strerror}", status=2)


def to_json(value: Any) -> str:
    """One line of JSON, with its letters as they are if the stream has them.

    Examples
    --------
    >>> to_json({"orbits": [1.5, None]})
    '{"orbits": [1.5, null]}'
    """
    value = value if isinstance(value, dict) else asdict(value)
    text = json.dumps(value, allow_nan=False, ensure_ascii=False)
    try:
        text.encode(getattr(sys.stdout, "encoding", None) or "ascii")
    except UnicodeEncodeError:
        return json.dumps(value, allow_nan=False)
    return text
