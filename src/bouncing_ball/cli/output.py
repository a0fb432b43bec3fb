"""What the command line prints."""

import os
import sys
from typing import NoReturn


def fail(message: str, status: int) -> NoReturn:
    """One line on standard error and the exit status."""
    print(f"bouncing-ball: {message}", file=sys.stderr)
    sys.exit(status)


def print_lines(lines: list[str]) -> None:
    """Print, and end quietly if nobody reads on (``| head``)."""
    try:
        print("\n".join(lines), flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
