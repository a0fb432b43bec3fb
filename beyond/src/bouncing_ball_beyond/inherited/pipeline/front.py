"""The generated parts of README, and the links to accepted files.

README holds its generated parts between comments; the rest of it is written by hand. Everything is
read from the accepted datasets, so that ``make readme`` follows ``make accept``.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path

from bouncing_ball_beyond.inherited.datasets.artifact import Artifact

KINDS = {
    ".nc": "dataset",
    ".csv": "CSV",
    ".png": "PNG",
    ".svg": "SVG",
    ".md": "table",
    ".html": "page",
}
"""How a page names a file, by its suffix."""


def with_parts(page: str, parts: Mapping[str, str]) -> str:
    """The page with new texts between the comments ``<!-- name -->`` and ``<!-- end of name -->``.

    Raises
    ------
    KeyError
        If the page has no such comments.

    Examples
    --------
    >>> page = "One.\\n<!-- two -->\\nold\\n<!-- end of two -->\\nThree.\\n"
    >>> with_parts(page, {"two": "Two.\\n"}) == page.replace("old", "\\nTwo.\\n")
    True
    """
    for name, text in parts.items():
        begin = f"<!-- {name} -->\n"
        end = f"<!-- end of {name} -->\n"
        before, found, rest = page.partition(begin)
        _, also_found, after = rest.partition(end)
        if not (found and also_found):
            raise KeyError(name)
        page = f"{before}{begin}\n{text}\n{end}{after}"
    return page


def links(folder: Path, artifact: Artifact) -> str:
    """Links to the accepted files of an artifact, from the page of their folder."""
    return ", ".join(
        f"[{kind}]({artifact.name}{suffix})"
        for suffix, kind in KINDS.items()
        if (folder / f"{artifact.name}{suffix}").exists()
    )


_IN_A_ROW = 4


def thumbnails(artifacts: Iterable[Artifact]) -> str:
    """A table of small pictures with their names below; a forge links each to the whole."""
    shown = [each for each in artifacts if each.name.startswith("fig")]
    names = [each.name.replace("fig", "Fig. ").replace(". 0", ". ") for each in shown]
    pictures = [f'<img src="{each.place}.png" alt="{each.title}" width="200">' for each in shown]
    lines = []
    for first in range(0, len(shown), _IN_A_ROW):
        row = slice(first, first + _IN_A_ROW)
        lines += [pictures[row], names[row]]
    lines.insert(1, ["---"] * _IN_A_ROW)
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)
