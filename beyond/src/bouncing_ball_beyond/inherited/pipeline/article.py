"""Articles: from datasets and templates to Markdown.

A template takes every number from a dataset and prints it by one of the functions in
:data:`FORMATS`. Then headings, figures and tables get their numbers, and pandoc (part of
``pypandoc_binary``) replaces the citations by numbers and lists the works cited. The result is
Markdown as GitHub shows it.
"""

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pypandoc
import xarray as xr
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from bouncing_ball_beyond.inherited.datasets.artifact import Artifact
from bouncing_ball_beyond.inherited.errors import ModelError

# Numbers.

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _typeset(number: str) -> str:
    """A number printed by Python, with typographic signs for minus, infinity and NaN (a dash)."""
    return number.replace("nan", "–").replace("inf", "∞").replace("-", "−")


def decimal(value: float, digits: int) -> str:
    """A number with the given number of decimals; a dash for NaN.

    Examples
    --------
    >>> decimal(82.1774, 2), decimal(float("nan"), 2), decimal(float("inf"), 2)
    ('82.18', '–', '∞')
    """
    # Adding 0.0 removes the sign of a zero that results from rounding.
    rounded = round(float(value), digits) + 0.0
    return _typeset(f"{rounded:.{digits}f}")


def short(value: float, digits: int = 6) -> str:
    """A parameter without trailing zeros; small and large values have a power of ten.

    Examples
    --------
    >>> short(0.85), short(10000.0), short(2.5e-13, 2), short(99.7, 2)
    ('0.85', '10⁴', '2.5·10⁻¹³', '100')
    """
    value = float(value)
    is_small = 0 < abs(value) < 1e-3
    is_large = 1e4 <= abs(value) < math.inf
    if not is_small and not is_large:
        rounded = float(f"{value:.{digits}g}")
        return _typeset(f"{rounded:.15g}")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    factor = f"{float(mantissa):g}"
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    return power if factor == "1" else _typeset(f"{factor}·{power}")


def rounded_percent(share: float, digits: int = 3) -> str:
    """A share in per cent.

    Examples
    --------
    >>> rounded_percent(0.01), rounded_percent(0.0279, 2)
    ('1 %', '2.8 %')
    """
    # A share of a sample may lie halfway between two texts; rounding errors must not decide there.
    above_a_half = 100 * float(share) * (1 + 1e-9)
    return f"{short(above_a_half, digits)} %"


def percent_at_most(share: float, digits: int) -> str:
    """A share in per cent, rounded up, for a sentence that says "at most" or "up to".

    Examples
    --------
    >>> rounded_percent(0.00345, 1), percent_at_most(0.00345, 1), percent_at_most(0.03, 2)
    ('0.3 %', '0.4 %', '3 %')
    >>> percent_at_most(float("nan"), 2)
    '– %'
    """
    value = 100 * abs(float(share))
    if math.isnan(value):
        return rounded_percent(value)
    step = 10.0 ** (math.floor(math.log10(value)) - digits + 1) if value else 1.0
    # A share that has so few digits itself is not raised by its rounding error.
    return f"{short(step * math.ceil(value / step * (1 - 1e-9)), digits)} %"


def listed(values: Iterable[str | float], word: str = "and") -> str:
    """Texts or numbers as a list in a sentence.

    Examples
    --------
    >>> listed([0.7, 1.0, 1.2])
    '0.7, 1 and 1.2'
    """
    *others, last = [value if isinstance(value, str) else short(value) for value in values]
    return f"{', '.join(others)} {word} {last}" if others else last


def pairs(left: Iterable[float], right: Iterable[float]) -> list[str]:
    """Pairs of parameters in brackets.

    Examples
    --------
    >>> pairs([0.85, 0.65], [1.0, 1.2])
    ['(0.85, 1)', '(0.65, 1.2)']
    """
    return [f"({short(a)}, {short(b)})" for a, b in zip(left, right, strict=True)]


