"""The reports on a comparison: lines for a terminal, and a page with both versions of each picture.

Both name the cause of a difference first. The page needs neither a network nor a script.
"""

import base64
import re
from difflib import SequenceMatcher
from io import BytesIO
from itertools import takewhile
from urllib.parse import quote

from bouncing_ball.pipeline.artifacts import DATASET
from bouncing_ball.pipeline.diff.outcome import ComparedItem, Outcome, Whole
from bouncing_ball.pipeline.diff.words import both_contents, moved_by, summary_of_changes

_SENTENCES = (
    "The new artifacts agree with the record.",
    "The new artifacts differ from the record.",
    "Some artifacts could not be compared.",
)

# These outcomes are no adjectives: one artifact with changed parameters.
_NOUNS = (Outcome.STRUCTURE, Outcome.PARAMETERS)


def sentence(comparison: Whole) -> str:
    """The number of artifacts with each outcome, worst first, and the result as a sentence.

    Examples
    --------
    >>> sentence(Whole("", (Whole("fig01"), Whole("fig02"))))
    '2 identical. The new artifacts agree with the record.'
    >>> row = ComparedItem("parameter n", Outcome.PARAMETERS, "1", "2")
    >>> sentence(Whole("", (Whole("fig01", (row,)),)))
    '1 with changed parameters. The new artifacts differ from the record.'
    """
    outcomes = [artifact.outcome for artifact in comparison.parts]
    found = [(outcomes.count(outcome), outcome) for outcome in reversed(Outcome)]
    counts = ", ".join(
        f"{count} {'with ' if outcome in _NOUNS else ''}{outcome}"
        for count, outcome in found
        if count
    )
    return f"{counts}. {_SENTENCES[comparison.outcome.status]}"


def share_text(share: float) -> str:
    """A share of a budget in per cent; empty for 0, and beyond the budget, where changes say more.

    Examples
    --------
    >>> [share_text(share) for share in (0.0, 0.00123, 0.5, 3e5)]
    ['', '0.123 %', '50 %', '']
    """
    return f"{100 * share:.3g} %" if 0 < share <= 1 else ""


def entries_text(row: ComparedItem) -> str:
    """The number of entries of a variable that moved.

    Examples
    --------
    >>> entries_text(ComparedItem("phase", Outcome.DRIFTED, moved=7, beyond=2, entries=1204))
    '7 of 1204, 2 beyond the budget'
    """
    if not row.entries:
        return ""
    if row.beyond:
        return f"{row.moved} of {row.entries}, {row.beyond} beyond the budget"
    return f"{row.moved} of {row.entries}"


def _excerpt(text: str | None, start: int, width: int = 60) -> str:
    """The part of a line that begins some words before a place, if there is a line."""
    if not text:
        return "nothing" if text is None else "an empty line"
    first = max(0, start - 20)
    shown = text[first : first + width]
    before = "… " if first else ""
    after = " …" if first + width < len(text) else ""
    return f"{before}{shown.strip()}{after}"


def _change(row: ComparedItem) -> str:
    """Both contents of a row, of long texts the part where they begin to differ."""
    if row.record is None and row.new is None:
        return ""
    pairs = zip(row.record or "", row.new or "", strict=False)
    start = len(list(takewhile(lambda pair: pair[0] == pair[1], pairs)))
    return f"{_excerpt(row.record, start)} → {_excerpt(row.new, start)}"


def greatest_difference(file: Whole) -> str:
    """The place where a file differs most, with the difference there.

    Examples
    --------
    >>> row = ComparedItem("line 1", Outcome.DRIFTED, "r = 0.25", "r = 0.26")
    >>> greatest_difference(Whole("paper.md", (row,)))
    'line 1: r = 0.25 → r = 0.26'
    """
    rows = file.moved
    if not rows:
        return ""
    is_dataset = file.name.endswith(DATASET)
    if is_dataset and file.outcome is Outcome.PARAMETERS:
        variables = [row for row in file.parts if row.entries]
        moved = [row for row in variables if row.moved]
        structure = [row for row in rows if row.outcome is Outcome.STRUCTURE]
        differ = f"{len(moved)} of {len(variables)} variables differ"
        return differ + (f", {len(structure)} parts of the structure" if structure else "")
    first, *others = rows
    place = f" at {first.at}" if first.at else ""
    if first.entries:
        change = f" ({found})" if (found := moved_by(first)) else ""
        both = both_contents(first) + change
    else:
        both = _change(first) or first.note
    what = ": ".join(filter(None, [first.name + place, both]))
    entries = f"; entries moved: {entries_text(first)}" if first.entries else ""
    return what + entries + (f"; and {len(others)} more" if others else "")


