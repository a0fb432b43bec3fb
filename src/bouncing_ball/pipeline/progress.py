"""The progress of a run, an estimate of the time that remains, and its last sentence.

A run notes its start and the number of its jobs, and each job that ends adds a line. Snakemake
also counts its steps, with three lines for each, but does not estimate the time.

A run may end with exit status 1 although no job failed, for example because of a difference from
the record, or because results were not accepted. For a failed job Snakemake prints ten lines, with
a command that the user did not type; such a run ends with one sentence instead.
"""

import time
from pathlib import Path

from bouncing_ball.datasets.files import write_text

_NOTES, _CONCLUSION = Path(".snakemake/progress"), Path("results/logs/conclusion")


def begin(jobs: int) -> None:
    """Note that a run with this number of jobs begins."""
    _NOTES.parent.mkdir(exist_ok=True)
    _NOTES.write_text(f"{jobs} {time.time()!r}\n", encoding="ascii")


def advance() -> str:
    """Note that a job has ended, and return the share done, an empty text outside of a run."""
    if not _NOTES.is_file():
        return ""
    # A short line is appended completely, even if other jobs append lines at the same time.
    with _NOTES.open("a", encoding="ascii") as notes:
        notes.write("done\n")
    head, *ended = _NOTES.read_text(encoding="ascii").splitlines()
    jobs, began = head.split()
    return share(len(ended), int(jobs), time.time() - float(began))


def share(done: int, jobs: int, seconds: float) -> str:
    """The share done, and the time left if the remaining jobs take as long as those done.

    Examples
    --------
    >>> share(15, 60, 20.0), share(15, 60, 200.0), share(60, 60, 200.0)
    ('15 of 60, 25 %, about 60 s left', '15 of 60, 25 %, about 10 min left', '60 of 60, 100 %')
    """
    text, left = f"{done} of {jobs}, {100 * done // jobs} %", seconds * (jobs - done) / done
    amount = f"{left:.0f} s" if left < 120 else f"{left / 60:.0f} min"
    return f"{text}, about {amount} left" if done < jobs else text


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one."""
    write_text(_CONCLUSION, sentence)


def concluded() -> str:
    """The sentence with which this run ends, or an empty text; it is removed by this call."""
    sentence = _CONCLUSION.read_text(encoding="utf-8") if _CONCLUSION.is_file() else ""
    _CONCLUSION.unlink(missing_ok=True)
    return sentence
