"""The article from small templates and datasets."""

from pathlib import Path

import pytest
import xarray as xr

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.article import (
    numbered,
    render_article,
    sections_of,
    with_citations,
)

TEMPLATES = Path(__file__).resolve().parents[4] / "report" / "shared"


@pytest.fixture
def render(tmp_path):
    def run(template, **data):
        (tmp_path / "article.md.j2").write_text(template, encoding="utf-8")
        return render_article(tmp_path / "article.md.j2", data, {}, {})

    return run


def test_a_printed_number_follows_its_dataset(render):
    data = xr.Dataset({"x": ("n", [1.0, 9.8118])}, {"n": [1, 2]})
    assert render("{{ decimal(data.t.x.sel(n=2).item(), 2) }}", t=data) == "9.81"
    data["x"] = data.x + 1
    assert render("{{ decimal(data.t.x.sel(n=2).item(), 2) }}", t=data) == "10.81"


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
