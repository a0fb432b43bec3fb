"""The tables and the article of what goes past the paper, from the accepted datasets."""

import pytest
from article_texts import ROOT, TEMPLATES, rendered
from bouncing_ball_beyond.exhibits.certified_verdicts import certified_verdicts

from bouncing_ball_beyond.exhibits import (
    certified_verdicts_figures,
    contact_laws_figures,
    corrected_model_figures,
    proofs_figures,
)
from bouncing_ball_beyond.exhibits.artifacts import ARTIFACTS

HOUSE = ROOT / "beyond"
REPORT = HOUSE / "report"
OF_ARTICLE = ("ext_instant", "ext_orders", "ext_map", "ext_laws")
READ = (*OF_ARTICLE, "ext_proofs", "claims")
TABLES = {
    "ext_orders": corrected_model_figures.ext_orders,
    "ext_laws": contact_laws_figures.ext_laws,
    "ext_proofs": proofs_figures.ext_proofs,
    "ext_verdicts": certified_verdicts_figures.ext_verdicts,
}


def texts_beyond(data):
    """The tables in all formats, and the article; the certified verdicts are derived."""
    data = {**data, "ext_verdicts": certified_verdicts(data)}
    templates = {"article": REPORT / "article.md.j2"}
    return rendered(templates, data, TABLES, ARTIFACTS, shared=TEMPLATES)


@pytest.fixture(scope="session")
def beyond_record(recorded):
    """The accepted datasets that go past the paper, and the ledger of claims."""
    return {name: recorded[name] for name in READ}


@pytest.fixture(scope="session")
def beyond_texts():
    """Makes the tables and the article from datasets by name."""
    return texts_beyond


@pytest.fixture(scope="session")
def beyond_accepted(beyond_record):
    """Those of the record."""
    return texts_beyond(beyond_record)