def told_files(artifact: Whole) -> list[Whole]:
    """The files of an artifact whose differences are told.

    A file that was not made has its reason beside the name of the artifact. Tables and labels say
    the same as their dataset, so that they are left out if it differs.
    """
    moved = [file for file in artifact.moved if file.outcome is not Outcome.NOT_MADE]
    data = [file for file in moved if file.name.endswith(DATASET) and not file.outcome.agrees]
    if not data:
        return moved
    return [file for file in moved if file in data or file.name.endswith(".png")]


def to_terminal(comparison: Whole) -> str:
    """For each artifact that is not identical its cause and its files, and then the result.

    Examples
    --------
    >>> row = ComparedItem("line 1", Outcome.DRIFTED, "r = 0.25", "r = 0.26")
    >>> paper = Whole("paper", (Whole("paper.md", (row,)),), cause="made from fig14")
    >>> print(to_terminal(Whole("", (paper, Whole("fig01")))), end="")
    paper: made from fig14
      paper.md  drifted  line 1: r = 0.25 → r = 0.26
    1 drifted, 1 identical. The new artifacts differ from the record.
    """
    shown = {artifact.name: told_files(artifact) for artifact in comparison.moved}
    files = [file for of_artifact in shown.values() for file in of_artifact]
    name_width = max((len(file.name) for file in files), default=0)
    outcomes = {file.name: _outcome_text(file) for file in files}
    outcome_width = max(map(len, outcomes.values()), default=0)
    lines = []
    for artifact in comparison.moved:
        lines.append(f"{artifact.name}: {artifact.cause}")
        for file in shown[artifact.name]:
            name = f"{file.name:<{name_width}}"
            outcome = f"{outcomes[file.name]:<{outcome_width}}"
            lines.append(f"  {name}  {outcome}  {greatest_difference(file)}".rstrip())
    return "".join(f"{line}\n" for line in [*lines, sentence(comparison)])


def _outcome_text(file: Whole) -> str:
    """The outcome of a file, with its share of the budget if it is judged by that."""
    if file.outcome in (Outcome.WITHIN, Outcome.DRIFTED):
        return f"{file.outcome} {share_text(file.share)}".rstrip()
    return str(file.outcome)


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
    old_words, new_words = (
        re.findall(r"[^\s,;|&]+|[\s,;|&]+", text or "") for text in (record, new)
    )
    old_marked: _Words = []
    new_marked: _Words = []
    blocks = SequenceMatcher(None, old_words, new_words, autojunk=False).get_opcodes()
    for kind, first, last, new_first, new_last in blocks:
        is_same = kind == "equal"
        old_marked.append((is_same, "".join(old_words[first:last])))
        new_marked.append((is_same, "".join(new_words[new_first:new_last])))
    return old_marked, new_marked


# Pixels across, and colours, of the pictures in the page: enough to see what moved.
_WIDTH = 800
_COLOURS = 32


def _small(content: bytes) -> bytes:
    """A PNG as a smaller one; a file that is no picture as it is."""
    # Imported here, because the lines for the terminal do not need it.
    from PIL import Image

    try:
        with Image.open(BytesIO(content)) as picture:
            whole = picture.convert("RGBA")
    except OSError:
        return content
    ground = Image.new("RGBA", whole.size, "white")
    flat = Image.alpha_composite(ground, whole).convert("RGB")
    if flat.width > _WIDTH:
        flat = flat.resize((_WIDTH, round(flat.height * _WIDTH / flat.width)))
    small = BytesIO()
    flat.quantize(_COLOURS).save(small, "PNG", optimize=True)
    return min(small.getvalue(), content, key=len)


def _base64(content: bytes) -> str:
    return base64.b64encode(_small(content)).decode("ascii")


def _shown_pictures(artifact: Whole) -> list[Whole]:
    """The pictures of an artifact that do not agree with the record."""
    return [file for file in artifact.parts if any(file.pictures) and not file.outcome.agrees]


def differences_html(comparison: Whole) -> str:
    """The page: artifacts worst first, with the record's and the new version of each picture.

    The pictures that do not agree with the record are embedded, with fewer pixels and colours.
    Artifacts that agree have one line. The buttons work by style sheets, without a script.

    Examples
    --------
    >>> "<h1>Artifacts against the record</h1>" in differences_html(Whole(""))
    True
    """
    # Imported here, because the lines for the terminal do not need it.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("bouncing_ball.pipeline.diff", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.j2").render(
        comparison=comparison,
        sentence=sentence(comparison),
        headline=summary_of_changes(comparison),
        told_files=told_files,
        shown_pictures=_shown_pictures,
        numbers=both_contents,
        moved_by=moved_by,
        marked=marked,
        note=greatest_difference,
        anchor=quote,
        share=share_text,
        entries=entries_text,
        base64=_base64,
    )
