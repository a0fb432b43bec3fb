"""The page of the results and the list of figures: one content, of registry, data and claims."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
import xarray as xr
from tests.reference import ENTRIES, FIGURES, ROOT, reference

from bouncing_ball import pages, tables
from bouncing_ball.claims import judge

LINKS = [("The article", "paper.md")]


@pytest.fixture(scope="module")
def data() -> dict[str, xr.Dataset]:
    """All datasets of the reference by name."""
    return reference()


@pytest.fixture(scope="module")
def listed(data) -> str:
    """The list of figures."""
    return pages.filled_in("md", data, ENTRIES)


@pytest.fixture(scope="module")
def text(data) -> str:
    """The page."""
    return pages.filled_in("html", data, ENTRIES, links=LINKS)


class Page(HTMLParser):
    """Texts, links and pictures of a page; a tag that is not closed in its order is a mistake."""

    ALONE = ("meta", "img")

    def __init__(self, text: str):
        super().__init__()
        self.open: list[str] = []
        self.texts: list[str] = []
        self.places: dict[str, list[str]] = {"href": [], "src": [], "id": [], "alt": []}
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        if tag not in self.ALONE:
            self.open.append(tag)
        for name, value in attrs:
            self.places.setdefault(name, []).append(value)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] != ["style"]:
            self.texts.append(data.strip())


@pytest.fixture(scope="module")
def page(text) -> Page:
    return Page(text)


def test_the_page_and_the_list_have_the_same_claims(data, listed, page):
    rows = re.findall(
        r"^\| ([^|]*?) \| ([^|]*?) \| (?:\*(.*?)\*)? ?\|$", listed, flags=re.MULTILINE
    )
    claims = [row for row in rows if "---" not in row and row[0] != "the paper says"]
    judged = [each for group in tables.GROUPS for each in tables.claims_of(data["claims"], group)]
    assert len(claims) == len([claim for claim in judged if claim["item"] != "Table 1"])
    for said, found, verdict in claims:
        assert said in page.texts and found in page.texts
        assert not verdict or verdict in page.texts


def test_every_claim_is_on_the_page(data, page):
    for group in tables.GROUPS:
        for claim in tables.claims_of(data["claims"], group):
            if claim["item"] != "Table 1":
                assert [text for text in page.texts if text.startswith(claim["statement"])]
    # The ends of Table 1 are in the table.
    for row in tables.table1(data["table1"]):
        assert all(cell in page.texts for cell in row if cell)


def test_every_figure_has_its_picture_its_caption_and_its_data(page):
    for name, entry in ENTRIES.items():
        assert name in page.places["id"]
        assert any(entry["title"] in text for text in page.texts)
        if "caption" in entry:
            assert entry["caption"] in page.places["alt"]
            assert f"figures/{name}.svg" in page.places["src"]
    # What is new is not in the reference yet.
    accepted = {path.stem for path in FIGURES.iterdir()}
    local = [place for place in page.places["href"] if place.startswith("figures/")]
    local = [place for place in local if Path(place).stem in accepted]
    assert [place for place in local if not (ROOT / place).exists()] == []
    anchors = {place[1:] for place in page.places["href"] if place.startswith("#")}
    assert anchors <= {*page.places["id"]}


def test_the_page_needs_no_network_and_fits_a_telephone(text):
    assert "http" not in text and "<script" not in text and "@import" not in text
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in text
    assert "@media print" in text


def test_the_answer_is_the_first_sentence_of_both(listed, page):
    answer = next(text for text in page.texts if text.startswith("From a frequency ratio"))
    assert listed.split("\n\n")[1] == answer
    assert answer.count(". ") == 0


def test_a_new_figure_and_a_new_claim_follow_from_registry_and_dataset(data):
    entry = {"title": "Figure 17: <another>", "caption": "Another & more."}
    claims = data["claims"]
    new = claims.isel(claim=[0]).assign_coords(claim=["new"]).assign(beside=("claim", ["fig17"]))
    every = data | {"fig17": data["fig14"], "claims": xr.concat([claims, new], "claim")}
    text = pages.filled_in("html", every, ENTRIES | {"fig17": entry}, links=LINKS)
    found = Page(text[text.index('<section id="fig17"') : text.index("</main>")])
    assert "Figure 17: <another>" in found.texts
    assert found.places["alt"][0] == "Another & more."
    assert claims.statement[0].item() in found.texts


def test_a_claim_that_was_not_asked_says_why(data):
    other = data["fig14"].attrs["parameters"].replace('"n": 1', '"n": 2')
    changed = data | {"fig14": data["fig14"].assign_attrs(parameters=other)}
    changed["claims"] = judge(changed).assign_attrs(data["claims"].attrs)
    text = pages.filled_in("md", changed, ENTRIES)
    assert "fig14: n is 2, and the claim needs 1 | *not testable* |" in text
