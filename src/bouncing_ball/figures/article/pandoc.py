"""Conversions by pandoc, which handles citations and Typst and is part of ``pypandoc_binary``."""

import re
from pathlib import Path

import pypandoc

from bouncing_ball.errors import ModelError

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
