"""No number is typed into the article where a dataset has it."""

import re
from pathlib import Path

import pytest
from docutils.utils.math.latex2mathml import tex2mathml

from bouncing_ball.paper.claims.claims import CLAIMS

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "workflow" / "report" / "paper"
TEMPLATES = sorted(FOLDER.glob("*.md.j2"))

JINJA = re.compile(r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}", re.DOTALL)
DISPLAY = re.compile(r"\$\$.*?\$\$", re.DOTALL)
INLINE = re.compile(r"\$[^$]+\$")
CITATION = re.compile(r"\[@[^\]]+\]")
CODE = re.compile(r"`[^`\n]*`")
SPAN = r"[RM]?\d+(?:[-–]\d+)?"
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


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda path: path.name)
def test_no_number_is_typed(template):
    text = template.read_text(encoding="utf-8")
    assert typed_numbers(text) == []
    assert literals(text) == []


def test_no_number_is_typed_into_an_explanation():
    for why in {claim.explanation for claim in CLAIMS} - {None}:
        assert typed_numbers(why.__doc__) == [], why


@pytest.mark.parametrize("name", ["article", "supplement", "motions"])
def test_the_site_can_typeset_every_formula(accepted, name):
    # With an unknown command the site would not be built.
    formulas = [part.strip("$") for part in mathematics(accepted[name])]
    assert len(formulas) > 10
    for formula in formulas:
        assert tex2mathml(formula).startswith("<math"), formula
