"""Lines on standard error while a call takes long.

A call of the library knows what would make its answer cheaper, but not how long it will take. After
some seconds, and at intervals from then on, a line gives the time passed and this advice.
"""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from threading import Event, Thread

# Seconds until the first line, and between lines.
_FIRST = 8.0
_NEXT = 10.0


class _Watch:
    """A call that is running; ``cheaper`` is what would make it cheaper, or empty."""

    def __init__(self, cheaper: str) -> None:
        self.cheaper = cheaper
        self.ended = Event()

    def tell(self) -> None:
        """Print lines until the call has ended."""
        start = time.monotonic()
        wait = _FIRST
        while not self.ended.wait(wait):
            passed = f"{time.monotonic() - start:.0f} s"
            advice = f"{self.cheaper} make the answer cheaper; " if self.cheaper else ""
            line = f"bouncing-ball: no answer after {passed} yet; {advice}Ctrl-C ends it"
            # Standard error may be missing or closed.
            if sys.stderr is not None:
                with suppress(OSError, ValueError):
                    print(line, file=sys.stderr, flush=True)
            wait = _NEXT


_WATCH: ContextVar[_Watch | None] = ContextVar("watch", default=None)


@contextmanager
def patience(cheaper: str) -> Iterator[None]:
    """A context for a call that may take long: lines on standard error if it does.

    Parameters
    ----------
    cheaper : str
        What would make the call cheaper, in the plural, such as "fewer impacts". Within another
        such context nothing more is printed than there, with this advice.

    Examples
    --------
    >>> with patience("fewer impacts"):
    ...     print("an answer at once has no lines")
    an answer at once has no lines
    """
    watch = _WATCH.get()
    if watch is not None:
        before = watch.cheaper
        watch.cheaper = cheaper
        try:
            yield
        finally:
            watch.cheaper = before
        return
    watch = _Watch(cheaper)
    token = _WATCH.set(watch)
    Thread(target=watch.tell, name="patience", daemon=True).start()
    try:
        yield
    finally:
        watch.ended.set()
        _WATCH.reset(token)
