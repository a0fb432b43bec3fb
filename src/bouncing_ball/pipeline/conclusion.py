"""The sentence with which a run ends with exit status 1, although no job fails.

For a job that fails Snakemake prints ten lines, with a command that the user did not type. A
difference from the record, or results that are not accepted, are results and not failures.
"""

from pathlib import Path

from bouncing_ball.datasets.files import write_text

_CONCLUSION = Path("results/logs/conclusion")


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one."""
    write_text(_CONCLUSION, sentence)


def concluded() -> str:
    """The sentence with which this run ends, or an empty text; it is removed by this call."""
    sentence = _CONCLUSION.read_text(encoding="utf-8") if _CONCLUSION.is_file() else ""
    _CONCLUSION.unlink(missing_ok=True)
    return sentence
