"""The PDF of the article: pages, captions, vectors, links."""

import io
import re
from pathlib import Path

import pytest
from pypdf import PdfReader

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.article import article_pdf, for_pdf

pytest.importorskip("typst")

ROOT = Path(__file__).resolve().parents[3]
TEMPLATE = ROOT / "workflow" / "report" / "paper" / "article.typ"
SMALL = """# A title

Text with $\\varpi^2\\,(\\Lambda-1)$ and a [file](config/config.yaml).

![Figure 7](figures/fig07.png)
**Figure 7.** One cycle.
*From* [its dataset](figures/fig07.nc).

| r | $\\zeta$ |
| --- | --- |
| 0.85 | 0.052 |
"""


def uris(reader):
    """The targets of all links that leave the document."""
    for page in reader.pages:
        for entry in page.get("/Annots", []):
            action = entry.get_object().get("/A", {})
            if "/URI" in action:
                yield str(action["/URI"])


@pytest.mark.long
def test_the_article_is_set_with_its_headings_captions_and_figures(accepted):
    text = accepted["article"]
    reader = PdfReader(io.BytesIO(article_pdf(text, TEMPLATE, ROOT)))
    words = re.sub(r"\s+", "", "".join(page.extract_text() for page in reader.pages))
    headings = re.findall(r"^##+ (.*)$", text, re.MULTILINE)
    captions = re.findall(r"^\*\*((?:Figure|Table) \d+.*?)\*\*", text, re.MULTILINE)
    assert len(headings) > 15 and len(captions) > 15
    for heading in headings + captions:
        assert re.sub(r"[\s`]+", "", heading) in words, heading
    # All of the graphics is there as vectors: curves by the thousand.
    operators = sum(len(page.get_contents().get_data()) for page in reader.pages)
    assert operators > 500_000


def test_a_pdf_has_captions_and_links_and_is_the_same_every_time():
    first, second = (article_pdf(SMALL, TEMPLATE, ROOT) for _ in range(2))
    # No time and no machine in it.
    assert first == second
    reader = PdfReader(io.BytesIO(first))
    words = " ".join(reader.pages[0].extract_text().split())
    assert "One cycle. From its dataset" in words
    assert sorted(uris(reader)) == ["../config/config.yaml", "figures/fig07.nc"]


def test_an_article_that_cannot_be_set_is_refused_in_one_line(tmp_path, refusal):
    with refusal(ModelError, "the article cannot be set: "):
        article_pdf(SMALL, TEMPLATE, tmp_path)


def test_links_to_the_web_and_to_figures_stay_and_others_go_one_folder_up():
    text = "[a](https://example.org) [b](figures/x.nc) [c](#part) [d](docs/x.md)"
    assert for_pdf(text) == text.replace("(docs", "(../docs")
