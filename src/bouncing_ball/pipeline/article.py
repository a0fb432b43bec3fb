"""The article and its supplement: templates and datasets to Markdown, and Markdown to PDF.

A template takes every number from a dataset, in the formats of this module. Sections, figures and
tables are numbered, and pandoc (part of ``pypandoc_binary``) resolves the citations. For the PDF
pandoc converts Markdown to Typst, and Typst (the extra ``pdf``) sets the pages with the figures as
vector graphics. The same text and figures give the same bytes, because the file contains neither a
time nor fonts of the machine.
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

from bouncing_ball.errors import ModelError

FORMATS = ("decimal", "listed", "pairs", "percent", "short")
"""The functions of this module that templates can call."""

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
    return _typeset(f"{round(float(value), digits) + 0.0:.{digits}f}")


def short(value: float, digits: int = 6) -> str:
    """A parameter without trailing zeros; small and large values have a power of ten.

    Examples
    --------
    >>> short(0.85), short(10000.0), short(2.5e-13, 2), short(99.7, 2)
    ('0.85', '10⁴', '2.5·10⁻¹³', '100')
    """
    value = float(value)
    if not (0 < abs(value) < 1e-3 or 1e4 <= abs(value) < math.inf):
        return _typeset(f"{float(f'{value:.{digits}g}'):.15g}")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    factor = f"{float(mantissa):g}"
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    return power if factor == "1" else _typeset(f"{factor}·{power}")


def percent(share: float, digits: int = 3) -> str:
    """A share in per cent.

    Examples
    --------
    >>> percent(0.01), percent(0.0279, 2)
    ('1 %', '2.8 %')
    """
    # A share of a sample may lie halfway between two texts; rounding errors must not decide there.
    return f"{short(100 * float(share) * (1 + 1e-9), digits)} %"


def listed(values, word: str = "and") -> str:
    """Texts or numbers as a list in a sentence.

    Examples
    --------
    >>> listed([0.7, 1.0, 1.2])
    '0.7, 1 and 1.2'
    """
    texts = [value if isinstance(value, str) else short(value) for value in values]
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} {word} {texts[-1]}"


def pairs(left: Iterable[float], right: Iterable[float]) -> list[str]:
    """Pairs of parameters in brackets.

    Examples
    --------
    >>> pairs([0.85, 0.65], [1.0, 1.2])
    ['(0.85, 1)', '(0.65, 1.2)']
    """
    return [f"({short(a)}, {short(b)})" for a, b in zip(left, right, strict=True)]


_HEADING = re.compile(r"^(##+) (?!Abstract|References)(.+)$", re.MULTILINE)
# The first words of a caption, and a reference from anywhere.
_CAPTION = re.compile(r"\*\*(Figure|Table) «(\w+)»")
_REFERENCE = re.compile(r"«([^»\n]+)»")


def numbered(text: str) -> str:
    """The text with numbers in its headings and in place of the references ``«name»``.

    The name of a section is its heading. Figures and tables are numbered in the order of their
    captions, ``**Figure «name»`` and ``**Table «name»``. The numbers follow those of the 16 figures
    and the table of the paper; in a supplement they begin with S1.

    Raises
    ------
    KeyError
        If no section, figure or table has the name of a reference.

    Examples
    --------
    >>> print(numbered("## Models\\n### Flight\\n**Figure «ball».** See «Flight».\\n## Results"))
    ## 1. Models
    ### 1.1 Flight
    **Figure 17.** See 1.1.
    ## 2. Results
    """
    numbers: dict[str, str] = {}
    section = part = 0

    def heading(found: re.Match[str]) -> str:
        nonlocal section, part
        section, part = (section + 1, 0) if found[1] == "##" else (section, part + 1)
        numbers[found[2]] = f"{prefix}{section}.{part}" if part else f"{prefix}{section}"
        return f"{found[1]} {numbers[found[2]]}{'' if part else '.'} {found[2]}"

    prefix = "S" if text.startswith("# Supplement") else ""
    text = _HEADING.sub(heading, text)
    count = Counter() if prefix else Counter(Figure=16, Table=1)
    for kind, name in _CAPTION.findall(text):
        count[kind] += 1
        numbers[name] = f"{prefix}{count[kind]}"
    return _REFERENCE.sub(lambda found: numbers[found[1]], text)


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
    options = "--wrap=none", "--fail-if-warnings", *options
    try:
        return pypandoc.convert_text(text, writer, format=reader, extra_args=options)
    except RuntimeError as error:
        raise ModelError(f"pandoc: {' '.join(str(error).split())}") from None


def with_citations(markdown: str, folder: str | Path) -> str:
    """The text with numbers in place of ``[@key; ...]``, and with the list of works at ``#refs``.

    Pandoc makes both from ``references.yaml`` and ``numbered.csl`` in the folder; the rest of the
    text is unchanged.

    Raises
    ------
    ModelError
        If a work is not among the references.
    """
    citations = _CITATION.findall(markdown)
    if not citations:
        return markdown
    files = (f"--bibliography={folder}/references.yaml", f"--csl={folder}/numbered.csl")
    bare = "\n\n".join([*citations, _LIST])
    paragraphs = pandoc(bare, "markdown-smart", "plain", "--citeproc", *files).strip().split("\n\n")
    numbers, works = iter(paragraphs), "\n".join(paragraphs[len(citations) :])
    return _CITATION.sub(lambda _: next(numbers), markdown).replace(_LIST, f"{works}\n")


def render_article(
    template: str | Path,
    data: Mapping[str, xr.Dataset],
    tables: Mapping[str, str],
    claims: Any,
) -> str:
    """The text of a template with numbered sections, figures, tables and citations.

    A template may include other templates of its folder. Templates can use ``data`` and ``tables``
    by name, ``claims``, and the functions in :data:`FORMATS`.
    Citations have the syntax of pandoc, ``[@key]``.

    Raises
    ------
    ModelError
        If a reference does not exist.
    KeyError, jinja2.UndefinedError
        If a template uses any other name that does not exist.
    """
    folder = Path(template).parent
    environment = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )

    environment.globals.update(
        {name: globals()[name] for name in FORMATS},
        data=data,
        tables=tables,
        claims=claims,
    )
    text = environment.get_template(Path(template).name).render()
    typeset = numbered(text).replace("Λ_SD", r"$\Lambda_{SD}$")
    return with_citations(typeset, folder)


# A figure of the article: the picture, and the caption on the lines after the picture.
_FIGURE = re.compile(r"^!\[[^\]\n]*\]\((\S+)\.png\)\n((?:.+\n)+)", re.MULTILINE)
# The caption of a table is the paragraph before the table.
_TABLE = re.compile(r"^(\*\*Table (?:.+\n)+)(?=\n\|)", re.MULTILINE)
_STICKY = "```{=typst}\n#block(sticky: true)[\n```\n\n\\1\n```{=typst}\n]\n```\n"
# A link to a file of the repository that is not among the results.
_OUTSIDE = re.compile(r"\]\((?!https?:|figures/|#)")
# GitHub's Markdown with formulas; straight quotes are not changed.
_READER = "commonmark_x+implicit_figures-smart"


def for_pdf(markdown: str) -> str:
    r"""The text with vector figures, each with its caption, and with tables beside their captions.

    Links to files of the repository are relative to ``results``, the folder of the PDF.

    Examples
    --------
    >>> print(for_pdf("![Figure 1](figures/fig01.png)\n**Figure 1.** A ball.\n*More.*\n"))
    ![**Figure 1.** A ball. *More.*](figures/fig01.svg)
    <BLANKLINE>
    """
    captioned = _FIGURE.sub(
        lambda found: f"![{' '.join(found[2].split())}]({found[1]}.svg)\n", markdown
    )
    return _OUTSIDE.sub("](../", _TABLE.sub(_STICKY, captioned))


def article_pdf(markdown: str, template: str | Path, folder: str | Path) -> bytes:
    """The PDF of an article, set with a Typst template of pandoc and the pictures in a folder.

    Raises
    ------
    ModelError
        If the article cannot be set or the tools are not installed.
    """
    try:
        import typst
    except ImportError:
        raise ModelError("Typst is missing: pip install 'bouncing-ball[pdf]'") from None
    # The heading of the first level is the title.
    options = ["--standalone", f"--template={template}", "--shift-heading-level-by=-1"]
    source = pandoc(for_pdf(markdown), _READER, "typst", *options).encode()
    # The type hints of Typst require a text and a folder of the same type.
    compiler: Any = typst.compile
    try:
        return compiler(source, root=str(folder), ignore_system_fonts=True)
    except typst.TypstError as error:
        reason = str(error).splitlines()[0]
        raise ModelError(f"the article cannot be set: {reason}") from None
