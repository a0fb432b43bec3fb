"""The tables and the article from datasets, for tests to change."""

import functools
from pathlib import Path

import pytest
from jinja2 import BytecodeCache, Environment

from bouncing_ball_beyond.exhibits import contact_laws_figures, corrected_model_figures
from bouncing_ball_beyond.exhibits.artifacts import ARTIFACTS
from bouncing_ball_beyond.inherited.drawing.tables import to_csv, to_markdown
from bouncing_ball_beyond.inherited.pipeline import article
from bouncing_ball_beyond.inherited.pipeline.article import render_article
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

HOUSE = Path(__file__).resolve().parents[1]
REPORT = HOUSE / "report"
SHARED = REPORT / "shared"
OF_ARTICLE = ("ext_instant", "ext_orders", "ext_map", "ext_laws")
TABLES = {
    "ext_orders": corrected_model_figures.ext_orders,
    "ext_laws": contact_laws_figures.ext_laws,
}
# All texts cite the same works in the same order, for which pandoc runs once.
PANDOC = functools.cache(article.pandoc)


class Compiled(BytecodeCache):
    """The compiled templates, which are the same for all data."""

    def __init__(self):
        self.known = {}

    def load_bytecode(self, bucket):
        if (bucket.key, bucket.checksum) in self.known:
            bucket.bytecode_from_string(self.known[bucket.key, bucket.checksum])

    def dump_bytecode(self, bucket):
        self.known[bucket.key, bucket.checksum] = bucket.bytecode_to_string()


COMPILED = functools.partial(Environment, bytecode_cache=Compiled())


def all_texts(data):
    """The tables in all formats by name and format, and the article."""
    made = {}
    for name, table in TABLES.items():
        columns = table(data[name])
        made |= {(name, form.__name__): form(*columns) for form in (to_csv, to_markdown)}
    replicated = read_yaml(HOUSE / "config" / "replicated.yaml")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(article, "pandoc", PANDOC)
        patch.setattr(article, "Environment", COMPILED)
        made["article"] = render_article(
            REPORT / "article.md.j2",
            {**data, "replicated": replicated},
            {},
            ARTIFACTS,
            about=read_yaml(HOUSE / "CITATION.cff"),
            shared=SHARED,
        )
    return made


@pytest.fixture(scope="session")
def record(recorded):
    """The accepted datasets of which the article has numbers."""
    return {name: recorded[name] for name in OF_ARTICLE}


@pytest.fixture(scope="session")
def texts():
    """Makes the tables and the article from datasets by name."""
    return all_texts


@pytest.fixture(scope="session")
def accepted(record):
    """Those of the record."""
    return all_texts(record)
