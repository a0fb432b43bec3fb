"""All texts that are read from the accepted datasets, for tests to change."""

import functools
from pathlib import Path

import pytest
from bouncing_ball.beyond.atlas.figures import shares
from bouncing_ball.beyond.exhibits import (
    certified_verdicts_figures,
    contact_laws_figures,
    corrected_model_figures,
    engine_steps_figures,
    measured_impacts_figures,
    proofs_figures,
)
from bouncing_ball.beyond.exhibits.certified_verdicts import certified_verdicts
from declared_artifacts import ARTIFACTS
from jinja2 import BytecodeCache, Environment

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.drawing.tables import to_csv, to_markdown
from bouncing_ball.paper.claims import tables as rows
from bouncing_ball.paper.claims.claims import claims
from bouncing_ball.paper.exhibits import continuation_of_orbits_figures, error_thresholds_figures
from bouncing_ball.pipeline import article
from bouncing_ball.pipeline.article import render_article, sections_of
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[1]
TEMPLATES = ROOT / "workflow" / "report" / "paper"
TABLES = {
    "table1": continuation_of_orbits_figures.table1,
    "thresholds": error_thresholds_figures.thresholds,
    "ext_orders": corrected_model_figures.ext_orders,
    "ext_laws": contact_laws_figures.ext_laws,
    "ext_measured": measured_impacts_figures.ext_measured,
    "ext_shaker": measured_impacts_figures.ext_shaker,
    "ext_engines": engine_steps_figures.ext_engines,
    "ext_proofs": proofs_figures.ext_proofs,
    "ext_verdicts": certified_verdicts_figures.ext_verdicts,
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


@pytest.fixture(scope="session")
def record(recorded):
    """The accepted datasets that are computed, not read off others."""
    return {name: data for name, data in recorded.items() if name not in DERIVED}


# Those that were made, each with its dataset, so that no other one gets the same id.
KNOWN: dict = {}


def tables_of(name, data):
    """The table of a dataset in all formats, made once of a dataset that several texts share."""
    if (name, id(data)) not in KNOWN:
        table = TABLES[name](data)
        made = {form.__name__: form(*table) for form in (to_csv, to_markdown)}
        KNOWN[name, id(data)] = data, made
    return KNOWN[name, id(data)][1]


def all_texts(data, verdicts=None):
    """All tables in all formats, the articles and the supplement.

    ``verdicts`` are those by certified intervals; by default they are computed.
    """
    data = {**data, "claims": claims(data)}
    data["ext_verdicts"] = certified_verdicts(data) if verdicts is None else verdicts
    made = {
        (name, form): text for name in TABLES for form, text in tables_of(name, data[name]).items()
    }
    texts = {name: made[name, "to_markdown"] for name in TABLES}
    other = [path for path in (ROOT / "config").glob("*.nc") if path.stem not in data]
    data |= {path.stem: read_dataset(path) for path in other}
    texts["atlas"] = to_markdown(*shares(data["atlas"]))
    about = read_yaml(ROOT / "CITATION.cff")
    decided = rows.Claims(data["claims"])
    sections = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(article, "pandoc", PANDOC)
        patch.setattr(article, "Environment", COMPILED)
        for name in ("supplement", "article", "motions"):
            file = TEMPLATES / f"{name}.md.j2"
            made[name] = render_article(
                file, data, texts, decided, ARTIFACTS, about=about, sections=sections
            )
            sections = sections or sections_of(made[name])
    return made


@pytest.fixture(scope="session")
def texts():
    """Makes all tables in all formats, and the articles, from datasets by name."""
    return all_texts


@pytest.fixture(scope="session")
def accepted(record):
    """Those of the record."""
    return all_texts(record)
