"""The article as a PDF: Markdown by pandoc into Typst, which sets it.

Both come from the package registry, pandoc inside ``pypandoc_binary``, and are needed for
this only (the extra ``pdf``). The figures are embedded as vectors. The same text and
figures give the same bytes: no time, and no font of the machine.
"""

import re
from pathlib import Path
from typing import Any

from bouncing_ball.errors import ModelError

# A figure of the article: the picture, and its caption on the lines after it.
_FIGURE = re.compile(r"^!\[[^\]\n]*\]\((\S+)\.png\)\n((?:.+\n)+)", re.MULTILINE)
# A link to a file of the repository that is not among the results.
_OUTSIDE = re.compile(r"\]\((?!https?:|figures/|#)")
_TITLE = re.compile(r"\A# (.+)\n")
# GitHub's Markdown and formulas; quotes stay as they are.
_READER = "commonmark_x+implicit_figures-smart"

_STYLE = """\
#set document(title: [{title}], date: none)
#set page(paper: "a4", margin: (x: 2.1cm, y: 2.3cm), numbering: "1")
#set text(font: "Libertinus Serif", size: 10pt, lang: "en")
#set par(justify: true)
#set heading(numbering: none)
#show heading: set block(above: 1.4em, below: 0.8em)
#show raw: set text(size: 0.9em)
#show link: set text(fill: rgb("#00497a"))
#set table(stroke: none, inset: (x: 3pt, y: 2.5pt), align: left + top)
#show table: set text(size: 7pt)
#show table: set par(justify: false)
#show table: set align(left)
#show figure.where(kind: table): set block(breakable: true)
#set figure(supplement: none, numbering: none)
#show figure.caption: it => align(left, text(size: 9pt, it.body))
#let horizontalrule = line(length: 100%, stroke: 0.5pt)
#align(center, par(justify: false, text(size: 16pt, weight: "bold")[{title}]))
#v(1em)
"""


def for_pdf(markdown: str) -> str:
    """The text with vector figures, each caption a part of its figure, for results/paper.pdf.

    Examples
    --------
    >>> print(for_pdf("![Figure 1](figures/fig01.png)\\n**Figure 1.** A ball.\\n*More.*\\n"))
    ![**Figure 1.** A ball. *More.*](figures/fig01.svg)
    <BLANKLINE>
    """
    captioned = _FIGURE.sub(
        lambda found: f"![{' '.join(found[2].split())}]({found[1]}.svg)\n", markdown
    )
    return _OUTSIDE.sub("](../", captioned)


def to_typst(markdown: str) -> str:
    """The article as a Typst document.

    Raises
    ------
    ModelError
        If it has no title, or pandoc is not installed.
    """
    try:
        import pypandoc
    except ImportError:
        raise ModelError("the PDF needs the extra pdf: pip install 'bouncing-ball[pdf]'") from None
    title = _TITLE.match(markdown)
    if title is None:
        raise ModelError("the article does not begin with its title, '# …'")
    body, heading = (
        pypandoc.convert_text(text, "typst", format=_READER, extra_args=["--wrap=none"])
        for text in (for_pdf(markdown[title.end() :]), title[1])
    )
    return _STYLE.replace("{title}", heading.strip()) + body


def article_pdf(markdown: str, folder: str | Path) -> bytes:
    """The PDF of an article whose pictures are in a folder.

    Raises
    ------
    ModelError
        If it cannot be set, in one line, or the tools are not installed.
    """
    try:
        import typst
    except ImportError:
        raise ModelError("the PDF needs the extra pdf: pip install 'bouncing-ball[pdf]'") from None
    source = to_typst(markdown).encode()
    # Its types know a text and a folder of one kind only.
    compiler: Any = typst.compile
    try:
        return compiler(source, root=str(folder), ignore_system_fonts=True)
    except typst.TypstError as error:
        reason = str(error).splitlines()[0]
        raise ModelError(f"the article cannot be set: {reason}") from None
