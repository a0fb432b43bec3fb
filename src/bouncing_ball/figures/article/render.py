"""The article and its supplement as Markdown, from templates, datasets, tables and references."""

from collections.abc import Mapping
from pathlib import Path

import xarray as xr
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from bouncing_ball.figures.article import numbers
from bouncing_ball.figures.article.claim_texts import Claims
from bouncing_ball.figures.article.numbering import numbered
from bouncing_ball.figures.article.pandoc import with_citations


def render_article(
    template: str | Path, data: Mapping[str, xr.Dataset], tables: Mapping[str, str]
) -> str:
    """The text of a template with numbered sections, figures, tables and citations.

    A template may include other templates of its folder. Templates can use ``data`` and ``tables``
    by name, ``claims``, and the number formats of :mod:`bouncing_ball.figures.article.numbers`.
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
        {name: getattr(numbers, name) for name in numbers.FORMATS},
        data=data,
        tables=tables,
        claims=Claims(data["claims"]),
    )
    text = environment.get_template(Path(template).name).render()
    typeset = numbered(text).replace("Λ_SD", r"$\Lambda_{SD}$")
    return with_citations(typeset, folder)
