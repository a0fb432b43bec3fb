"""The progress of a run, and an estimate of the time that remains.

A run notes when it began and the number of its jobs, and each job that ends adds a line. Snakemake
counts its steps too, in three lines for each, but does not estimate the time.
"""

import time
from pathlib import Path

_NOTES = Path(".snakemake/progress")


def begin(jobs: int) -> None:
    """Note that a run of so many jobs begins."""
    _NOTES.parent.mkdir(exist_ok=True)
    _NOTES.write_text(f"{jobs} {time.time()!r}\n", encoding="ascii")


def advance() -> str:
    """Note that a job has ended; the result is the share done, or an empty text outside of a
    run.
    """
    if not _NOTES.is_file():
        return ""
    # A line is appended completely, whatever other jobs do.
    with _NOTES.open("a", encoding="ascii") as notes:
        notes.write("done\n")
    head, *ended = _NOTES.read_text(encoding="ascii").splitlines()
    jobs, began = head.split()
    return share(len(ended), int(jobs), time.time() - float(began))


def share(done: int, jobs: int, seconds: float) -> str:
    """The share done, and the time left if the remaining jobs take as long as those before.

    Examples
    --------
    >>> share(15, 60, 20.0), share(15, 60, 200.0), share(60, 60, 200.0)
    ('15 of 60, 25 %, about 60 s left', '15 of 60, 25 %, about 10 min left', '60 of 60, 100 %')
    """
    text = f"{done} of {jobs}, {100 * done // jobs} %"
    left = seconds * (jobs - done) / done
    if done >= jobs:
        return text
    return (
        f"{text}, about {left:.0f} s left"
        if left < 120
        else f"{text}, about {left / 60:.0f} min left"
    )
