"""The article as a PDF: pandoc converts Markdown to Typst, and Typst sets the pages.

Only the PDF needs Typst (the extra ``pdf``). The figures are embedded as vector graphics. The same
text and figures give the same bytes, because the file contains neither a time nor fonts of the
machine.
"""

import re
from pathlib import Path
from typing import Any

from bouncing_ball.errors import ModelError
from bouncing_ball.figures.article.pandoc import pandoc

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
