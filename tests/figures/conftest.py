"""All texts that are read from the accepted datasets, for tests to change."""

from pathlib import Path

import pytest

from bouncing_ball.claims.ledger import ledger
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.figures.article.render import render_article
from bouncing_ball.figures.atlas.tables import shares
from bouncing_ball.figures.tables import rows
from bouncing_ball.figures.tables.formats import to_csv, to_markdown

ROOT = Path(__file__).resolve().parents[2]
TEMPLATES = ROOT / "workflow" / "report" / "paper"
TABLES = sorted(path.stem for path in (ROOT / "figures").glob("*.csv"))
DERIVED = ("claims",)


@pytest.fixture(scope="session")
def record(recorded):
    """The accepted datasets that are computed, not read off others."""
    return {name: data for name, data in recorded.items() if name not in DERIVED}


def all_texts(data):
    """All tables in all formats, the article and its supplement."""
    data = {**data, "claims": ledger(data)}
    made = {}
    for name in TABLES:
        table = getattr(rows, name)(data[name])
        for form in (to_csv, to_markdown):
            made[name, form.__name__] = form(*table)
    texts = {name: made[name, "to_markdown"] for name in TABLES}
    data["atlas"] = read_dataset(ROOT / "config" / "atlas.nc")
    texts["atlas"] = to_markdown(*shares(data["atlas"]))
    for name in ("article", "supplement"):
        made[name] = render_article(TEMPLATES / f"{name}.md.j2", data, texts)
    return made


@pytest.fixture(scope="session")
def texts():
    """Makes all tables in all formats, and the article, from datasets by name."""
    return all_texts


@pytest.fixture(scope="session")
def accepted(record):
    """Those of the record."""
    return all_texts(record)
