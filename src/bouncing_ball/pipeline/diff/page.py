"""The short table for a terminal, and for the summary of a forge's job.

The HTML page with record and results side by side; it needs neither a network nor a script.
"""

import base64
import re
from difflib import SequenceMatcher
from typing import Any
from urllib.parse import quote

from bouncing_ball.errors import printable
from bouncing_ball.pipeline.diff.outcome import Outcome, Whole

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
    >>> from bouncing_ball.pipeline.diff.outcome import Row
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


def _plain(value: Any) -> Any:
    """The value of an expression on the page; text other than markup is put on one line."""
    is_text = isinstance(value, str) and not hasattr(value, "__html__")
    return printable(value, None) if is_text else value


_Words = list[tuple[bool, str]]


def marked(record: str | None, new: str | None) -> tuple[_Words, _Words]:
    """The words of two texts, each with a flag whether it is the same on both sides.

    Examples
    --------
    >>> for side in marked("r, 0.25, ball", "r, 0.27, table"):
    ...     print(side)
    [(True, 'r, '), (False, '0.25'), (True, ', '), (False, 'ball')]
    [(True, 'r, '), (False, '0.27'), (True, ', '), (False, 'table')]
    """
    old, now = (re.findall(r"[^\s,;|&]+|[\s,;|&]+", text or "") for text in (record, new))
    found: tuple[_Words, _Words] = ([], [])
    for kind, a, b, c, d in SequenceMatcher(None, old, now, autojunk=False).get_opcodes():
        found[0].append((kind == "equal", "".join(old[a:b])))
        found[1].append((kind == "equal", "".join(now[c:d])))
    return found


def to_html(comparison: Whole) -> str:
    """The page: artifacts worst first, with the record's and the new version of each picture.

    All pictures are embedded; a picture that is identical on both sides is embedded once. The
    buttons work by style sheets, without a script.

    Examples
    --------
    >>> "<h1>Artifacts against the record</h1>" in to_html(Whole(""))
    True
    """
    # Imported here, because the table for the terminal does not need it.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("bouncing_ball.pipeline.diff", "."),
        autoescape=True,
        finalize=_plain,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.j2").render(
        comparison=comparison,
        sentence=sentence(comparison),
        marked=marked,
        note=note,
        # A lone surrogate has no UTF-8 code that could be quoted.
        anchor=lambda name: quote(printable(name, None)),
        share=share_text,
        base64=lambda content: base64.b64encode(content).decode("ascii"),
    )
