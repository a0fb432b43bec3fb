"""The article on what goes past the paper: its numbers, figures, formulas and works."""

import re

import pytest
from article_checks import (
    check_metadata,
    literals,
    mathematics,
    moved,
    statements_on_unread_works,
    typed_numbers,
    works_of,
)
from article_texts import ARTIFACTS, OF_ARTICLE, REPORT, SHARED
from docutils.utils.math.latex2mathml import tex2mathml

TEMPLATES = sorted(REPORT.glob("*.md.j2"))


@pytest.fixture(scope="module")
def article(accepted):
    return accepted["article"]


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda path: path.name)
def test_no_number_is_typed(template):
    text = template.read_text(encoding="utf-8")
    assert typed_numbers(text) == []
    assert literals(text) == []


def test_every_formula_can_be_typeset(article):
    formulas = [part.strip("$") for part in mathematics(article)]
    assert len(formulas) > 10
    for formula in formulas:
        assert tex2mathml(formula).startswith("<math"), formula


def test_it_adds_its_works_to_those_of_the_replication(article):
    cited, known = works_of(REPORT)
    _, shared = works_of(SHARED)
    assert known == cited - shared
    assert statements_on_unread_works(article) == []


def test_it_shows_all_figures_of_its_studies(article):
    picture = r"^!\[[^]]*\]\((figures/\w+)\.png\)"
    shown = re.findall(picture, article, re.MULTILINE)
    assert sorted(shown) == sorted(ARTIFACTS[name].place for name in OF_ARTICLE)


def test_pages_show_the_other_figures():
    pages = "".join(page.read_text("utf-8") for page in (REPORT.parent / "docs").glob("*.md"))
    other = [one.place for name, one in ARTIFACTS.items() if one.drawing and name not in OF_ARTICLE]
    assert other
    assert [place for place in other if f"(../{place}.png)" not in pages] == []


def test_it_has_a_file_with_its_title_keywords_and_abstract(article):
    assert check_metadata(article, REPORT.parent / "metadata.yaml") <= 6


def test_it_is_short(article):
    assert len(article.split()) <= 4500


def test_rounding_changes_no_text(record, texts, accepted):
    assert moved(texts, record, accepted) == []
