"""Lines on standard error while a command takes long.

The command knows what would make its answer cheaper, but not how long the answer will take. After
some seconds, and at intervals from then on, a line gives the time passed and this advice.
"""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread

# Seconds until the first line, and between the lines.
_FIRST = 8.0
_NEXT = 10.0


@contextmanager
def told_if_slow(cheaper: str) -> Iterator[None]:
    """A context for a command that may take long: lines on standard error if it does.

    Parameters
    ----------
    cheaper : str
        What would make the answer cheaper, in the plural, such as "fewer impacts"; or empty.

    Examples
    --------
    >>> with told_if_slow("fewer impacts"):
    ...     print("an answer at once has no lines")
    an answer at once has no lines
    """
    ended = Event()
    advice = f"{cheaper} make the answer cheaper; " if cheaper else ""
    teller = Thread(target=_tell, args=(advice, ended), name="patience", daemon=True)
    teller.start()
    try:
        yield
    finally:
        ended.set()
        # No line comes after the answer.
        teller.join()


def _tell(advice: str, ended: Event) -> None:
    """Print lines until the command has ended."""
    start = time.monotonic()
    wait = _FIRST
    while not ended.wait(wait):
        passed = f"{time.monotonic() - start:.0f} s"
        line = f"bouncing-ball: no answer after {passed} yet; {advice}Ctrl-C ends it"
        # Standard error may be missing or closed.
        if sys.stderr is not None:
            with suppress(OSError, ValueError):
                print(line, file=sys.stderr, flush=True)
        wait = _NEXT
