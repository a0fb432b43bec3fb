"""The comparison of texts line by line: words exactly, numbers as far as their data allow."""

import re
from decimal import Decimal
from difflib import SequenceMatcher
from itertools import zip_longest
from pathlib import Path

from bouncing_ball.pipeline.diff.outcome import ComparedItem, Outcome

# A printed number with its sign and exponent.
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d{1,4})?")


def _same_to_the_last_digit(old: str, new: str) -> bool:
    """Whether two printed numbers may be the same number, rounded on two processors.

    Examples
    --------
    >>> _same_to_the_last_digit("0.25", "0.26"), _same_to_the_last_digit("0.25", "0.27")
    (True, False)
    >>> _same_to_the_last_digit("99.99", "100"), _same_to_the_last_digit("7", "8")
    (True, False)
    >>> _same_to_the_last_digit("-4.5e-13", "-4.6e-13"), _same_to_the_last_digit("0.25", "0.3")
    (True, False)
    """
    if old == new:
        return True
    if old.lstrip("+-").isdigit() and new.lstrip("+-").isdigit():
        # A number without decimals is a count, or a part of a name.
        return False
    # If the numbers of decimals differ, at a power of ten or with zeros left out, the step is the
    # smaller unit.
    last = min(int(Decimal(number).as_tuple().exponent) for number in (old, new))
    return abs(Decimal(old) - Decimal(new)) <= Decimal(1).scaleb(last)


def may_be_rounding(old: str, new: str) -> bool:
    """Whether two lines have the same words, and numbers that differ by a last digit at most.

    Examples
    --------
    >>> may_be_rounding("r = 0.25 in 3 orbits", "r = 0.26 in 3 orbits")
    True
    >>> may_be_rounding("right, with 0.25", "wrong, with 0.25")
    False
    """
    return _NUMBER.split(old) == _NUMBER.split(new) and all(
        map(_same_to_the_last_digit, _NUMBER.findall(old), _NUMBER.findall(new))
    )


def _line_outcome(old: str | None, new: str | None, data: Outcome | None) -> Outcome:
    if data is not Outcome.WITHIN or old is None or new is None:
        return Outcome.DRIFTED
    return Outcome.WITHIN if may_be_rounding(old, new) else Outcome.DRIFTED


def compare_texts(record: str, new: str, data: Outcome | None) -> list[ComparedItem]:
    """All lines that differ, each with its outcome.

    If the data have drifted within their budget, the last digit of a printed number may change by
    one. No other change is allowed: no word, no count, and no digit if the data are identical or
    there are none.

    Parameters
    ----------
    record, new : str
    data : Outcome or None
        The worst outcome of the datasets from which the text is made.

    Examples
    --------
    >>> for data in (Outcome.WITHIN, Outcome.IDENTICAL):
    ...     print(*[str(line.outcome) for line in compare_texts("0.25\\nb", "0.26\\nb", data)])
    within budget
    drifted
    >>> line, = compare_texts("are right\\n", "are wrong\\n", Outcome.WITHIN)
    >>> line.name, str(line.outcome), line.record, line.new
    ('line 1', 'drifted', 'are right', 'are wrong')
    """
    old_lines = record.split("\n")
    new_lines = new.split("\n")
    # Lines are matched by their words, so that a line whose number changes is still matched.
    old_words = [_NUMBER.sub("#", line) for line in old_lines]
    new_words = [_NUMBER.sub("#", line) for line in new_lines]
    blocks = SequenceMatcher(None, old_words, new_words, autojunk=False).get_opcodes()
    found = []
    for _, first, last, new_first, new_last in blocks:
        pairs = zip_longest(old_lines[first:last], new_lines[new_first:new_last])
        for number, (old, now) in enumerate(pairs, start=first + 1):
            if old != now:
                found.append(
                    ComparedItem(f"line {number}", _line_outcome(old, now, data), old, now)
                )
    return found


def words_of(path: Path, data: Outcome | None = None) -> str:
    """The words and numbers of a file, as lines.

    For a vector graphic these are the labels, and the letters that draw them, because matplotlib
    draws a text as outlines, one for each letter, with the text in a comment. For an HTML page it
    is all text except the commit, and except the reference numbers if their dataset, whose outcome
    is ``data``, is not identical: they have all its digits. Any other text is returned unchanged.

    Raises
    ------
    OSError, UnicodeDecodeError
        If the file cannot be read, or is not UTF-8.
    """
    text = path.read_text(encoding="utf-8")
    match path.suffix:
        case ".svg":
            words = r'<!-- (.*?) -->|href="#([\w-]+-[0-9a-f]+)"|<text[^>]*>(.*?)</text>'
            return "\n".join("".join(parts) for parts in re.findall(words, text))
        case ".html":
            moved = "" if data is Outcome.IDENTICAL else r'|(?<=id="references">)[^<]*'
            return re.sub(rf'(?<="commit": ")\w+{moved}', "", text)
        case _:
            return text


_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
# A name that matplotlib gives to a path, a clip or a marker; it follows from their contents.
_GENERATED = re.compile(r'\bid="(\w*[0-9a-f]{10})"')
_KINDS = re.compile(r"<(\w+)|\s([\w:-]+)=\"")


def _drawing(text: str) -> str:
    """What a vector graphic draws, without its metadata, and with numbers for generated names."""
    text = _METADATA.sub("", text)
    names = {name: f"name{k}" for k, name in enumerate(_GENERATED.findall(text))}
    if not names:
        return text
    return re.sub("|".join(names), lambda match: names[match[0]], text)


def compare_drawings(record: str, new: str, data: Outcome | None) -> list[ComparedItem]:
    """A row if two vector graphics draw something else; their words are compared elsewhere.

    If the data are identical, or if there are none, all elements must be, with numbers up to their
    last digit. If the data moved, only the kinds of elements and attributes are judged, and the row
    says so.

    Examples
    --------
    >>> blue, red = (f'<path d="M 0.25 1.5" style="fill: {x}"/>' for x in ("#00f", "#f00"))
    >>> for data in (Outcome.IDENTICAL, Outcome.WITHIN):
    ...     (row,) = compare_drawings(blue, red, data)
    ...     print(f"{row.name}: {row.outcome} {row.note}".rstrip())
    drawing: drifted
    drawing: within budget its data moved, and only its words were compared
    >>> compare_drawings(blue, blue.replace("0.25", "0.26"), Outcome.IDENTICAL)
    []
    """
    old, now = (_drawing(text) for text in (record, new))
    if old == now:
        return []
    kinds, new_kinds = ({"".join(pair) for pair in _KINDS.findall(text)} for text in (old, now))
    if kinds != new_kinds:
        gone = ", ".join(sorted(kinds - new_kinds)) or None
        come = ", ".join(sorted(new_kinds - kinds)) or None
        return [ComparedItem("elements", Outcome.DRIFTED, gone, come)]
    if data not in (Outcome.IDENTICAL, None):
        said = "its data moved, and only its words were compared"
        return [ComparedItem("drawing", Outcome.WITHIN, note=said)]
    for line, new_line in zip_longest(old.split("\n"), now.split("\n")):
        if line is None or new_line is None or not may_be_rounding(line, new_line):
            return [ComparedItem("drawing", Outcome.DRIFTED, line, new_line)]
    return []
