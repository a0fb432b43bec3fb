"""The article as Markdown, from templates, datasets, tables and references."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from bouncing_ball.errors import ModelError
from bouncing_ball.figures.article.citations import Citations
from bouncing_ball.figures.article.claim_texts import Claims
from bouncing_ball.figures.article.numbers import (
    decimal,
    distinct,
    largest,
    listed,
    pairs,
    percent,
    short,
    value_at,
)


def versions(dataset: xr.Dataset) -> dict[str, str]:
    """What a dataset says of the versions that made it; nothing if it does not."""
    return json.loads(dataset.attrs.get("provenance_versions", "{}"))


def render_article(
    folder: str | Path,
    data: Mapping[str, xr.Dataset],
    tables: Mapping[str, str],
    references: Mapping[str, Mapping[str, Any]],
) -> str:
    """The text of ``article.md.j2`` in a folder.

    Templates know ``data`` and ``tables`` by name, ``claims``, ``cite`` and
    ``references``, and the number formats of :mod:`bouncing_ball.figures.article.numbers`.

    Raises
    ------
    ModelError
        If a place of a dataset, a claim, an explanation or a reference is not
        there, or if a reference is never cited.
    jinja2.UndefinedError
        If a template names anything else that is not there.
    """
    environment = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    citations = Citations(references)

    def at(dataset: str, variable: str, digits: int | None = None, **where: Any) -> str:
        """One number of a dataset as text, with so many decimals."""
        value = value_at(data, dataset, variable, **where)
        return short(value) if digits is None else decimal(value, digits)

    environment.globals.update(
        data=data,
        tables=tables,
        claims=Claims(data["claims"]),
        at=at,
        cite=citations.cite,
        references=citations.listing,
        decimal=decimal,
        distinct=distinct,
        largest=largest,
        listed=listed,
        pairs=pairs,
        percent=percent,
        short=short,
        versions=versions,
    )
    text = environment.get_template("article.md.j2").render()
    if citations.uncited():
        raise ModelError(f"references never cited: {', '.join(citations.uncited())}")
    return text