FORMATS = {
    "at_most": percent_at_most,
    "decimal": decimal,
    "listed": listed,
    "pairs": pairs,
    "percent": rounded_percent,
    "short": short,
}
"""The functions that templates can call, by their names there."""
# The numbers of sections, figures and tables.

_HEADING = re.compile(r"^(##+) (?!Abstract|References)(.+)$", re.MULTILINE)
# The first words of a caption, and a reference from anywhere.
_CAPTION = re.compile(r"\*\*(Figure|Table) «(\w+)»")
_REFERENCE = re.compile(r"«([^»\n]+)»")
_NUMBERED_HEADING = re.compile(r"^##+ (S?\d+(?:\.\d+)?)\.? (.+)$", re.MULTILINE)


def sections_of(text: str) -> dict[str, str]:
    """The numbers of the sections of a numbered text by their headings.

    Examples
    --------
    >>> sections_of("# Supplement\\n## S1. Checks\\n### S1.1 Routes\\n## References")
    {'Checks': 'S1', 'Routes': 'S1.1'}
    """
    return {name: number for number, name in _NUMBERED_HEADING.findall(text)}


def numbered(text: str, sections: Mapping[str, str] | None = None) -> str:
    """The text with numbers in its headings and in place of the references ``«name»``.

    The name of a section is its heading; ``sections`` has the numbers of those of another text.
    Figures and tables are numbered in the order of their captions, ``**Figure «name»`` and
    ``**Table «name»``. In a replication the numbers follow those of the 16 figures and the table of
    the paper; in a supplement they begin with S1, and in any other article with 1.

    Raises
    ------
    KeyError
        If no section, figure or table has the name of a reference.

    Examples
    --------
    >>> text = "## Models\\n### Flight\\n**Figure «ball».** See «Flight».\\n## Results"
    >>> print(numbered(f"# [Re] A title\\n{text}"))
    # [Re] A title
    ## 1. Models
    ### 1.1 Flight
    **Figure 17.** See 1.1.
    ## 2. Results
    """
    is_supplement = text.startswith("# Supplement")
    is_replication = text.startswith("# [Re]")
    prefix = "S" if is_supplement else ""
    text, own = _with_numbered_headings(text, prefix)
    numbers = {**(sections or {}), **own}
    count = Counter(Figure=16, Table=1) if is_replication else Counter()
    for kind, name in _CAPTION.findall(text):
        count[kind] += 1
        numbers[name] = f"{prefix}{count[kind]}"
    return _REFERENCE.sub(lambda found: numbers[found[1]], text)


def _with_numbered_headings(text: str, prefix: str) -> tuple[str, dict[str, str]]:
    """The text with numbers in its headings, and the number of each heading."""
    numbers: dict[str, str] = {}
    section = 0
    subsection = 0

    def heading(found: re.Match[str]) -> str:
        nonlocal section, subsection
        level, name = found.groups()
        if level == "##":
            section += 1
            subsection = 0
            numbers[name] = f"{prefix}{section}"
            return f"{level} {numbers[name]}. {name}"
        subsection += 1
        numbers[name] = f"{prefix}{section}.{subsection}"
        return f"{level} {numbers[name]} {name}"

    return _HEADING.sub(heading, text), numbers


# Citations.

# A citation in the syntax of pandoc, and the place of the list of the works cited.
_CITATION = re.compile(r"\[@[^\]]+\]")
_LIST = '<div id="refs"></div>\n'


def pandoc(text: str, reader: str, writer: str, *options: str) -> str:
    """A text converted from one of pandoc's formats to another.

    Raises
    ------
    ModelError
        If pandoc fails or warns.
    """
    arguments = ["--wrap=none", "--fail-if-warnings", *options]
    try:
        return pypandoc.convert_text(text, writer, format=reader, extra_args=arguments)
    except RuntimeError as error:
        raise ModelError(f"pandoc: {' '.join(str(error).split())}") from None


