"""No number is typed into the article where a dataset has it."""

import re
from pathlib import Path

import pytest
from beyond_texts import READ
from declared_artifacts import ARTIFACTS
from docutils.utils.math.latex2mathml import tex2mathml

from bouncing_ball.paper.claims.claims import CLAIMS
from bouncing_ball.pipeline.article import sections_of
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = (ROOT / "workflow" / "report" / "paper", ROOT / "beyond" / "report")
TEMPLATES = [path for folder in FOLDERS for path in sorted(folder.glob("*.md.j2"))]

JINJA = re.compile(r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}", re.DOTALL)
DISPLAY = re.compile(r"\$\$.*?\$\$", re.DOTALL)
INLINE = re.compile(r"\$[^$]+\$")
CITATION = re.compile(r"\[@[^\]]+\]")
CODE = re.compile(r"`[^`\n]*`")
SPAN = r"R?\d+(?:[-–]\d+)?"
NAMED = re.compile(rf"\b(?:Eq|Fig|Figure|Table|Eqs|Figs)s?\.? {SPAN}(?:(?:,| and|, and) {SPAN})*")
FAMILY = re.compile(r"\b\d-T\b")
HEADING = re.compile(r"^#+ .*$", re.MULTILINE)


def prose(text: str) -> str:
    """The text of a template without the parts that may hold a digit."""
    for pattern in (JINJA, DISPLAY, INLINE, CODE, CITATION, NAMED, FAMILY):
        text = pattern.sub(" ", text)
    return text


def mathematics(text: str) -> list[str]:
    text = JINJA.sub(" ", text)
    display = DISPLAY.findall(text)
    return [NAMED.sub(" ", part) for part in (*display, *INLINE.findall(DISPLAY.sub(" ", text)))]


def typed_numbers(text: str) -> list[str]:
    """Numbers in the prose, and numbers in formulas that no formula needs."""
    found = re.findall(r"\S*\d\S*", prose(text))
    for formula in mathematics(text):
        # Exponents and factors are single digits; numbers of equations are in \text.
        bare = re.sub(r"\\text\{[^}]*\}", " ", formula)
        found += re.findall(r"\d+\.\d+|\d{2,}|[5-9]", bare)
    return found


def literals(text: str) -> list[str]:
    """Decimal numbers written inside expressions, but for labels in quotes."""
    code = [re.sub(r"\"[^\"]*\"", " ", part) for part in JINJA.findall(text)]
    return [number for part in code for number in re.findall(r"\d+\.\d+|\d+e-?\d+", part)]


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_number_is_typed(template):
    text = template.read_text(encoding="utf-8")
    assert typed_numbers(text) == []
    assert literals(text) == []


def test_no_number_is_typed_into_an_explanation():
    for why in {claim.explanation for claim in CLAIMS} - {None}:
        assert typed_numbers(why.__doc__) == [], why


@pytest.fixture(scope="module")
def articles(accepted, beyond_accepted):
    """The texts by name."""
    texts = {name: accepted[name] for name in ("article", "supplement")}
    return texts | {"beyond": beyond_accepted["article"]}


@pytest.mark.parametrize("name", ["article", "supplement", "beyond"])
def test_the_site_can_typeset_every_formula(articles, name):
    # With an unknown command the site would not be built.
    formulas = [part.strip("$") for part in mathematics(articles[name])]
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


@pytest.mark.parametrize("name", ["article", "supplement", "beyond"])
def test_no_statement_rests_on_a_work_that_was_not_read(articles, name):
    """Such a work may be named where the text says that it was not read, or why it is named."""
    text, _, works = articles[name].partition("## References")
    unread = set(re.findall(r"^(\d+)\. .*\((?:Not read)[^)]*\)", works, re.MULTILINE))
    assert unread or name == "supplement"
    said = r"could not read|found (no|neither) text|because the paper refers to|nothing is said of"
    for sentence in text.splitlines():
        cited = {*re.findall(r"\d+", " ".join(re.findall(r"\[(\d[\d, ]*)\]", sentence)))}
        assert not cited & unread or re.search(said, sentence), sentence


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
    of_beyond = r"ext_|certifi|atlas|engine|contact law|Tsuji|Kuwabara|Hunt and Crossley|beyond/"
    (sentence,) = (line for line in texts.splitlines() if re.search(of_beyond, line))
    assert "(`beyond/`)" in sentence


def test_the_article_beyond_shows_all_figures_of_its_studies(beyond_accepted):
    shown = re.findall(
        r"^!\[[^]]*\]\(\.\./(figures/beyond/\w+)\.png\)", beyond_accepted["article"], re.M
    )
    drawn = [each.place for name in READ if (each := ARTIFACTS[name]).drawing]
    assert sorted(shown) == sorted(drawn)


def plain(text):
    """A text without the signs of formulas."""
    return " ".join(text.replace("$", "").replace(r"\varpi", "ϖ").split())


def test_each_article_has_a_file_with_its_title_keywords_and_abstract(articles):
    texts = {"metadata.yaml": articles["article"], "beyond/metadata.yaml": articles["beyond"]}
    for file, text in texts.items():
        about = read_yaml(ROOT / file)
        assert text.startswith(f"# {about['title']}\n")
        assert f"\nKeywords: {about['keywords']}.\n" in text
        abstract = text.partition("## Abstract\n")[2].partition("\n## 1. ")[0]
        assert plain(abstract) == about["abstract"]
        # One can read it without looking up what the numbers are.
        assert len({*re.findall(r"\d+(?:\.\d+)?", abstract)}) <= 7
    citation = read_yaml(ROOT / "CITATION.cff")
    assert citation["abstract"] == read_yaml(ROOT / "metadata.yaml")["abstract"]
    assert ", ".join(citation["keywords"]) == read_yaml(ROOT / "metadata.yaml")["keywords"]


def test_the_article_says_where_its_code_is(accepted):
    said = r"The code and all data, version (\S+) of (\S+), are in the repository (.*)\.\n"
    version, date, place = re.search(said, accepted["article"]).groups()
    about = read_yaml(ROOT / "CITATION.cff")
    assert version == about["version"] and date == str(about["date-released"])
    address = about.get("repository-code")
    assert place == (f"<{address}>" if address else "in which this file stands")
