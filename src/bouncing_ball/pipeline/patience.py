"""Lines on standard error while a command or a job of the workflow takes long.

It knows what would make its answer cheaper, but not how long the answer will take. After some
seconds, and at intervals from then on, a line gives the time passed and this advice.
"""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread

# Seconds until the first line of a command, and between its lines.
_FIRST = 8.0
_NEXT = 10.0
# The same for a job. Of a run of the whole workflow none takes as long on a quiet machine.
_OF_A_JOB = 60.0


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
    with _telling("bouncing-ball: no answer", cheaper, _FIRST, _NEXT):
        yield


@contextmanager
def patience_of_job(dataset: str, cheaper: str) -> Iterator[None]:
    """The same for a job of the workflow that makes a dataset."""
    with _telling(f"{dataset}: no dataset", cheaper, _OF_A_JOB, _OF_A_JOB):
        yield


@contextmanager
def _telling(beginning: str, cheaper: str, first: float, following: float) -> Iterator[None]:
    ended = Event()
    advice = f"{cheaper} make the answer cheaper; " if cheaper else ""
    given = (beginning, advice, first, following, ended)
    Thread(target=_tell, args=given, name="patience", daemon=True).start()
    try:
        yield
    finally:
        ended.set()


def _tell(beginning: str, advice: str, wait: float, following: float, ended: Event) -> None:
    """Print lines until the command has ended."""
    start = time.monotonic()
    while not ended.wait(wait):
        passed = f"{time.monotonic() - start:.0f} s"
        line = f"{beginning} after {passed} yet; {advice}Ctrl-C ends it"
        # Standard error may be missing or closed.
        if sys.stderr is not None:
            with suppress(OSError, ValueError):
                print(line, file=sys.stderr, flush=True)
        wait = following