def with_citations(markdown: str, *folders: str | Path) -> str:
    """The text with numbers in place of ``[@key; ...]``, and with the list of works at ``#refs``.

    Pandoc makes both from the ``references.yaml`` of all folders and the ``numbered.csl`` of the
    last one; the rest of the text is unchanged.

    Raises
    ------
    ModelError
        If a work is not among the references.
    """
    citations = _CITATION.findall(markdown)
    if not citations:
        return markdown
    options = [
        "--citeproc",
        *(f"--bibliography={folder}/references.yaml" for folder in folders),
        f"--csl={folders[-1]}/numbered.csl",
    ]
    bare = "\n\n".join([*citations, _LIST])
    paragraphs = pandoc(bare, "markdown-smart", "plain", *options).strip().split("\n\n")
    numbers = iter(paragraphs[: len(citations)])
    works = "\n".join(paragraphs[len(citations) :])
    return _CITATION.sub(lambda _: next(numbers), markdown).replace(_LIST, f"{works}\n")


# Markdown.

# The first signs of a line that is no prose: heading, table, quotation, formula, HTML, list, fence.
_NO_PROSE = re.compile(r"^(#|\||>|\$\$|<|- |\d+\. |```)", re.MULTILINE)
_PICTURE = re.compile(r"(!\[[^\n]*\n)?(.*)", re.DOTALL)
# The end of a sentence, but not of an initial, which has a full stop, nor of "Eq." and "Eqs.".
_SENTENCE_END = re.compile(r"(?<=[.!?:;])(?<![\s(*-][A-Z]\.)(?<!Eq\.)(?<!Eqs\.) (?=[A-Z$(*\[])")


def by_sentence(text: str) -> str:
    """The text with a line for each sentence of its paragraphs, whatever numbers were filled in.

    A change of a number then changes one line, in a comparison of two versions of the text. The
    parts of a sentence before a colon or a semicolon are lines of their own if a capital letter,
    a formula or a bracket follows.

    Examples
    --------
    >>> print(by_sentence("The error\\nis small. It\\nfalls (Eq. R3). A. Ball says so.\\n"))
    The error is small.
    It falls (Eq. R3).
    A. Ball says so.
    <BLANKLINE>
    """
    return "\n\n".join(_by_sentence(block) for block in text.split("\n\n"))


def _by_sentence(block: str) -> str:
    """One block of text between blank lines."""
    if _NO_PROSE.search(block):
        return block
    found = _PICTURE.fullmatch(block)
    assert found is not None
    picture, prose = found.groups("")
    end = "\n" if prose.endswith("\n") else ""
    return picture + _SENTENCE_END.sub("\n", " ".join(prose.split())) + end


def render_article(
    template: str | Path,
    data: Mapping[str, xr.Dataset],
    tables: Mapping[str, str],
    artifacts: Mapping[str, Artifact],
    *,
    about: Mapping[str, Any] | None = None,
    sections: Mapping[str, str] | None = None,
    shared: str | Path | None = None,
) -> str:
    """The text of a template with numbered sections, figures, tables and citations.

    Each sentence has a line. A template may include other templates of its folder, or of the folder
    ``shared``, whose references it can cite. Templates can use ``data``, ``tables`` and
    ``artifacts`` by name, the functions in :data:`FORMATS`, and with ``about`` what
    CITATION.cff says: authors, version, address. Citations have the syntax of pandoc, ``[@key]``;
    ``sections`` is that of :func:`numbered`.

    Raises
    ------
    ModelError
        If a work cited is not among the references.
    KeyError, jinja2.UndefinedError
        If a template uses any other name that does not exist.
    """
    folders = [Path(template).parent, *([Path(shared)] if shared else [])]
    environment = Environment(
        loader=FileSystemLoader(folders),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    known = {"data": data, "tables": tables, "artifacts": artifacts}
    if about is not None:
        known["about"] = about
    environment.globals.update(FORMATS, **known)
    text = environment.get_template(Path(template).name).render()
    with_formulas = by_sentence(numbered(text, sections)).replace("Λ_SD", r"$\Lambda_{SD}$")
    return with_citations(with_formulas, *folders)
