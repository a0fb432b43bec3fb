"""The sentence with which a run ends with exit status 1, although no job fails.

Of a job that fails Snakemake prints ten lines, with a command that nobody has typed. A
difference from the record, or results that are not accepted, are an answer.
"""

from pathlib import Path

from bouncing_ball.datasets.files import write_text

_CONCLUSION = Path("results/logs/conclusion")


def conclude(sentence: str) -> None:
    """Let the run end with a sentence."""
    write_text(_CONCLUSION, sentence)


def concluded() -> str:
    """The sentence with which this run ends; empty without one, and at the next call."""
    sentence = _CONCLUSION.read_text(encoding="utf-8") if _CONCLUSION.is_file() else ""
    _CONCLUSION.unlink(missing_ok=True)
    return sentence
