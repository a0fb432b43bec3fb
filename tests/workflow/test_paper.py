"""The article of a complete run: figures, verdicts and numbers follow the data."""

import re
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.paper.claims.verdict import Verdict


@pytest.fixture(scope="module")
def texts(pristine):
    names = ("paper.md", "supplement.md")
    return [(pristine.path / "results" / name).read_text(encoding="utf-8") for name in names]


def test_the_sections_are_numbered_without_gaps(texts):
    sections = re.findall(r"^## (\d+)\. ", texts[0], re.MULTILINE)
    assert list(map(int, sections)) == list(range(1, len(sections) + 1))


def test_the_article_shows_every_figure_and_table_of_the_paper(texts, pristine):
    text = "".join(texts).replace(r"$\Lambda_{SD}$", "Λ_SD")
    shown = re.findall(r"!\[[^]]*\]\((figures/[^)]*)\)", text)
    results = pristine.path / "results"
    figures = sorted(str(path.relative_to(results)) for path in results.glob("figures/*.png"))
    assert sorted(shown) == figures
    for name in ("table1", "thresholds", "witness", "formulas", "claims"):
        page = (pristine.path / "results" / "figures" / f"{name}.md").read_text(encoding="utf-8")
        rows = [line for line in page.splitlines(keepends=True) if line.startswith("|")]
        # The article has titles for the quantities of the thresholds.
        assert rows and all(row.split("|", 2 * (name == "thresholds"))[-1] in text for row in rows)


def test_the_page_of_claims_explains_its_columns_before_them(pristine):
    page = (pristine.path / "results/figures/claims.md").read_text(encoding="utf-8")
    words, _, header = page.partition("\n| ")
    assert words.startswith("# ") and "](../supplement.md)" in words
    columns = [name.strip() for name in header.partition("\n")[0].strip("|").split(" | ")]
    for said in (*columns, *map(str, Verdict)):
        assert f"**{said}**" in words or f"*{said}*" in words, said


def test_the_supplement_has_every_claim_once_with_its_verdict(texts, pristine):
    claims = read_dataset(pristine.path / "results/figures/claims.nc")
    for name, verdict in zip(claims.claim.values, claims.verdict.values, strict=True):
        # Other tables have rows of this name, too, and no verdict in them.
        rows = [line for line in texts[1].splitlines() if line.startswith(f"| {name} |")]
        assert [row.endswith(f"| {verdict} |") for row in rows].count(True) == 1


def test_every_open_claim_has_an_explanation_that_holds(pristine):
    claims = read_dataset(pristine.path / "results/figures/claims.nc")
    open_claims = np.isin(claims.verdict.values, [Verdict.DIFFERS, Verdict.CONTRADICTED])
    needed = set(claims.explained_by.values[open_claims])
    assert "" not in needed
    holds = dict(zip(claims.explanation.values, claims.explanation_holds.values, strict=True))
    assert all(holds[name] for name in needed)


def test_a_run_gives_the_tally_of_the_readme(pristine):
    said = tally(read_dataset(pristine.path / "results/figures/claims.nc"))
    assert said in Path(pristine.path, "results/logs/set_claims.log").read_text(encoding="utf-8")
    assert said in Path(pristine.path, "README.md").read_text(encoding="utf-8")
