"""The progress of a run, and its last sentence.

A run notes the number of its jobs, and each job that ends adds a line. Snakemake also counts its
steps, but with three lines for each.

A run may end with exit status 1 although no job failed, for example because of a difference from
the record, or because results were not accepted. For a failed job Snakemake prints ten lines, with
a command that the user did not type; such a run ends with one sentence instead.
"""

from pathlib import Path

from bouncing_ball.datasets.files import write_text

_NOTES, _CONCLUSION = Path(".snakemake/progress"), Path("results/logs/conclusion")


def begin(jobs: int) -> None:
    """Note that a run with this number of jobs begins."""
    _NOTES.parent.mkdir(exist_ok=True)
    _NOTES.write_text(f"{jobs}\n", encoding="ascii")


def advance() -> str:
    """Note that a job has ended, and return the share done, an empty text outside of a run."""
    if not _NOTES.is_file():
        return ""
    # A short line is appended completely, even if other jobs append lines at the same time.
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
