"""The output of the command line on streams of any encoding.

Characters that the encoding of the stream does not have are escaped. If the reader closes the pipe
(``| head``), the output ends without a message; if the device is full, it ends with one line.
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
    """Print a text.

    If the reader has closed the pipe, exit without a message; on another error exit with status 2.
    """
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)
    except OSError as error:
        # Flushing the rest of the buffer would fail again at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            fail(f"the output cannot be written: {error.strerror}", status=2)
