"""The short table for a terminal."""

from bouncing_ball.record.diff.folders import Artifact, Comparison
from bouncing_ball.record.diff.outcome import Outcome, status
from bouncing_ball.record.diff.parts import Part

SENTENCES = {
    0: "The new artifacts say what the record says.",
    1: "The new artifacts differ from the record.",
    2: "Some artifacts could not be compared.",
}


def share_text(share: float | None) -> str:
    """A share of a budget in three digits, nothing for what has no budget.

    Examples
    --------
    >>> [share_text(share) for share in (None, 0.0, 0.0123, 2.0, 12345.0, float("inf"))]
    ['', '0', '0.0123', '2', '1.23e+04', '∞']
    """
    if share is None:
        return ""
    return "∞" if share == float("inf") else f"{share:.3g}"


def remarks(artifact: Artifact) -> list[str]:
    """What there is to say of an artifact: one sentence for each part that is not the same.

    What decides comes first.
    """

    def sentence(part: Part) -> str:
        note = f": {part.note}" if part.note else ""
        return f"{part.file} {part.outcome}{note}" + ("" if part.decides else " (reported only)")

    different = [
        part for part in artifact.parts if part.outcome is not Outcome.IDENTICAL or part.note
    ]
    ordered = sorted(different, key=lambda part: (not part.decides, -part.outcome.rank))
    return [sentence(part) for part in ordered]


def counts(comparison: Comparison) -> str:
    """How many artifacts have which outcome, the worst first.

    Examples
    --------
    >>> counts(Comparison((Artifact("fig01", ()), Artifact("fig02", ()))))
    '2 identical'
    """
    outcomes = [artifact.outcome for artifact in comparison.artifacts]
    found = [(outcomes.count(outcome), outcome) for outcome in reversed(Outcome)]
    return ", ".join(f"{count} {outcome}" for count, outcome in found if count)


def to_terminal(comparison: Comparison) -> str:
    """One line for each artifact that is not identical, worst first, and the result.

    Examples
    --------
    >>> print(to_terminal(Comparison((Artifact("fig01", ()),))), end="")
    1 identical. The new artifacts say what the record says.
    """
    lines = []
    shown = [
        artifact for artifact in comparison.artifacts if artifact.outcome is not Outcome.IDENTICAL
    ]
    if shown:
        width = max(len(artifact.name) for artifact in shown)
        lines.append(f"{'artifact':<{max(width, 8)}}  {'outcome':<17}  {'share':>7}  what")
        for artifact in shown:
            first, *rest = [*remarks(artifact), ""]
            more = f" (+{len(rest) - 1})" if len(rest) > 1 else ""
            share = share_text(artifact.share)
            lines.append(
                f"{artifact.name:<{max(width, 8)}}  {artifact.outcome:<17}  {share:>7}  "
                f"{first}{more}"
            )
    lines.append(f"{counts(comparison)}. {SENTENCES[status(comparison.outcome)]}")
    return "".join(f"{line}\n" for line in lines)
