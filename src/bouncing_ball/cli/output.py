"""What the command line prints, whatever the stream takes.

Characters that the stream's encoding lacks are escaped. A reader who goes away
(``| head``) ends the output quietly, a device that is full ends it in one line.
"""

import os
import sys
from contextlib import suppress
from typing import NoReturn

from bouncing_ball.errors import printable


def fail(message: str, status: int) -> NoReturn:
    """One line on standard error and the exit status."""
    with suppress(OSError):
        print(f"bouncing-ball: {printable(message, None)}", file=sys.stderr, flush=True)
    sys.exit(status)


def say(text: str) -> None:
    """Print, and end quietly if nobody reads on; exit with 2 if it cannot be written."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)
    except OSError as error:
        # What is left in the buffer would fail again at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            fail(f"the output cannot be written: {error.strerror}", status=2)
