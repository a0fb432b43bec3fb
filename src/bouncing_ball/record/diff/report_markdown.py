"""The summary for continuous integration, as Markdown."""

from bouncing_ball.record.diff.folders import Comparison
from bouncing_ball.record.diff.outcome import Outcome, status
from bouncing_ball.record.diff.report_terminal import SENTENCES, counts, remarks, share_text

# Characters that would end a cell, or be taken for markup.
_SPECIAL = str.maketrans({character: f"\\{character}" for character in "\\`*_[]<>|~#"})


def escaped(text: str) -> str:
    """Text that stands in a cell of a table as it is.

    Examples
    --------
    >>> escaped("a|b <i>")
    'a\\\\|b \\\\<i\\\\>'
    """
    return " ".join(text.split()).translate(_SPECIAL)


def to_markdown(comparison: Comparison) -> str:
    """The result, and a table of all artifacts that are not identical.

    Examples
    --------
    >>> print(to_markdown(Comparison(())), end="")
    ## Artifacts against the record
    <BLANKLINE>
    **The new artifacts say what the record says.** No artifacts.
    """
    sentence = SENTENCES[status(comparison.outcome)]
    lines = [
        "## Artifacts against the record",
        "",
        f"**{sentence}** {(counts(comparison) or 'No artifacts')[:1].upper()}"
        f"{(counts(comparison) or 'No artifacts')[1:]}.",
    ]
    shown = [
        artifact for artifact in comparison.artifacts if artifact.outcome is not Outcome.IDENTICAL
    ]
    if shown:
        lines += [
            "",
            "| artifact | outcome | share of budget | what |",
            "| --- | --- | ---: | --- |",
        ]
    for artifact in shown:
        name, share = escaped(artifact.name), share_text(artifact.share)
        what = "<br>".join(escaped(remark) for remark in remarks(artifact))
        outcome = f"**{artifact.outcome}**" if not artifact.outcome.agrees else artifact.outcome
        lines.append(f"| {name} | {outcome} | {share} | {what} |")
    return "".join(f"{line}\n" for line in lines)
