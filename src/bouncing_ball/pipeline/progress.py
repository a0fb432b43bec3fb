"""How far the jobs of a long computation are: a bar on a terminal, lines elsewhere.

Jobs are processes of their own. Each writes how much it has done to a file, and
whoever has the terminal draws one bar for all of them from these files. In the log of a
job on a cluster there are lines about the job alone.
"""

import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

from bouncing_ball.datasets.files import write_text

_EVERY = {True: 0.5, False: 10.0}
_WIDTH = 30
# A job that has not written for so long, in seconds, is not running.
_SILENT = 30.0


def line(done: float, total: float, rate: float) -> str:
    """Share, rate and time left in words.

    Examples
    --------
    >>> line(2.5e7, 1e8, 1.5e6)
    ' 25 %, 1.5 million orbits/s, 50 s left'
    >>> line(0.0, 1e10, 2e6)
    '  0 %, 2.0 million orbits/s, 1 h 23 min left'
    """
    share = f"{100 * done / total:3.0f} %"
    if rate <= 0:
        return share
    left = (total - done) / rate
    hours, minutes = divmod(round(left / 60), 60)
    words = (
        f"{left:.0f} s" if left < 100 else f"{hours} h {minutes} min" if hours else f"{minutes} min"
    )
    return f"{share}, {rate / 1e6:.1f} million orbits/s, {words} left"


class Progress:
    """The progress of one of the jobs.

    Parameters
    ----------
    folder : Path
        Where the jobs write how much they have done.
    name : str
        That of this job.
    own, total : int
        The work of this job, and of all.
    stream : file
        Where the bar or the lines go.
    clock : callable
        Seconds.
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        own: int,
        total: int,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.time,
    ):
        self._file, self._own, self._total = folder / name, own, total
        self._stream, self._clock = stream, clock
        self._bar = stream.isatty()
        self._start = self._said = clock()
        self._done = 0
        self._write(0.0)

    def __call__(self, count: int) -> None:
        """So much more is done."""
        self._done += count
        now = self._clock()
        if now - self._said < _EVERY[self._bar] and self._done < self._own:
            return
        self._said = now
        rate = self._done / max(now - self._start, 1e-9)
        self._write(rate)
        if self._bar:
            done, rate = self._all(now)
            said = line(done, self._total, rate)
            # A line that wraps cannot be drawn over.
            width = max(0, min(_WIDTH, shutil.get_terminal_size().columns - len(said) - 3))
            full = "#" * round(width * done / self._total)
            end = "\r\033[K" if self._done >= self._own else ""
            self._stream.write(f"\r\033[K[{full:.<{width}}]{said}{end}")
        else:
            self._stream.write(f"{self._file.name}: {line(self._done, self._own, rate).strip()}\n")
        self._stream.flush()

    def _write(self, rate: float) -> None:
        running = self._done < self._own
        write_text(self._file, f"{self._done} {rate if running else 0.0} {self._clock()}\n")

    def _all(self, now: float) -> tuple[float, float]:
        """What all jobs have done, and their rate."""
        done = rate = 0.0
        for path in self._file.parent.iterdir():
            if path.name.startswith("."):
                continue
            count, speed, when = map(float, path.read_text(encoding="utf-8").split())
            done += count
            rate += speed if now - when < _SILENT else 0.0
        return min(done, self._total), rate
