"""Ctrl-C while modules are imported."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def importing() -> Iterator[None]:
    """A context for imports, in which Ctrl-C ends the process at once and without a message.

    An exception in the middle of an import would not always arrive as it was raised, because
    libraries turn those that their own imports raise into others. Where the signal is ignored, or
    has a handler of the caller, it stays as it is.

    Examples
    --------
    >>> before = signal.signal(signal.SIGINT, signal.default_int_handler)
    >>> with importing():
    ...     signal.getsignal(signal.SIGINT).name
    'SIG_DFL'
    >>> restored = signal.signal(signal.SIGINT, before)
    >>> restored is signal.default_int_handler
    True
    """
    try:
        before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    except ValueError:
        # Ctrl-C interrupts the main thread alone.
        yield
        return
    usual = before is signal.default_int_handler
    if not usual:
        signal.signal(signal.SIGINT, before)
    try:
        yield
    finally:
        if usual:
            signal.signal(signal.SIGINT, before)
