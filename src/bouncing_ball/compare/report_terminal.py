"""The short table for a terminal."""

from bouncing_ball.compare.folders import Artifact, Comparison
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.compare.parts import Part
from bouncing_ball.record.reading import printable

SENTENCES = {
    0: "The new artifacts say what the record says.",
    1: "The new artifacts differ from the record.",
    2: "Some artifacts could not be compared.",
}


# Of a text, more changed lines than these are in the other reports only.
_LINES = 5


def sentence(comparison: Comparison) -> str:
    """The result in a sentence, with what it leaves open."""
    reported = sum(
        not part.decides and part.outcome is not Outcome.IDENTICAL
        for artifact in comparison.artifacts
        for part in artifact.parts
    )
    more = f" Pictures drawn by another matplotlib and not judged: {reported}." if reported else ""
    return SENTENCES[status(comparison.outcome)] + more


def share_text(share: float | None) -> str:
    """A share of a budget: in per cent up to ten budgets, in budgets above.

    Examples
    --------
    >>> [share_text(share) for share in (None, 0.0, 0.00123, 1.46, 79.4, 12345.0)]
    ['', '0 %', '0.123 %', '146 %', '79.4 ×', '12 300 ×']
    >>> [share_text(share) for share in (1e-9, 2.5e8, float("inf"))]
    ['< 0.001 %', '> 1 000 000 ×', '∞']
    """
    if share is None:
        return ""
    if share == float("inf"):
        return "∞"
    if 0 < share < 1e-5:
        return "< 0.001 %"
    if share < 9.995:
        return f"{100 * share:.3g} %"
    rounded = float(f"{share:.3g}")
    return "> 1 000 000 ×" if rounded > 1e6 else f"{rounded:,.10g} ×".replace(",", " ")


def remarks(artifact: Artifact) -> list[str]:
    """One sentence for each part that is not the same.

    What decides comes first.
    """

    def remark(part: Part) -> str:
        note = f": {part.note}" if part.note else ""
        return f"{part.file} {part.outcome}{note}" + ("" if part.decides else " (reported only)")

    different = [
        part for part in artifact.parts if part.outcome is not Outcome.IDENTICAL or part.note
    ]
    ordered = sorted(different, key=lambda part: (not part.decides, -part.outcome.rank))
    return [remark(part) for part in ordered]


def changed_lines(artifact: Artifact) -> list[str]:
    """The lines of an artifact's texts that are not the same, from where they begin to differ.

    Of a vector graphic only the number of changed elements is given.
    """
    shown = []
    for part in artifact.parts:
        lines = () if part.file.endswith(".svg") else part.lines
        file = printable(part.file)
        for line in lines[:_LINES]:
            old, new = excerpts(line.record, line.new)
            shown.append(f"{file}, {line.place}: {old} → {new}")
        if len(lines) > _LINES:
            shown.append(f"{file}: {len(lines) - _LINES} more")
    return shown


def excerpts(record: str | None, new: str | None, width: int = 60) -> tuple[str, str]:
    """Two lines from shortly before where they begin to differ.

    Examples
    --------
    >>> excerpts("All of the readings are right, with one exception", None, width=12)
    ('All of the r…', '(none)')
    >>> excerpts("All of the readings are right", "All of the readings are wrong", width=12)
    ('…dings are ri…', '…dings are wr…')
    >>> excerpts("All of the readings", "All of the readings indeed", width=17)
    ('…e readings', '…e readings indeed')
    """
    pairs = enumerate(zip(record or "", new or "", strict=False))
    # One that only goes on differs where the other ends.
    ends = min(len(record or ""), len(new or ""))
    start = max(0, next((k for k, (old, each) in pairs if old != each), ends) - 10)

    def part(text: str | None) -> str:
        if text is None:
            return "(none)"
        shown = printable(text[start : start + width], None)
        return "…" * (start > 0) + shown + "…" * (start + width < len(text))

    return part(record), part(new)


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

    Under it, the first lines of its texts that are not the same.

    Examples
    --------
    >>> print(to_terminal(Comparison((Artifact("fig01", ()),))), end="")
    1 identical. The new artifacts say what the record says.
    """
    rows = [("artifact", "outcome", "of budget", "what")]
    details: dict[int, list[str]] = {}
    for artifact in comparison.artifacts:
        if artifact.outcome is not Outcome.IDENTICAL:
            first, *rest = [*remarks(artifact), ""]
            more = f" (+{len(rest) - 1})" if len(rest) > 1 else ""
            what = printable(first) + more
            name, share = printable(artifact.name, 40), share_text(artifact.share)
            details[len(rows)] = changed_lines(artifact)
            rows.append((name, str(artifact.outcome), share, what))
    width = max(len(row[0]) for row in rows)
    lines = []
    for number, (name, outcome, share, what) in enumerate(rows if len(rows) > 1 else ()):
        lines.append(f"{name:<{width}}  {outcome:<17}  {share:>9}  {what}")
        lines += [f"  {line}" for line in details.get(number, ())]
    lines.append(f"{counts(comparison)}. {sentence(comparison)}")
    return "".join(f"{line}\n" for line in lines)
