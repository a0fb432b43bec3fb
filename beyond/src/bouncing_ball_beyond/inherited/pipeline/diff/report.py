"""The reports on a comparison: lines for a terminal, and a page with both versions of each picture.

Both tell each artifact that differs with its cause, and what of it moved most. The page needs
neither a network nor a script. It is ``results/diff/index.html``, with the lines in ``diff.txt``
beside it, whatever was compared; a run begins by removing both.
"""

import base64
import os
from collections import Counter
from collections.abc import Collection, Mapping
from io import BytesIO
from pathlib import Path
from urllib.parse import quote

from bouncing_ball_beyond.inherited.datasets.files import write_text
from bouncing_ball_beyond.inherited.errors import escaped, printable
from bouncing_ball_beyond.inherited.pipeline.diff.compare import compare_folders
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Whole
from bouncing_ball_beyond.inherited.pipeline.diff.texts import some
from bouncing_ball_beyond.inherited.pipeline.run import PAGE

_SENTENCES = (
    "The results agree with the record.",
    "The results differ from the record.",
    "Some artifacts could not be compared.",
)
# These outcomes are no adjectives: one artifact with changed parameters.
_NOUNS = (Outcome.STRUCTURE, Outcome.PARAMETERS)
# More changed words of an artifact than these are counted.
_NAMED = 10
# Pixels across, and colours, of the pictures in the page: enough to see what moved.
_WIDTH = 800
_COLOURS = 32


def sentence(comparison: Whole) -> str:
    """The number of artifacts with each outcome, worst first, and the result as a sentence.

    Examples
    --------
    >>> sentence(Whole("", (Whole("fig01"), Whole("fig02"))))
    '2 identical. The results agree with the record.'
    >>> from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Row
    >>> row = Row("n", Outcome.PARAMETERS, "n 1 → 2")
    >>> sentence(Whole("", (Whole("fig01", (row,)),)))
    '1 with changed parameters. The results differ from the record.'
    """
    count = Counter(artifact.outcome for artifact in comparison.parts)
    named = [
        f"{count[outcome]} {'with ' if outcome in _NOUNS else ''}{outcome}"
        for outcome in reversed(Outcome)
        if count[outcome]
    ]
    return f"{', '.join(named)}. {_SENTENCES[comparison.outcome.status]}"


def headline(comparison: Whole) -> list[str]:
    r"""The files of code in which the causes may be, and a line for each artifact that differs.

    A file comes first if it made more of them. A line has the cause and what moved most, of words
    everything.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Row
    >>> rows = tuple(Row("phase", Outcome.DRIFTED, f"+{n} % in phase", n) for n in (1, 9))
    >>> two = [Whole(x, (Whole("", rows),), cause="other", code=("a.py",)) for x in ("one", "two")]
    >>> print(*headline(Whole("", tuple(two))), sep="\n")
    changed code (artifacts made by it that differ): a.py (2)
    one: other; +9 % in phase; and 1 more
    two: other; +9 % in phase; and 1 more
    """
    count = Counter(file for artifact in comparison.moved for file in artifact.code)
    named = [f"{file} ({number})" for file, number in count.most_common()]
    lines = [f"changed code (artifacts made by it that differ): {some(named)}"] if named else []
    for artifact in comparison.moved:
        rows = [row for file in artifact.told for row in file.moved]
        # The cause has told some of them.
        told = [row for row in rows if row.told and row.told not in artifact.cause]
        shown = [row for row in told if row.is_words][:_NAMED] or told[:1]
        more = [f"and {len(told) - len(shown)} more"] if told[len(shown) :] else []
        line = "; ".join([artifact.cause, *(row.told for row in shown), *more])
        lines.append(f"{artifact.name}: {line}")
    return lines


def to_terminal(comparison: Whole) -> str:
    """The lines of :func:`headline`, and the result in the last one.

    Examples
    --------
    >>> to_terminal(Whole("", (Whole("fig01"),)))
    '1 identical. The results agree with the record.\\n'
    """
    lines = [*headline(comparison), sentence(comparison)]
    return "".join(f"{printable(line, None)}\n" for line in lines)


def _small(content: bytes) -> str:
    """A PNG as a smaller one, in the characters of a page."""
    # Imported here, because the lines for the terminal do not need it.
    from PIL import Image

    with Image.open(BytesIO(content), formats=["PNG"]) as picture:
        whole = picture.convert("RGB")
    whole.thumbnail((_WIDTH, 2 * _WIDTH))
    small = BytesIO()
    whole.quantize(_COLOURS).save(small, "PNG", optimize=True)
    return base64.b64encode(small.getvalue()).decode("ascii")


def differences_html(comparison: Whole) -> str:
    """The page: what differs, with the record's and the new version of each picture.

    The pictures that do not agree with the record are embedded, with fewer pixels and colours. The
    buttons work by style sheets, without a script.

    Examples
    --------
    >>> "<h1>Results against the record</h1>" in differences_html(Whole(""))
    True
    """
    # Imported here, because the lines for the terminal do not need it.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("bouncing_ball_beyond.inherited.pipeline.diff", "."),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=lambda value: escaped(value) if type(value) is str else value,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("report.html.j2").render(
        comparison=comparison,
        sentence=sentence(comparison),
        headline=headline(comparison),
        anchor=lambda name: quote(escaped(name)),
        small=_small,
    )


def write_reports(
    house: Path, artifacts: Collection[str], not_made: Mapping[str, str] | None = None
) -> str:
    """Compare ``results`` with the record, write both reports, and print that for a terminal.

    Parameters
    ----------
    house : Path
        The folder of the record.
    artifacts : collection of str
        Names of the artifacts to compare; all, if empty.
    not_made : mapping, optional
        The files under ``results`` that the run did not make, each with its reason.

    Returns
    -------
    str
        The sentence with which the run ends; empty if the results agree with the record.
    """
    missing = {file.removeprefix("results/"): why for file, why in (not_made or {}).items()}
    comparison = compare_folders(house, Path("results"), artifacts, missing)
    text = to_terminal(comparison)
    write_text(PAGE.with_name("diff.txt"), text)
    write_text(PAGE, differences_html(comparison))
    print(text, end="", flush=True)
    if not comparison.outcome.status:
        return ""
    # A run with `--directory` has a page of its own.
    page = os.path.relpath(PAGE, house)
    return f"diff: the results differ from the record (exit status 1), see {page}"
