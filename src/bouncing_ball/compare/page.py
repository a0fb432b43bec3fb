"""The HTML page with record and results side by side; it needs neither a network nor a script."""

import base64
import re
from difflib import SequenceMatcher
from typing import Any
from urllib.parse import quote

from bouncing_ball.compare.outcome import Whole
from bouncing_ball.compare.terminal import note, sentence, share_text
from bouncing_ball.errors import printable


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
        marked=marked,
        note=note,
        # A lone surrogate has no UTF-8 code that could be quoted.
        anchor=lambda name: quote(printable(name, None)),
        share=share_text,
        base64=lambda content: base64.b64encode(content).decode("ascii"),
    )
