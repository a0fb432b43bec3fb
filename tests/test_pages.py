"""The pages of the results and of the article, and the list of figures."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr
from markdown_it import MarkdownIt
from tests.checkout import ROOT
from tests.reference import CONFIG, ENTRIES, FIGURES, TOP, reference, with_parameters

from carbonelli2011 import article, index, tables
from carbonelli2011.claims import judge
from paper_replication import judgements, origins
from paper_replication import pages as text_pages

CAPTIONS = {name: entry["caption"] for name, entry in ENTRIES.items() if "caption" in entry}


@pytest.fixture(scope="module")
def data() -> dict[str, xr.Dataset]:
    """All datasets of the reference by name."""
    return reference()


class Page(HTMLParser):
    """Texts and attributes of a page; a tag that is not closed in its order is a mistake."""

    ALONE = ("meta", "img", "br", "hr")

    def __init__(self, text: str):
        super().__init__()
        self.open: list[str] = []
        self.texts: list[str] = []
        self.tags: list[str] = []
        self.places: dict[str, list[str]] = {"href": [], "src": [], "id": [], "alt": []}
        # Indices are written as in the datasets.
        text = re.sub("<sub>(.*?)</sub>", r"_\1", text)
        self.feed(text.replace("\N{NO-BREAK SPACE}", " "))
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in self.ALONE:
            self.open.append(tag)
        for name, value in attrs:
            self.places.setdefault(name, []).append(value)

    def handle_endtag(self, tag):
        if tag not in self.ALONE:
            assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] != ["style"]:
            self.texts.append(data.strip())


@pytest.fixture(scope="module")
def texts(data) -> dict[str, str]:
    """The pages by the names of their files."""
    every = index.pages(data, ENTRIES)
    return {name: text for name, text in every.items() if name.endswith(".html")}


@pytest.fixture(scope="module")
def read(texts) -> dict[str, Page]:
    return {name: Page(text) for name, text in texts.items()}


@pytest.fixture(scope="module")
def listed(data) -> str:
    """The list of figures."""
    return index.list_of_figures("md", data, ENTRIES)


# All pages


def test_pages_need_no_network_and_no_script(texts, read):
    loading = ("<script", "<link", "<iframe", "@import", "url(")
    for name, text in texts.items():
        assert [construct for construct in loading if construct in text] == []
        assert all(source.startswith("figures/") for source in read[name].places["src"])
        assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in text


def test_links_lead_to_pages_and_files_that_exist(read):
    # What is new is not in the reference yet.
    files = {f"figures/{path.name}" for path in FIGURES.iterdir()}
    files |= {f"figures/{name}.{kind}" for name in CAPTIONS for kind in ("png", "svg")}
    for name, page in read.items():
        assert len(page.places["id"]) == len({*page.places["id"]})
        for target in page.places["href"] + page.places["src"]:
            file, _, anchor = target.partition("#")
            if file.startswith("https://doi.org/"):
                continue
            # From results/ into the repository.
            inside = file.startswith("../") and (ROOT / file.removeprefix("../")).is_file()
            assert inside or file in files or (file or name) in read, target
            assert not anchor or anchor in read[file or name].places["id"], target


def test_every_computed_number_is_a_link_and_is_listed_once(texts):
    linked = re.compile(r'<a class="number" href="numbers.html#([\w-]+)"')
    for name in ("paper", "supplement"):
        targets = linked.findall(texts[f"{name}.html"])
        listed = re.findall(rf'<div id="({name}-\d+)">', texts["numbers.html"])
        assert len(targets) > 50 and {*targets} == {*listed}
    assert not re.search("[\ue000-\ue002]", "".join(texts.values()))
    # Code can be copied.
    assert "\N{NO-BREAK SPACE}" not in "".join(
        re.findall("<code>.*?</code>", texts["numbers.html"])
    )


# The results


def test_every_claim_is_once_on_both_pages_and_with_its_figure_in_the_list(data, read, listed):
    lines = [line.removeprefix("Claims: ") for line in listed.splitlines() if "Claims: " in line]
    rows = re.findall(r"(.*?) \*([a-z ]+)\*(?:; )?", "".join(lines))
    expected = {}
    for claim in judgements.counted(data["claims"]):
        if claim["item"] != "Table 1":
            said = ": ".join(filter(None, (claim["statement"], claim["printed_text"])))
            if claim["beside"] not in text_pages.SEVERAL:
                expected[claim["claim"]] = claim["verdict"]
            for name in ("index.html", "claims.html"):
                assert read[name].texts.count(said) == 1
            assert all(sense in read["claims.html"].texts for sense in claim["senses"])
    # Claims of one's own are in the list, too.
    for claim in judgements.claims_of(data["claims"], "own claim"):
        if claim["beside"] not in text_pages.SEVERAL:
            expected[claim["claim"]] = claim["verdict"]
    assert len(rows) == len(expected) and dict(rows) == expected
    # The ends of Table 1 are in the table.
    for row in tables.table1(data["table1"]):
        for name in ("index.html", "claims.html"):
            assert all(cell in read[name].texts for cell in row if cell)


def test_every_figure_has_its_picture_its_caption_and_its_data(read):
    page = read["index.html"]
    for name, entry in ENTRIES.items():
        assert name in page.places["id"]
        assert any(entry["title"] in text for text in page.texts)
        if "caption" in entry:
            assert entry["title"].partition(":")[0] in page.places["alt"]
            assert page.texts.count(entry["caption"]) == 1
            assert f"figures/{name}.svg" in page.places["src"]
        if name not in CONFIG["schematics"]:
            assert f"figures/{entry.get('data', name)}.nc" in page.places["href"]


def test_the_exceptions_are_those_of_the_map(data):
    other = data["validity_map"].copy(deep=True)
    other["failing_up_to"][:] = 0.0
    other["failing_up_to"].loc["bounce_velocity", 2] = 0.31
    other["largest_error"].loc["summit"] = 0.0042
    other["failing_mean"].loc["summit"] = [0.2, 0.0004, 0.0]
    other["doubled_mean"][:] = 0.25
    other["below_mean"][:] = [0.0, 0.2, 1.3]
    assert index.exceptions(other)[1:3] == [
        ["maximum height in flight", "0.42 %", "no n", "20.0 %", "< 0.1 %", "none"],
        [
            "bouncing-off velocity",
            "1.32 %",
            "n = 2 up to r ≈ 0.31",
            "11.7 %",
            "none",
            "none",
        ],
    ]
    assert index.shifts(other)[2][-3:] == ["25.0 %", "25.0 %", "25.0 %"]
    assert index.shifts(other)[1][1:] == [
        "every r from 0.05 to 0.95, below the saddle-node",
        *("none", "20.0 %", "130.0 %"),
    ]


@pytest.mark.parametrize(
    ("shares", "where"),
    [
        ([[0.1, 0.2], [0.3, 0.4]], "every r from 0.1 to 0.9, next to it"),
        ([[0.0, 0.2], [0.3, 0.4]], "n = 1 at some r and n = 2 at every r"),
        ([[0.0, 0.0], [0.3, 0.0]], "n = 2 at some r"),
        ([[0.0, 0.0], [0.0, 0.0]], "no n"),
        ([[0.0, np.nan], [0.1, 0.1]], "unknown"),
    ],
)
def test_a_share_at_one_side_of_the_range_is_said_where_it_is_positive(shares, where):
    over = {"n": [1, 2], "restitution": [0.1, 0.9]}
    share = xr.DataArray(shares, over, ("n", "restitution"))
    assert index.positive(share, "next to it") == where


def test_a_new_figure_and_a_new_claim_follow_from_registry_and_dataset(data):
    entry = {"title": "Figure 17: <another>", "caption": "Another & more."}
    claims = data["claims"]
    new = claims.isel(claim=[0]).assign_coords(claim=["new"]).assign(beside=("claim", ["fig17"]))
    every = data | {"fig17": data["fig14"], "claims": xr.concat([claims, new], "claim")}
    text = index.list_of_figures("html", every, ENTRIES | {"fig17": entry})
    section = Page(text[text.index('<section id="fig17"') : text.index("</main>")])
    assert "Figure 17: <another>" in section.texts
    assert section.places["alt"][0] == "Figure 17" and "Another & more." in section.texts
    assert claims.statement[0].item() in section.texts


def test_a_claim_that_this_run_cannot_judge_says_why(data, read):
    changed = data | {"fig14": with_parameters(data["fig14"], n=2)}
    changed["claims"] = judge(changed).assign_attrs(data["claims"].attrs)
    unasked = sum(by["not asked"] for by in judgements.counts(changed["claims"]).values())
    reason = "other parameters: fig14.n is 2 instead of 1"
    page = Page(index.list_of_figures("html", changed, ENTRIES))
    evidence = Page(index.list_of_figures("html", changed, ENTRIES, name="claims"))
    assert f"This run cannot judge it: {reason}" in evidence.texts
    assert f"This run cannot judge {unasked} of these claims" in page.texts
    assert any("above 82; this run has other parameters." in text for text in page.texts)
    assert not any("his run" in text for text in read["index.html"].texts)


def test_the_answer_is_not_given_for_other_orbits(data, read):
    answer = "If the natural frequency of the contact is 100 times the frequency of the table"
    assert any(text.startswith(answer) for text in read["index.html"].texts)
    changed = data | {"validity_map": with_parameters(data["validity_map"], advised=9.0)}
    changed["claims"] = judge(changed).assign_attrs(data["claims"].attrs)
    page = Page(index.list_of_figures("html", changed, ENTRIES))
    assert "This run has other parameters than the paper" in page.texts
    assert not any("natural frequency of the contact is" in text for text in page.texts)


# The article and its supplement


def test_the_article_of_another_run_is_a_page_with_links_to_its_results(data):
    changed = data | {"fig14": with_parameters(data["fig14"], n=2)}
    changed["fig03"] = with_parameters(data["fig03"], n=[7])
    for name in ("paper", "supplement"):
        page = Page(text_pages.page_of(article.text(name, changed), name))
        assert "fig03: n lacks 1, 2, 3, 4, 5" in page.texts
        assert "fig14: n is 2 instead of 1" in page.texts
        assert {"index.html", "claims.html"} <= {*page.places["href"]}
        # Where all pages say that the verdicts are defined.
        assert ("section-3" in page.places["id"]) == (name == "paper")


def test_formulas_are_mathml(texts, data):
    for name in ("paper", "supplement"):
        text = origins.bare(article.text(name, data))
        inline = re.findall(r"(?<!\$)\$[^$]+\$(?!\$)", text)
        page = texts[f"{name}.html"]
        assert page.count("<math") >= len(inline) > 0
        assert "$" not in page and "\\" not in page


def test_the_number_of_an_equation_stays_with_its_formula(texts):
    units = re.findall(r'<span class="numbered">(.*?)</span>', texts["paper.html"])
    numbers = [re.findall(r"\((?:Eqs?\W|R\d)", unit) for unit in units]
    assert max(map(len, numbers)) == 1 and sum(map(len, numbers)) > 9
    alone = [unit for unit, equations in zip(units, numbers, strict=True) if equations]
    assert all(unit.count("<math") == 2 for unit in alone)


HOUSES = (TOP, *TOP.glob("extras/*"))


@pytest.mark.parametrize(
    "page",
    [path for house in HOUSES for path in (*house.glob("*.md"), *house.glob("docs/*.md"))],
    ids=lambda path: str(path.relative_to(TOP)),
)
def test_markdown_leaves_formulas_as_they_are(page):
    """A forge reads Markdown first, which eats a backslash before punctuation, also in $$…$$."""
    for block in MarkdownIt().parse(page.read_text("utf-8")):
        parts = [part for part in block.children or () if part.type != "code_inline"]
        left = "".join(part.content if part.type == "text" else "\n" for part in parts)
        without_code = re.sub("`[^`]*`", "\n", block.content) if parts else ""
        for formula in re.findall(r"\$\$[^$]+\$\$|\$[^$]+\$", without_code):
            assert formula in left


def test_only_a_formula_and_its_punctuation_are_kept_on_one_line(texts):
    """A longer unit would be cut off on a narrow screen, and shrink the printed page."""
    one = re.compile(r'\(?<span class="math inline">(?:(?!</?span).)*</span>[.,;:)]+</span>')
    for name in ("paper.html", "supplement.html"):
        units = texts[name].split('<span class="whole">')[1:]
        assert units and all(one.match(unit) for unit in units)


def test_a_picture_has_a_name_and_below_it_a_caption(data, read, listed):
    """The caption is a text that everybody reads, and the alternative text does not repeat it."""
    shown = re.findall(
        r"^!\[(.+)\]\(figures/\w+\.png\)\n\*\*.+\*\* \S", article.text("paper", data), re.M
    )
    assert read["paper.html"].places["alt"] == shown and len(shown) > 16
    for name, caption in CAPTIONS.items():
        picture = f'<a href="{name}.svg"><img src="{name}.png"'
        below = listed.partition(picture)[2].split("\n\n")[1]
        assert below.replace("\\_", "_") == caption


def test_tables_of_the_article_can_be_read_on_a_telephone(read):
    page = read["paper.html"]
    assert page.tags.count("td") == len(page.places["data-label"]) > 0


def test_citations_and_sections_are_linked(read):
    page = read["paper.html"]
    cited = [link for link in page.places["href"] if link.startswith("paper.html#reference-")]
    references = {f"paper.html#{name}" for name in page.places["id"] if "reference-" in name}
    assert {*cited} == references and len(references) > 20
    assert "supplement.html#section-S3" in page.places["href"]
