"""The progress of a run, and its last sentence.

A run notes the number of its jobs, and each job that ends adds a line. Snakemake counts its steps
too, in three lines for each.

A run may end with exit status 1 although no job fails: a difference from the record, or results
that are not accepted, are results. For a job that fails Snakemake prints ten lines, with a command
that the user did not type; such a run ends with one sentence instead.
"""

from pathlib import Path

from bouncing_ball.datasets.files import write_text

_NOTES, _CONCLUSION = Path(".snakemake/progress"), Path("results/logs/conclusion")


def begin(jobs: int) -> None:
    """Note that a run of so many jobs begins."""
    _NOTES.parent.mkdir(exist_ok=True)
    _NOTES.write_text(f"{jobs}\n", encoding="ascii")


def advance() -> str:
    """Note that a job has ended; the result is the share done, or an empty text outside of a
    run.
    """
    if not _NOTES.is_file():
        return ""
    # A line is appended completely, whatever other jobs do.
    with _NOTES.open("a", encoding="ascii") as notes:
        notes.write("done\n")
    jobs, *ended = _NOTES.read_text(encoding="ascii").splitlines()
    return f"{len(ended)} of {jobs}, {100 * len(ended) // int(jobs)} %"


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one."""
    write_text(_CONCLUSION, sentence)


def concluded() -> str:
    """The sentence with which this run ends, or an empty text; it is removed by this call."""
    sentence = _CONCLUSION.read_text(encoding="utf-8") if _CONCLUSION.is_file() else ""
    _CONCLUSION.unlink(missing_ok=True)
    return sentence
