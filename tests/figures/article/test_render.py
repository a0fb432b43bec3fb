"""The article from small templates and datasets."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from bouncing_ball.errors import ModelError
from bouncing_ball.figures.article.citations import READ, Citations
from bouncing_ball.figures.article.claim_texts import Claims
from bouncing_ball.figures.article.numbers import value_at
from bouncing_ball.figures.article.places import places
from bouncing_ball.figures.article.render import render_article

ROOT = Path(__file__).resolve().parents[3]
REFERENCES = yaml.safe_load(
    (ROOT / "workflow" / "report" / "paper" / "references.yaml").read_text(encoding="utf-8")
)


def claims(**changes):
    """Two claims, one reproduced and one contradicted and explained."""
    columns = {
        "kind": ["number", "number"],
        "group": ["number", "number"],
        "restates": ["", ""],
        "item": ["Fig. 14", "Eq. 38, Fig. 16"],
        "condition": ["", ""],
        "legibility": ["clear", "clear"],
        "printed_table": ["", ""],
        "statement": ["heights differ", "thresholds differ"],
        "printed_text": ["82", "6"],
        "required": ["82", "6"],
        "verdict": ["reproduced", "contradicted"],
        "reason": ["", ""],
        "explained_by": ["", "by Eq. 34"],
        "found": [82.177, 9.8118],
        "limit": [np.nan, np.nan],
        "deviation_units": [0.177, 3.81],
        "deviation": [0.0022, 0.635],
    } | changes
    return xr.Dataset(
        {
            **{key: ("claim", values) for key, values in columns.items()},
            "explanation_text": ("explanation", ["Eq. 34 gives the same."]),
            "explanation_holds": ("explanation", [True]),
            "explanation_checks": ("explanation", ["x = 1 ≤ 2"]),
        },
        {"claim": ["heights", "contact"], "explanation": ["by Eq. 34"]},
    )


@pytest.fixture
def render(tmp_path):
    def run(template, references=None, **data):
        (tmp_path / "article.md.j2").write_text(template, encoding="utf-8")
        return render_article(tmp_path, {"claims": claims()} | data, {}, references or {})

    return run


def test_numbers_come_from_the_datasets(render):
    data = xr.Dataset({"x": ("n", [1.0, 9.8118])}, {"n": [1, 2]})
    assert render('{{ at("t", "x", 2, n=2) }}', t=data) == "9.81"
    data["x"] = data.x + 1
    assert render('{{ at("t", "x", 2, n=2) }}', t=data) == "10.81"


def test_verdicts_come_from_the_claims(render):
    text = '{{ claims("contact").verdict }} {{ claims.count("reproduced") }}/{{ claims.count() }}'
    assert render(text) == "contradicted 1/2"
    assert render(text, claims=claims(verdict=["close", "close"])) == "close 0/2"


@pytest.mark.parametrize(
    ("template", "message"),
    [
        ('{{ at("t", "x", 2, n=7) }}', "t: x: n = 7 is not among 1, 2"),
        ('{{ at("t", "x", 2) }}', "t: x at {} is 2 numbers, not one"),
        ('{{ claims("height") }}', "no claim 'height' in the ledger"),
        ('{{ cite("nobody") }}', "no reference 'nobody'"),
    ],
)
def test_what_is_not_there_is_an_error(render, template, message):
    data = xr.Dataset({"x": ("n", [1.0, 2.0])}, {"n": [1, 2]})
    with pytest.raises(ModelError, match=re.escape(message)):
        render(template, t=data)


def test_a_reference_must_be_cited(render):
    with pytest.raises(ModelError, match="references never cited: a"):
        render("nothing", references={"a": {"text": "A."}})


def test_explanations_are_those_of_claims_not_reproduced():
    found = Claims(claims()).explanations()
    assert [part["name"] for part in found] == ["by Eq. 34"]
    assert [claim.id for claim in found[0]["claims"]] == ["contact"]
    assert Claims(claims(verdict=["reproduced", "reproduced"])).explanations() == []


def test_restatements_are_counted_apart():
    shown = Claims(claims(group=["number", "restatement"], restates=["", "heights"]))
    assert (shown.count(), shown.count(group="all")) == (1, 2)
    assert (shown.count("contradicted"), shown.count("contradicted", group="all")) == (0, 1)
    assert (shown.count(group="restatement"), shown.count(group="statement")) == (1, 0)


def test_claims_by_place():
    shown = Claims(claims())
    assert [claim.id for claim in shown.about("Fig. 16")] == ["contact"]
    # Each is shown once.
    assert shown.about("Eq. 38") == [] == shown.about("Fig. 1")
    assert Claims(claims(printed_table=["", "Table 1"])).about("Fig. 16") == []
    assert shown.about("Fig. 14", "Eq. 38")[0].found == "82.18"


def test_other_parameters_are_reported_once():
    reason = "fig14 was computed with n = 2; the claim requires 1"
    shown = Claims(claims(reason=[reason, reason], verdict=["not asked"] * 2))
    assert shown.not_asked() == [reason]
    assert not shown.asked("heights")
    # The verdict says it, not the words.
    assert Claims(claims(reason=[reason, reason])).not_asked() == []
    # What is not asked needs no explanation.
    assert shown.explanations() == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Fig. 3", {"Fig. 3"}),
        ("Eqs. 30-31", {"Eq. 30", "Eq. 31"}),
        ("Figs. 8 and 9, Table 1", {"Fig. 8", "Fig. 9", "Table 1"}),
        ("Figs. 11-13 and 15", {"Fig. 11", "Fig. 12", "Fig. 13", "Fig. 15"}),
        ("text", set()),
    ],
)
def test_places(text, expected):
    assert places(text) == expected


def test_numbers_match_to_rounding_only():
    data = {"t": xr.Dataset({"x": ("r", [1.0, 2.0])}, {"r": [0.1 + 0.2, 0.3001]})}
    assert value_at(data, "t", "x", r=0.3) == 1.0


def test_a_doi_that_was_not_checked_says_so():
    works = {"a": {"text": "A.", "doi": "10.1/x", "doi_checked": False}}
    cited = Citations(works)
    cited.cite("a")
    assert cited.listing() == "1. A. doi:10.1/x (DOI not checked)."


def test_a_work_that_was_not_read_says_so():
    works = {"a": {"text": "A.", "read": "no"}, "b": {"text": "B.", "read": "abstract"}}
    cited = Citations(works)
    cited.cite("a", "b")
    assert cited.listing().splitlines() == [
        "1. A. No DOI found. Not read: cited from memory.",
        "2. B. No DOI found. Read in part: an abstract or a passage.",
    ]


@pytest.mark.parametrize("key", REFERENCES)
def test_references_are_whole(key):
    entry = REFERENCES[key]
    assert set(entry) <= {"text", "doi", "doi_checked", "read"}
    assert entry.get("read", "abstract") in READ
    assert entry["text"].rstrip().endswith(".")
    if "doi" in entry:
        assert re.fullmatch(r"10\.\d{4,5}/\S+", entry["doi"])
        assert isinstance(entry["doi_checked"], bool)
    else:
        assert "doi_checked" not in entry


def test_nan_is_not_printed():
    shown = Claims(claims(found=[np.nan, 9.8118], verdict=["undecidable", "contradicted"]))
    assert shown("heights").found == "–"
