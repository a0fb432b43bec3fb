"""The tables and the article of the paper from the accepted datasets, for tests to change."""

import functools
from pathlib import Path

import pytest
from bouncing_ball_beyond.inherited.paper.artifacts import ARTIFACTS
from bouncing_ball_beyond.inherited.paper.claims import claim_tables as rows
from bouncing_ball_beyond.inherited.paper.claims.claims import claims
from bouncing_ball_beyond.inherited.paper.exhibits import (
    continuation_of_orbits_figures,
    error_thresholds_figures,
)
from jinja2 import BytecodeCache, Environment

from bouncing_ball_beyond.inherited.drawing.tables import to_csv, to_markdown
from bouncing_ball_beyond.inherited.pipeline import article
from bouncing_ball_beyond.inherited.pipeline.article import render_article, sections_of
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[1]
TEMPLATES = ROOT / "workflow" / "report" / "paper"
OF_PAPER = dict(ARTIFACTS)
TABLES = {
    "table1": continuation_of_orbits_figures.table1,
    "thresholds": error_thresholds_figures.thresholds,
    "formulas": rows.formulas,
    "forensics": rows.forensics,
    "witness": rows.witness,
    "claims": rows.claims,
}
DERIVED = ("claims", "ext_verdicts")
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


# Those that were made, each with its dataset, so that no other one gets the same id.
KNOWN: dict = {}


def tables_of(table, data):
    """The table of a dataset in all formats, made once of a dataset that several texts share."""
    key = f"{table.__module__}:{table.__name__}", id(data)
    if key not in KNOWN:
        columns = table(data)
        KNOWN[key] = data, {form.__name__: form(*columns) for form in (to_csv, to_markdown)}
    return KNOWN[key][1]


def rendered(templates, data, tables, artifacts, shared=None):
    """The tables in all formats by name and format, and the texts of templates by name."""
    made = {
        (name, form): text
        for name, table in tables.items()
        for form, text in tables_of(table, data[name]).items()
    }
    texts = {name: made[name, "to_markdown"] for name in tables}
    about = read_yaml(ROOT / "CITATION.cff")
    decided = rows.Claims(data["claims"])
    sections = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(article, "pandoc", PANDOC)
        patch.setattr(article, "Environment", COMPILED)
        for name, file in templates.items():
            made[name] = render_article(
                file, data, texts, decided, artifacts, about=about, sections=sections, shared=shared
            )
            sections = sections_of(made[name])
    return made


def all_texts(data):
    """All tables of the paper in all formats, the article and its supplement.

    They are made from the artifacts of the paper alone, whatever else is given.
    """
    data = {name: data[name] for name in OF_PAPER if name in data}
    templates = {name: TEMPLATES / f"{name}.md.j2" for name in ("supplement", "article")}
    return rendered(templates, {**data, "claims": claims(data)}, TABLES, OF_PAPER)


@pytest.fixture(scope="session")
def record(recorded):
    """The accepted datasets that are computed, not read off others."""
    return {name: data for name, data in recorded.items() if name not in DERIVED}


@pytest.fixture(scope="session")
def texts():
    """Makes all tables in all formats, and the article, from datasets by name."""
    return all_texts


@pytest.fixture(scope="session")
def accepted(record):
    """Those of the record."""
    return all_texts(record)
