"""The output of the command line, whatever the stream accepts.

Characters that the stream's encoding lacks are escaped. A reader who closes the pipe
(``| head``) ends the output quietly, and a device that is full ends it with one line.
"""

import os
import sys
from contextlib import suppress
from typing import NoReturn

from bouncing_ball.errors import printable


def fail(message: str, status: int) -> NoReturn:
    """Print one line on standard error and exit with the status."""
    with suppress(OSError):
        print(f"bouncing-ball: {printable(message, None)}", file=sys.stderr, flush=True)
    sys.exit(status)


def say(text: str) -> None:
    """Print a text; exit quietly if the reader has closed the pipe, and with 2 on another error."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)
    except OSError as error:
        # Flushing the rest of the buffer would fail again at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            fail(f"the output cannot be written: {error.strerror}", status=2)
