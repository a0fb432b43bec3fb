"""The short table for a terminal, and for the summary of a forge's job."""

from bouncing_ball.compare.folders import Artifact, Comparison
from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.parts import Part
from bouncing_ball.errors import printable

_SENTENCES = (
    "The new artifacts say what the record says.",
    "The new artifacts differ from the record.",
    "Some artifacts could not be compared.",
)
# Of a text, more changed lines than these are on the page only.
_LINES = 5


def sentence(comparison: Comparison) -> str:
    """How many artifacts have which outcome, worst first, and the result in a sentence.

    Examples
    --------
    >>> sentence(Comparison((Artifact("fig01", ()), Artifact("fig02", ()))))
    '2 identical. The new artifacts say what the record says.'
    """
    outcomes = [artifact.outcome for artifact in comparison.artifacts]
    found = [(outcomes.count(outcome), outcome) for outcome in reversed(Outcome)]
    counts = ", ".join(f"{count} {outcome}" for count, outcome in found if count)
    parts = [part for artifact in comparison.artifacts for part in artifact.parts]
    drawn = sum(not part.decides for part in parts)
    more = f" Pictures drawn by another matplotlib and not judged: {drawn}." if drawn else ""
    return f"{counts or 'No artifacts'}. {_SENTENCES[comparison.outcome.status]}{more}"


def share_text(share: float | None) -> str:
    """A share of a budget: in per cent up to ten budgets, in budgets above.

    Examples
    --------
    >>> [share_text(share) for share in (None, 0.0, 0.00123, 1.46, 79.4, 12345.0)]
    ['', '0 %', '0.123 %', '146 %', '79.4 ×', '1.23e+04 ×']
    >>> [share_text(share) for share in (1e-9, float("inf"))]
    ['< 0.001 %', '∞']
    """
    if share is None:
        return ""
    if share == float("inf"):
        return "∞"
    if 0 < share < 1e-5:
        return "< 0.001 %"
    return f"{100 * share:.3g} %" if share < 9.995 else f"{share:.3g} ×"


def remarks(artifact: Artifact) -> list[str]:
    """One sentence for each part that is not the same; what decides comes first."""

    def remark(part: Part) -> str:
        note = f": {part.note}" if part.note else ""
        return f"{part.file} {part.outcome}{note}" + ("" if part.decides else " (reported only)")

    different = [part for part in artifact.parts if part.outcome is not Outcome.IDENTICAL]
    ordered = sorted(different, key=lambda part: (not part.decides, -part.outcome.rank))
    return [printable(remark(part)) for part in ordered]


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
    # A line that only goes on differs where the other one ends.
    ends = min(len(record or ""), len(new or ""))
    start = max(0, next((k for k, (old, each) in pairs if old != each), ends) - 10)

    def part(text: str | None) -> str:
        if text is None:
            return "(none)"
        shown = printable(text[start : start + width], None)
        return "…" * (start > 0) + shown + "…" * (start + width < len(text))

    return part(record), part(new)


def _changed_lines(part: Part) -> list[str]:
    """The first lines of a text that are not the same, from where they begin to differ."""
    file, shown = printable(part.file), []
    for line in part.lines[:_LINES]:
        old, new = excerpts(line.record, line.new)
        shown.append(f"  {file}, {line.place}: {old} → {new}")
    if len(part.lines) > _LINES:
        shown.append(f"  {file}: {len(part.lines) - _LINES} more")
    return shown


def to_terminal(comparison: Comparison) -> str:
    """One line for each artifact that is not identical, worst first, and the result.

    Under it are the first lines of its texts that are not the same.

    Examples
    --------
    >>> print(to_terminal(Comparison((Artifact("fig01", ()),))), end="")
    1 identical. The new artifacts say what the record says.
    """
    rows = [("artifact", "outcome", "of budget", "what")]
    details: list[list[str]] = [[]]
    for artifact in comparison.artifacts:
        if artifact.outcome is not Outcome.IDENTICAL:
            first, *rest = remarks(artifact)
            what = first + (f" (+{len(rest)})" if rest else "")
            name = printable(artifact.name, 40)
            rows.append((name, str(artifact.outcome), share_text(artifact.share), what))
            details.append([line for part in artifact.parts for line in _changed_lines(part)])
    width = max(len(row[0]) for row in rows)
    lines = []
    for (name, outcome, share, what), more in zip(rows, details, strict=True):
        if len(rows) > 1:
            lines += [f"{name:<{width}}  {outcome:<21}  {share:>9}  {what}", *more]
    return "".join(f"{line}\n" for line in [*lines, sentence(comparison)])
