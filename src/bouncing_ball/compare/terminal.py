"""The short table for a terminal, and for the summary of a forge's job."""

from bouncing_ball.compare.outcome import Outcome, Whole
from bouncing_ball.errors import printable

_SENTENCES = (
    "The new artifacts agree with the record.",
    "The new artifacts differ from the record.",
    "Some artifacts could not be compared.",
)


def sentence(comparison: Whole) -> str:
    """The number of artifacts with each outcome, worst first, and the result as a sentence.

    Examples
    --------
    >>> sentence(Whole("", (Whole("fig01"), Whole("fig02"))))
    '2 identical. The new artifacts agree with the record.'
    """
    outcomes = [artifact.outcome for artifact in comparison.parts]
    found = [(outcomes.count(outcome), outcome) for outcome in reversed(Outcome)]
    counts = ", ".join(f"{count} {outcome}" for count, outcome in found if count)
    return f"{counts}. {_SENTENCES[comparison.outcome.status]}"


def share_text(share: float) -> str:
    """A share of a budget in per cent.

    Examples
    --------
    >>> [share_text(share) for share in (0.0, 0.00123, 1.46, float("inf"))]
    ['', '0.123 %', '146 %', 'inf %']
    """
    return f"{100 * share:.3g} %" if share else ""


def note(file: Whole) -> str:
    """The place where a file differs most, with the difference there.

    Examples
    --------
    >>> from bouncing_ball.compare.outcome import Row
    >>> note(Whole("paper.md", (Row("line 1", Outcome.DRIFTED, "r = 0.25", "r = 0.26"),)))
    'line 1: r = 0.25 → r = 0.26'
    """
    if not file.moved:
        return ""
    first, *rest = file.moved
    where = f"{first.name} at {first.at}" if first.at else first.name
    old, now = (printable(side or "nothing", 60) for side in (first.record, first.new))
    moved = f"{old} → {now}" if old != now else ""
    more = f"and {len(rest)} more" if rest else ""
    return printable(": ".join(filter(None, [where, moved, first.note, more])))


def to_terminal(comparison: Whole) -> str:
    """A line for each file that is not identical, worst artifact first, and the result.

    Examples
    --------
    >>> print(to_terminal(Whole("", (Whole("fig01"),))), end="")
    1 identical. The new artifacts agree with the record.
    """
    form = "{:<12}  {:<21}  {:>9}  {}".format
    lines = [form("artifact", "outcome", "of budget", "what")] if comparison.moved else []
    for artifact in comparison.moved:
        name = printable(artifact.name, 40)
        for file in artifact.moved:
            what = f"{printable(file.name)} {note(file)}".rstrip()
            lines.append(form(name, file.outcome, share_text(file.share), what))
    return "".join(f"{line}\n" for line in [*lines, sentence(comparison)])
