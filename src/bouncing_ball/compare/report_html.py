"""One page with everything, which needs neither a network nor a script."""

import base64
import difflib
import json
import math
import re
from collections import Counter
from collections.abc import Iterable
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined

from bouncing_ball.compare.folders import Comparison
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.compare.plots import plot
from bouncing_ball.compare.report_terminal import (
    counts,
    excerpts,
    remarks,
    sentence,
    share_text,
)
from bouncing_ball.record.provenance import Provenance, made_otherwise, read_mapping
from bouncing_ball.record.reading import printable

# Of one file: lines and variables in its table, and plots.
_MOST_LINES = 200
_MOST_PLOTS = 12
# Characters of a line; longer ones are shown from where they begin to differ.
_LONGEST = 200
# Characters of the page, above which the next artifacts are named only;
# the record has four million.
_LARGEST = 32 * 10**6
_NAMED = 8
_NUMBER = re.compile(r"[-+]?[0-9.]+(?:e[-+]?[0-9]+)?")


def _colour(outcome: Outcome) -> str:
    """Class of an outcome on the page."""
    return ("ok", "bad", "broken")[status(outcome)]


def _small(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:.2g}" if math.isfinite(value) else "∞"


def _plain(value: Any) -> Any:
    """The value of an expression of the page; text that is not markup yet, on one line."""
    return (
        value
        if hasattr(value, "__html__") or not isinstance(value, str)
        else printable(value, None)
    )


_Words = list[tuple[bool, str]]


def marked(record: str | None, new: str | None) -> tuple[_Words, _Words]:
    """Two texts in parts, each with whether it is the same on both sides.

    Of a number, from the first digit that is another.

    Examples
    --------
    >>> for side in marked("r, 0.25, ball", "r, 0.27, table"):
    ...     print(side)
    [(True, 'r, '), (True, '0.2'), (False, '5'), (True, ', '), (False, 'ball')]
    [(True, 'r, '), (True, '0.2'), (False, '7'), (True, ', '), (False, 'table')]
    """
    if record is None or new is None or max(len(record), len(new)) > _LONGEST:
        old, now = excerpts(record, new, _LONGEST)
    else:
        old, now = record, new
    words = [re.findall(r"[^\s,;|&]+|[\s,;|&]+", printable(text, None)) for text in (old, now)]
    blocks = difflib.SequenceMatcher(None, words[0], words[1], autojunk=False).get_opcodes()
    sides: tuple[_Words, _Words] = ([], [])
    for kind, first, last, new_first, new_last in blocks:
        texts = "".join(words[0][first:last]), "".join(words[1][new_first:new_last])
        digits = texts[0] if kind == "equal" else _same_digits(*texts)
        for side, text in zip(sides, texts, strict=True):
            side += [(True, digits)] * bool(digits)
            side += [(False, text[len(digits) :])] * (len(text) > len(digits))
    return sides


def _same_digits(old: str, new: str) -> str:
    """The common beginning of two numbers; empty for other texts."""
    if _NUMBER.fullmatch(old) and _NUMBER.fullmatch(new):
        pairs = enumerate(zip(old, new, strict=False))
        return old[: next((k for k, (a, b) in pairs if a != b), len(min(old, new, key=len)))]
    return ""


def _commit(made: Provenance | None) -> str:
    """The commit at which a file was made, in short."""
    if made is None:
        return "does not say"
    dirty = {"no": "", "yes": ", with changes"}.get(made.dirty, ", changes unknown")
    return f"{made.commit[:10]}{dirty}"


def _versions(record: Provenance, new: Provenance) -> list[str]:
    before, after = read_mapping(record.versions), read_mapping(new.versions)
    return [
        f"{name} {before.get(name, 'none')} → {after.get(name, 'none')}"
        for name in sorted(before.keys() | after.keys())
        if before.get(name) != after.get(name)
    ]


def _otherwise(record: Provenance | None, new: Provenance | None) -> str:
    """What two files were made from that differs, in a line."""
    if record is None or new is None:
        return ""
    found = made_otherwise(record, new)
    if record.configuration != new.configuration:
        found.append("another configuration of the run")
    found += _versions(record, new)
    more = [f"and {len(found) - _NAMED} more"] if len(found) > _NAMED else []
    return ", ".join(found[:_NAMED] + more) or "nothing"


def _sides(comparison: Comparison) -> list[tuple[str, str, str]]:
    """For the record and what is new: the commits and versions that its files name."""
    found = []
    for index, name in enumerate(("record", "new")):
        parts = (part for artifact in comparison.artifacts for part in artifact.parts)
        made = [each for part in parts if (each := part.made[index])]

        def listed(texts: Iterable[str]) -> str:
            ordered = Counter(texts).most_common()
            more = f"; and {len(ordered) - _NAMED} more" if len(ordered) > _NAMED else ""
            files = (
                f"{text} ({count} file{'s' * (count != 1)})" for text, count in ordered[:_NAMED]
            )
            return (ordered[0][0] if len(ordered) == 1 else "; ".join(files)) + more

        if made:
            versions = (
                ", ".join(f"{key} {value}" for key, value in json.loads(each.versions).items())
                for each in made
            )
            found.append((name, listed(map(_commit, made)), listed(versions)))
    return found


def to_html(comparison: Comparison) -> str:
    """The page: artifacts worst first; record, new and difference of each picture.

    All pictures are part of the page; one that is the same on both sides is
    there once. What the boxes and buttons do is style, and no script.

    Examples
    --------
    >>> "<h1>Artifacts against the record</h1>" in to_html(Comparison(()))
    True
    """
    environment = Environment(
        loader=PackageLoader("bouncing_ball.compare", "."),
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
        sides=_sides(comparison),
        marked=marked,
        room=_LARGEST,
        most_lines=_MOST_LINES,
        most_plots=_MOST_PLOTS,
        plot=plot,
        # Half of a surrogate pair has no code to be quoted.
        anchor=lambda name: quote(printable(name, None)),
        commit=_commit,
        otherwise=_otherwise,
        counts=counts(comparison) or "No artifacts",
        remarks=remarks,
        share=share_text,
        small=_small,
        colour=_colour,
        base64=lambda content: base64.b64encode(content).decode("ascii"),
    )
