"""The article of a complete run: figures, verdicts and numbers follow the data."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.claims.verdict import Verdict
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.figures.article.render import render_article
from bouncing_ball.figures.atlas.tables import shares
from bouncing_ball.figures.tables.error_law import law_table
from bouncing_ball.figures.tables.formats import to_markdown


@pytest.fixture(scope="module")
def run(pristine):
    """Folder of templates, datasets and tables of a complete run."""
    folder = pristine.path / "workflow" / "report" / "paper"
    results = pristine.path / "results" / "figures"
    data = {path.stem: read_dataset(path) for path in sorted(results.glob("*.nc"))}
    tables = {path.stem: path.read_text(encoding="utf-8") for path in results.glob("*.md")}
    summary = pristine.path / "config" / "error_law.csv"
    tables["error_law"] = law_table(summary.read_text(encoding="utf-8"))
    data["atlas"] = read_dataset(pristine.path / "config" / "atlas.nc")
    tables["atlas"] = to_markdown(*shares(data["atlas"]))
    return folder, data, tables


@pytest.fixture(scope="module")
def text(pristine):
    return (pristine.path / "results" / "paper.md").read_text(encoding="utf-8")


def test_the_parts_of_an_article_are_there(text):
    headings = re.findall(r"^## (.*)$", text, re.MULTILINE)
    assert headings == [
        "Abstract",
        "Introduction",
        "Methods",
        "Results, figure by figure",
        "What did not reproduce, and why",
        "Beyond the paper",
        "Discussion",
        "Conclusion",
        "Reproducibility",
        "References",
        "Supplement: the ledger of claims",
    ]


def test_every_figure_and_table_is_shown(text, pristine):
    shown = re.findall(r"!\[[^]]*\]\((figures/[^)]*)\)", text)
    figures = sorted(
        f"figures/{path.name}" for path in (pristine.path / "results/figures").glob("*.png")
    )
    assert sorted(shown) == figures
    for name in ("table1", "thresholds", "witness", "formulas", "claims"):
        table = (pristine.path / "results" / "figures" / f"{name}.md").read_text(encoding="utf-8")
        assert table in text


def test_every_claim_stands_with_its_verdict(text, run):
    claims = run[1]["claims"]
    text = text[text.index("## Supplement") :]
    for name, verdict in zip(claims.claim.values, claims.verdict.values, strict=True):
        rows = [line for line in text.splitlines() if line.startswith(f"| {name} |")]
        assert len(rows) == 1 and rows[0].endswith(f"| {verdict} |")


def test_verdicts_follow_the_data(run):
    folder, data, tables = run
    changed = data["claims"].copy(deep=True)
    changed["verdict"].values[:] = str(Verdict.UNDECIDABLE)
    changed["reason"].values[:] = "for the test"
    text = render_article(folder, data | {"claims": changed}, {k: "" for k in tables})
    bullets = re.findall(r"\*\*(\w+)\*\*; ", text)
    assert len(bullets) > 20 and set(bullets) == {str(Verdict.UNDECIDABLE)}
    # In prose the other verdicts are defined or counted, and their count is 0.
    words = " ".join(text.split())
    assert "0 are reproduced, 0 are close, 0 are contradicted" in words
    assert not re.search(r"\((?:close|contradicted)\)", text)
    # In the abstract and in the conclusion.
    assert words.count("depends on the quantity for which the limit is meant") == 2


def test_numbers_follow_the_data(run, text):
    folder, data, tables = run
    changed = data["fig16"].copy(deep=True)
    changed["error_threshold"].values[:] = 77.77
    other = render_article(folder, data | {"fig16": changed}, tables)
    assert "77.77" in other and "77.77" not in text


def test_a_run_with_other_parameters_says_so(run):
    folder, data, tables = run
    changed = data["claims"].copy(deep=True)
    reason = "fig14 was computed with n = 2; the claim requires 1"
    at = np.flatnonzero(changed.claim.values == "height threshold")
    changed["reason"] = changed.reason.astype(object)
    changed["reason"].values[at] = reason
    changed["verdict"] = changed.verdict.astype(object)
    changed["verdict"].values[at] = "not asked"
    text = render_article(folder, data | {"claims": changed}, tables)
    assert text.index(reason) < text.index("## Abstract")


def test_the_explanations_that_are_needed_hold(run):
    claims = run[1]["claims"]
    open_claims = claims.verdict.values != str(Verdict.REPRODUCED)
    needed = set(claims.explained_by.values[open_claims])
    assert "" not in needed
    holds = dict(zip(claims.explanation.values, claims.explanation_holds.values, strict=True))
    assert all(holds[name] for name in needed)


def test_the_run_ends_with_the_tally(pristine):
    tally = Path(pristine.path, "results", "tally.txt").read_text(encoding="utf-8")
    assert tally.startswith("16 figures, Table 1, ")
    resumed = json.loads(pristine.path.with_name("resumed.json").read_text(encoding="utf-8"))
    assert tally in resumed["last"]


def test_the_readme_gives_the_tally_of_this_run(pristine):
    tally = Path(pristine.path, "results", "tally.txt").read_text(encoding="utf-8")
    assert tally in Path(pristine.path, "README.md").read_text(encoding="utf-8")
