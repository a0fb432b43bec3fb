"""Templates of texts and pages, with the filters that print numbers."""

from functools import cache
from pathlib import Path

import jinja2

from paper_replication import origins
from paper_replication.texts import fixed, listed, percent, share_text, short


@cache
def environment(templates: Path, marked: bool = False) -> jinja2.Environment:
    """Return the Jinja environment of a folder of templates and of those of any paper, with the
    filters for numbers.

    If `marked`, it marks what the expressions print (see `origins`).
    """
    jinja = jinja2.Environment(
        loader=jinja2.FileSystemLoader([templates, Path(__file__).parent], encoding="utf-8"),
        undefined=jinja2.StrictUndefined,
        autoescape=jinja2.select_autoescape(["html.j2"], default=False),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        extensions=[origins.Marks] if marked else [],
    )
    jinja.filters.update(fixed=fixed, percent=percent, share=share_text, short=short)
    jinja.filters.update(listed=listed, zip=zip, mark=origins.mark)
    return jinja
