"""The summary for continuous integration, as Markdown."""

from bouncing_ball.compare.folders import Comparison
from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.report_terminal import (
    changed_lines,
    counts,
    remarks,
    sentence,
    share_text,
)
from bouncing_ball.record.reading import printable

# Characters that would end a cell, or be taken for markup.
_SPECIAL = str.maketrans({character: f"\\{character}" for character in "\\`*_[]<>|~#"})


def escaped(text: str) -> str:
    """Text in a cell of a table, unchanged when read.

    Examples
    --------
    >>> escaped("a|b <i>")
    'a\\\\|b \\\\<i\\\\>'
    """
    return printable(" ".join(text.split())).translate(_SPECIAL)


def to_markdown(comparison: Comparison) -> str:
    """The result, and a table of all artifacts that are not identical.

    Examples
    --------
    >>> print(to_markdown(Comparison(())), end="")
    ## Artifacts against the record
    <BLANKLINE>
    **The new artifacts say what the record says.** No artifacts.
    """
    found = counts(comparison) or "no artifacts"
    lines = [
        "## Artifacts against the record",
        "",
        f"**{sentence(comparison)}** {found[:1].upper()}{found[1:]}.",
    ]
    shown = [
        artifact for artifact in comparison.artifacts if artifact.outcome is not Outcome.IDENTICAL
    ]
    if shown:
        lines += ["", "| artifact | outcome | of budget | what |", "| --- | --- | ---: | --- |"]
    for artifact in shown:
        name, share = escaped(artifact.name), share_text(artifact.share)
        what = "<br>".join(map(escaped, [*remarks(artifact), *changed_lines(artifact)]))
        outcome = f"**{artifact.outcome}**" if not artifact.outcome.agrees else artifact.outcome
        lines.append(f"| {name} | {outcome} | {share} | {what} |")
    return "".join(f"{line}\n" for line in lines)
