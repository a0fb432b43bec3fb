"""No number is typed into the article where a dataset has it."""

import re
from pathlib import Path

import pytest
from article_checks import (
    DISPLAY,
    INLINE,
    check_metadata,
    literals,
    mathematics,
    statements_on_unread_works,
    typed_numbers,
)
from bouncing_ball_beyond.inherited.paper.claims.claims import CLAIMS
from docutils.utils.math.latex2mathml import tex2mathml

from bouncing_ball_beyond.inherited.pipeline.article import sections_of
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "workflow" / "report" / "paper"
TEMPLATES = sorted(FOLDER.glob("*.md.j2"))


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda path: path.name)
def test_no_number_is_typed(template):
    text = template.read_text(encoding="utf-8")
    assert typed_numbers(text) == []
    assert literals(text) == []


def test_no_number_is_typed_into_an_explanation():
    for why in {claim.explanation for claim in CLAIMS} - {None}:
        assert typed_numbers(why.__doc__) == [], why


@pytest.mark.parametrize("name", ["article", "supplement"])
def test_the_site_can_typeset_every_formula(accepted, name):
    # With an unknown command the site would not be built.
    formulas = [part.strip("$") for part in mathematics(accepted[name])]
    assert len(formulas) > 10
    for formula in formulas:
        assert tex2mathml(formula).startswith("<math"), formula


def test_the_article_refers_to_every_section_of_its_supplement(accepted):
    article = accepted["article"].partition("## References")[0]
    numbers = {*sections_of(accepted["supplement"]).values()}
    # A section that has subsections is referred to by these.
    ends = {one for one in numbers if not any(other.startswith(f"{one}.") for other in numbers)}
    referred = {*re.findall(r"\bSection (S\d+(?:\.\d+)?)", article)}
    assert referred <= numbers
    assert ends - referred == set()
    # Tables and figures stand in these sections, and no reference lacks its number.
    before, _, rest = accepted["supplement"].partition("\n## S1. ")
    assert rest and not re.search(r"\*\*(?:Table|Figure) S", before)
    assert not re.findall(r"[(: ]supplement\)", article)


def test_each_table_and_figure_of_the_supplement_is_named_once(accepted):
    captions = re.findall(r"^\*\*((?:Table|Figure) S\d+)[.,]", accepted["supplement"], re.MULTILINE)
    named = {*re.findall(r"\b(?:Table|Figure) S\d+", accepted["supplement"] + accepted["article"])}
    assert len({*captions}) == len(captions) and named == {*captions}


@pytest.mark.parametrize("name", ["article", "supplement"])
def test_no_statement_rests_on_a_work_that_was_not_read(accepted, name):
    assert statements_on_unread_works(accepted[name]) == []


def test_the_abstract_and_the_body_are_of_the_length_of_an_article(accepted):
    """Words of a letter or a digit, a formula being one, without figures, tables and references."""

    def words(text):
        return sum(bool(re.search(r"\w", word)) for word in INLINE.sub(" x ", text).split())

    text = DISPLAY.sub("", accepted["article"].partition("\n## References")[0])
    head, _, body = text.partition("\n## 1. ")
    prose = [part for part in body.split("\n\n") if not re.match(r"\||!\[|\*\*Table", part.strip())]
    assert words(head.partition("## Abstract")[2]) <= 200
    assert sum(map(words, prose)) <= 4500


def test_the_replication_has_nothing_of_what_goes_past_the_paper(accepted):
    """One sentence points to it."""
    texts = accepted["article"] + accepted["supplement"]
    of_beyond = r"\bext_|certifi|atlas|engine|contact law|Tsuji|Kuwabara|Hunt and Crossley|beyond/"
    (sentence,) = (line for line in texts.splitlines() if re.search(of_beyond, line))
    assert "(`beyond/`)" in sentence


def test_the_article_has_a_file_with_its_title_keywords_and_abstract(accepted):
    assert check_metadata(accepted["article"], ROOT / "metadata.yaml") <= 6
    about, citation = (read_yaml(ROOT / name) for name in ("metadata.yaml", "CITATION.cff"))
    assert citation["abstract"] == about["abstract"]
    assert ", ".join(citation["keywords"]) == about["keywords"]


def test_the_article_says_where_its_code_is(accepted):
    said = r"The code and all data, version (\S+) of (\S+), are in the repository (.*)\.\n"
    version, date, place = re.search(said, accepted["article"]).groups()
    about = read_yaml(ROOT / "CITATION.cff")
    assert version == about["version"] and date == str(about["date-released"])
    address = about.get("repository-code")
    assert place == (f"<{address}>" if address else "in which this file stands")
