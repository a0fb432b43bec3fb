"""The article from small templates and datasets."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from article_checks import works_of
from bouncing_ball_beyond.inherited.paper.claims.claim_tables import Claims

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.article import (
    numbered,
    render_article,
    sections_of,
    with_citations,
)

ROOT = Path(__file__).resolve().parents[3]
TEMPLATES = ROOT / "workflow" / "report" / "paper"


def claims(**changes):
    """Two claims, one reproduced and one contradicted."""
    columns = {
        "group": ["number", "number"],
        "item": ["Fig. 14", "Eq. 38, Fig. 16"],
        "printed_table": ["", ""],
        "printed_text": ["82", "6"],
        "verdict": ["reproduced", "contradicted"],
        "reason": ["", ""],
        "found": [82.177, 9.8118],
        "limit": [np.nan, np.nan],
    } | changes
    data = {key: ("claim", values) for key, values in columns.items()}
    return xr.Dataset(data, {"claim": ["heights", "contact"]})


@pytest.fixture
def render(tmp_path):
    def run(template, ledger=None, **data):
        (tmp_path / "article.md.j2").write_text(template, encoding="utf-8")
        shown = Claims(claims() if ledger is None else ledger)
        return render_article(tmp_path / "article.md.j2", data, {}, shown, {})

    return run


def test_a_printed_number_follows_its_dataset(render):
    data = xr.Dataset({"x": ("n", [1.0, 9.8118])}, {"n": [1, 2]})
    assert render("{{ decimal(data.t.x.sel(n=2).item(), 2) }}", t=data) == "9.81"
    data["x"] = data.x + 1
    assert render("{{ decimal(data.t.x.sel(n=2).item(), 2) }}", t=data) == "10.81"


def test_a_printed_verdict_follows_the_claims(render):
    text = '{{ claims("contact").verdict }} {{ claims.count("reproduced") }}/{{ claims.count() }}'
    assert render(text) == "contradicted 1/2"
    assert render(text, ledger=claims(verdict=["undecidable"] * 2)) == "undecidable 0/2"


def test_an_unknown_claim_is_an_error(render):
    with pytest.raises(KeyError, match="height"):
        render('{{ claims("height") }}')


def test_claims_are_counted_by_verdict_group_and_table():
    shown = Claims(claims(group=["number", "statement"], printed_table=["Table 1", ""]))
    assert (shown.count(), shown.count("contradicted")) == (2, 1)
    assert (shown.count(group="number"), shown.count("contradicted", group="number")) == (1, 0)
    assert (shown.count(table="Table 1"), shown.count("contradicted", table="Table 1")) == (1, 0)


def test_other_parameters_are_reported_once():
    reason = "fig14 was computed with n = 2; the claim requires 1"
    shown = Claims(claims(reason=[reason, reason], verdict=["not asked"] * 2))
    assert shown.not_asked() == [reason]
    assert not shown.asked("heights")
    # The verdict says it, not the words.
    assert Claims(claims(reason=[reason, reason])).not_asked() == []


def test_pandoc_numbers_citations_and_lists_the_works(tmp_path):
    for name in ("references.yaml", "numbered.csl"):
        (tmp_path / name).write_bytes((TEMPLATES / name).read_bytes())
    text = "A *b* [@holmes1982; @carbonelli2011], $x_1$ [@holmes1982].\n\n"
    text += '<div id="refs"></div>\n\nEnd.\n'
    head, holmes, paper, end = filter(None, with_citations(text, tmp_path).splitlines())
    assert head == "A *b* [1, 2], $x_1$ [1]." and end == "End."
    # How much of a work was read is said.
    assert holmes.startswith('1. P. J. Holmes, "The dynamics of repeated impacts')
    assert holmes.endswith("Vibration 84 (1982) 173–189. (Not read.)")
    assert paper.endswith("doi:10.1115/DETC2011-47870 (DOI not checked).")
    # A folder may add works to the list of a shared one.
    more = tmp_path / "more"
    more.mkdir()
    listed = "references:\n- {id: own2026, type: book, title: A title}\n"
    (more / "references.yaml").write_text(listed, encoding="utf-8")
    text = '[@own2026; @holmes1982]\n\n<div id="refs"></div>\n'
    found = with_citations(text, more, tmp_path)
    assert found.startswith("[1, 2]\n") and "A title" in found and "P. J. Holmes" in found
    with pytest.raises(ModelError, match="nobody not found"):
        with_citations("[@nobody]\n", tmp_path)


def test_every_reference_is_cited():
    cited, known = works_of(TEMPLATES)
    assert known == cited


def test_nan_is_printed_as_a_dash():
    shown = Claims(claims(found=[np.nan, 9.8118], verdict=["undecidable", "contradicted"]))
    assert shown("heights").found == "–"


def test_names_have_numbers_in_the_order_of_their_captions(render):
    text = "**Table «b».** **Figure «a», a ball.** See Figure «a» and Table «b».\n## End\n«End»"
    # Those of a replication follow the figures and the table of the paper.
    for title, prefix, figure, table in (
        ("# [Re] A title", "", 17, 2),
        ("# Supplement", "S", "S1", "S1"),
        ("# A title", "", 1, 1),
    ):
        assert render(f"{title}\n\n{text}") == (
            f"{title}\n\n**Table {table}.** **Figure {figure}, a ball.** "
            f"See Figure {figure} and Table {table}.\n## {prefix}1. End\n{prefix}1"
        )
    with pytest.raises(KeyError, match="nowhere"):
        render("Figure «nowhere»")


def test_an_article_can_refer_to_the_sections_of_its_supplement():
    supplement = numbered("# Supplement\n## Checks\n### Routes\n## End")
    sections = sections_of(supplement)
    assert sections == {"Checks": "S1", "Routes": "S1.1", "End": "S2"}
    # A section of its own comes before one of the same name.
    article = numbered("# [Re] A title\n## End\nSee «Routes», «End».", sections)
    assert article.splitlines()[-1] == "See S1.1, 1."
