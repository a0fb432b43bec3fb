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
# Of a file, more that has moved than this is on the page only.
_ROWS = 5


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
    drawn = sum(bool(part.redrawn) for part in parts)
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
    different = [part for part in artifact.parts if part.moved]
    different.sort(key=lambda part: (bool(part.redrawn), -part.outcome.rank))
    return [
        printable(f"{part.file} {part.outcome}: {part.note}".removesuffix(": "))
        + " (reported only)" * bool(part.redrawn)
        for part in different
    ]


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
    old, now, start = record or "", new or "", 0
    if max(len(old), len(now)) > width:
        # A line that only goes on differs where the other one ends.
        pairs, ends = enumerate(zip(old, now, strict=False)), min(len(old), len(now))
        start = max(0, next((k for k, (a, b) in pairs if a != b), ends) - 10)

    def part(text: str | None) -> str:
        if text is None:
            return "(none)"
        shown = printable(text[start : start + width], None)
        return "…" * (start > 0) + shown + "…" * (start + width < len(text))

    return part(record), part(new)


def _moved(part: Part) -> list[str]:
    """What does not agree any more, from where both sides begin to differ."""
    rows = [row for row in part.rows if not row.outcome.agrees and (row.record or row.new)]
    shown = []
    for row in rows[:_ROWS]:
        where = f"{part.file}, {row.where}" + (f" at {row.at}" if row.at else "")
        shown.append(f"  {printable(where)}: {' → '.join(excerpts(row.record, row.new))}")
    if len(rows) > _ROWS:
        shown.append(f"  {printable(part.file)}: {len(rows) - _ROWS} more")
    return shown


def to_terminal(comparison: Comparison) -> str:
    """One line for each artifact that is not identical, worst first, and the result.

    Under it is what does not agree any more.

    Examples
    --------
    >>> print(to_terminal(Comparison((Artifact("fig01", ()),))), end="")
    1 identical. The new artifacts say what the record says.
    """
    different = [each for each in comparison.artifacts if each.outcome is not Outcome.IDENTICAL]
    width = max((len(printable(each.name, 40)) for each in different), default=0)
    form = f"{{:<{max(width, 8)}}}  {{:<21}}  {{:>9}}  {{}}".format
    lines = [form("artifact", "outcome", "of budget", "what")] if different else []
    for artifact in different:
        first, *rest = remarks(artifact)
        what = first + (f" (+{len(rest)})" if rest else "")
        name = printable(artifact.name, 40)
        lines.append(form(name, artifact.outcome, share_text(artifact.share), what))
        lines += [line for part in artifact.parts for line in _moved(part)]
    return "".join(f"{line}\n" for line in [*lines, sentence(comparison)])
