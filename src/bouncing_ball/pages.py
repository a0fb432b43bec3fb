"""Pages for a browser: the results, and the article and its supplement; and the list of figures.

The page of the results and the list are templates over the same parts. A part is a figure, a table
or a dataset, with the claims that are shown next to it.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from html import escape
from itertools import pairwise

import xarray as xr
from latex2mathml.converter import convert
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

from bouncing_ball import article, origins, tables
from bouncing_ball.claims import CLAIMS
from bouncing_ball.datasets import Datasets, parameters
from bouncing_ball.drawing import share_text
from bouncing_ball.paper import QUANTITIES

SEVERAL = {"several": "Several figures", "": "Statements that no figure shows"}
"""Parts with claims that belong to no single figure or table."""


@dataclass(frozen=True)
class Row:
    """A claim as it is shown.

    Attributes
    ----------
    said, where
        What the paper says, with the printed number, and where.
    found
        The computed number, or the conditions of the verdict.
    verdict
        One of `verdicts.VERDICTS`.
    literal
        Whether the literal sense holds, if the senses differ.
    reason, remark
        Why the claim is not testable, and how we read it.
    """

    said: str
    where: str
    found: Sequence[str]
    verdict: str
    literal: str
    reason: str
    remark: str


@dataclass(frozen=True)
class Part:
    """A figure, a table or a dataset, with its claims.

    Attributes
    ----------
    name, title, caption
        Those of config.yaml.
    files
        Names of the files, by what they are.
    rows
        The claims.
    table
        Rows of texts, the header first.
    elsewhere
        Names of the figures and tables next to which the dataset decides a claim, too.
    """

    name: str
    title: str
    caption: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    rows: Sequence[Row] = ()
    table: Sequence[Sequence[str]] = ()
    elsewhere: Sequence[str] = ()


# The page of the results, and the list of figures


def filled_in(kind: str, datasets: Datasets, entries: Mapping[str, Mapping], **more) -> str:
    """Return the list of figures in Markdown ("md"), or the page of the results ("html").

    `entries` are the registered figures, tables and datasets by name.
    """
    found = parts(datasets, entries)
    claims = datasets["claims"]
    formulas = tables.claims_of(claims, "restored formula")
    text = article.filled_in(
        "figures",
        datasets,
        kind,
        markdown=tables.markdown,
        formula=convert,
        counts=tables.counts(claims),
        unasked=int((claims.verdict == "not asked").sum()),
        exceptions=exceptions(datasets["validity_map"]),
        formulas=tables.chosen(tables.SECTIONS["restored formula"], formulas),
        figures=[part for part in found if "PNG" in part.files],
        tabulated=[part for part in found if part.table],
        others=[part for part in found if part.files.keys() == {"dataset"}],
        general=[part for part in found if not part.files],
        **more,
    )
    return with_subscripts(unbroken(text)) if kind == "html" else text


def with_subscripts(page: str) -> str:
    """Set the indices of symbols below the line, in texts and not in tags.

    >>> with_subscripts('<td title="τ_b">φ + τ_b, r_a</td>')
    '<td title="τ_b">φ + τ<sub>b</sub>, r<sub>a</sub></td>'
    """
    return re.sub(r"([τφδϖΛζ′]|\br)_(\w+)(?=[^<>]*<)", r"\1<sub>\2</sub>", page)


def parts(datasets: Datasets, entries: Mapping[str, Mapping]) -> list[Part]:
    """All figures in the order of the paper, tables and datasets, then `SEVERAL`."""
    found = []
    for name in sorted(entries, key=lambda name: (not name.startswith("fig"), name)):
        entry = entries[name]
        kinds = {"dataset": "nc"} if name in datasets else {}
        if "caption" in entry:
            kinds |= {"PNG": "png", "SVG": "svg"}
        if entry.get("table"):
            kinds |= {"CSV": "csv", "Markdown": "md"}
        decided = {claim.beside for claim in CLAIMS if name in claim.datasets}
        found.append(
            Part(
                name,
                title=entry["title"],
                caption=entry.get("caption", ""),
                files={label: f"{name}.{kind}" for label, kind in kinds.items()},
                rows=rows_beside(name, datasets),
                table=tables.TABLES[name](datasets[name]) if entry.get("table") else (),
                elsewhere=sorted(decided & {*entries}),
            )
        )
    general = [Part(key, title, rows=rows_beside(key, datasets)) for key, title in SEVERAL.items()]
    return found + general


def rows_beside(name: str, datasets: Datasets) -> list[Row]:
    """The claims next to a figure or table; the ends of Table 1 are in the table itself."""
    return [
        row(claim)
        for group in tables.GROUPS
        for claim in tables.claims_of(datasets["claims"], group)
        if claim["beside"] == name and claim["item"] != "Table 1"
    ]


def row(claim: Mapping) -> Row:
    """A claim as it is shown."""
    number = " ".join(filter(None, (claim["computed"], f"({claim['distance']})")))
    return Row(
        said=": ".join(filter(None, (claim["statement"], claim["printed_text"]))),
        where=claim["item"],
        found=[number] if claim["distance"] else claim["senses"],
        verdict=claim["verdict"],
        literal=claim["own_sense"],
        reason=claim["reason"],
        remark=claim["remark"],
    )


def exceptions(validity_map: xr.Dataset) -> list[list[str]]:
    """Where the advised frequency ratio is not enough, as rows of texts, the header first.

    The last columns have the share of the range of Λ for each n, on average over r.
    """
    given = parameters(validity_map)
    advised = article.short(given["advised"])
    limit = article.percent(given["tolerance"])
    families = [f"n = {n}" for n in validity_map.n.values]
    heads = ["quantity", f"largest error at ϖ ≥ {advised}", f"error above {limit} for some Λ"]
    rows = [[*heads, f"share: {families[0]}", *families[1:]]]
    for quantity in validity_map["quantity"].values:
        error = validity_map.stiff_error.sel(quantity=quantity).max()
        of = " of a period" if quantity == "phase_in_periods" else ""
        where = article.failing(validity_map, quantity)
        shares = map(share_text, validity_map.failing_mean.sel(quantity=quantity).values)
        rows.append([QUANTITIES[quantity], article.percent(error, 2) + of, where, *shares])
    beyond = {
        "doubled": ("period", "doubled", "next to the period doubling"),
        "below": ("no orbit in the simple model", "stable orbits", "below the saddle-node"),
    }
    for name, (quantity, found, side) in beyond.items():
        where = positive(validity_map[f"{name}_share"], side)
        shares = map(share_text, validity_map[f"{name}_mean"].values)
        rows.append([quantity, f"{found} at ϖ = {advised}", where, *shares])
    return rows


def positive(share: xr.DataArray, side: str) -> str:
    """Print for which n and r a share at one side of the range of Λ is positive.

    It is a dash if the share is missing for some n and r.
    """
    if share.isnull().any():
        return "–"
    if (share > 0).all():
        r = share.restitution
        ends = [article.short(end) for end in (r.min(), r.max())]
        return f"every r from {' to '.join(ends)}, {side}"
    words = {False: "some", True: "every"}
    parts = [
        f"n = {of_n.n.item()} at {words[bool((of_n > 0).all())]} r" for of_n in share if of_n.any()
    ]
    return article.listed(parts) if parts else "no n"


# The article and its supplement


PAGES = {
    "paper.md": "paper.html",
    "supplement.md": "supplement.html",
    "figures/README.md": "index.html",
}
"""The page for each text; the page of a table or of the claims is a part of index.html."""


def page_of(
    markdown: str,
    name: str,
    captions: Mapping[str, str],
    origin: Sequence[origins.Origin] = (),
) -> str:
    """The page of a text in Markdown: "paper" or "supplement".

    Formulas become MathML. Links to texts lead to their pages, and citations to the references.
    What an expression printed leads to its origin on the page of numbers; `origin` has the origins
    of all expressions. `captions` describe the pictures, by the names of figures.
    """
    tokens = parser().parse(markdown)
    inside = [token for block in tokens for token in (block, *(block.children or ()))]
    for token in inside:
        if token.type == "image":
            figure = token.attrs["src"].removeprefix("figures/").removesuffix(".png")
            token.attrs["src"] = f"figures/{figure}.svg"
            token.children = [Token("text", "", 0, content=captions[figure])]
        elif token.type == "link_open":
            token.attrs["href"] = link(token.attrs["href"])
    contents = name_headings(tokens)
    name_references(tokens)
    name_cells(tokens)
    body = parser().renderer.render(tokens, parser().options, {})
    # A formula stays with the punctuation after it.
    inline = r'(<span class="math inline">(?:(?!</span>).)*</span>[.,;:)]+)'
    body = re.sub(inline, r'<span class="whole">\1</span>', body)
    return framed(with_origins(with_links(body), name, origin), name, contents)


def framed(body: str, name: str, contents: Sequence[tuple[str, str]]) -> str:
    """Return a page of text. `contents` are anchors and texts of its headings, the title first."""
    template = article.environment(article.TEMPLATES).get_template("article.html.j2")
    return unbroken(
        template.render(name=name, title=contents[0][1], contents=contents[1:], body=body)
    )


def with_origins(body: str, name: str, origin: Sequence[origins.Origin]) -> str:
    """Link what the expressions printed, if they name a dataset."""

    def linked(found: re.Match) -> str:
        number = int(found[1])
        text = found[2]
        if not origin[number].datasets:
            return text
        title = escape(origin[number].expression)
        return f'<a class="number" href="numbers.html#{name}-{number}" title="{title}">{text}</a>'

    return origins.MARK.sub(linked, body)


@cache
def parser() -> MarkdownIt:
    """The parser of our texts: Markdown with tables, line breaks in cells, and formulas."""
    found = MarkdownIt("commonmark").enable("table")
    return found.use(dollarmath_plugin, renderer=formula, allow_digits=False)


def formula(tex: str, options: Mapping) -> str:
    """A formula as MathML. A displayed one is split at its wide spaces, where a line may break."""
    tex = origins.bare(tex)
    # The library leaves no space around the names of functions.
    tex = re.sub(r"(?<=[\w}])(?=\\(?:sin|cos|ln)\b)", r"\\,", tex)
    tex = re.sub(r"(\\(?:sin|cos|ln|max))(?=\\| )", r"\1\\,", tex)
    if not options["display_mode"]:
        return convert(tex)
    return "".join(convert(each, display="block") for each in re.split(r"\\q?quad", tex))


def link(target: str) -> str:
    """Where a link of a text leads in a browser.

    >>> link("supplement.md"), link("figures/table1.md"), link("figures/claims.csv")
    ('supplement.html', 'index.html#table1', 'figures/claims.csv')
    """
    table = re.fullmatch(r"figures/(\w+)\.md", target)
    return PAGES.get(target) or (f"index.html#{table[1]}" if table else target)


def name_headings(tokens: Sequence[Token]) -> list[tuple[str, str]]:
    """Give each heading its number as an anchor, and return anchors and texts."""
    found = []
    for heading, text in pairwise(tokens):
        if heading.type == "heading_open":
            words = origins.bare(text.content)
            number = re.match(r"S?\d[\d.]*", words)
            anchor = f"section-{number[0].rstrip('.')}" if number else words.lower()
            heading.attrs["id"] = anchor
            if heading.tag != "h3":
                found.append((anchor, words))
    return found


def name_references(tokens: Sequence[Token]) -> None:
    """Give each entry of the list of references its number as an anchor."""
    for token in tokens:
        if token.type == "list_item_open" and token.info:
            token.attrs["id"] = f"reference-{token.info}"


def name_cells(tokens: Sequence[Token]) -> None:
    """Give each cell of a table the text of its column's header, for narrow screens."""
    header: list[str] = []
    column = 0
    for token, text in pairwise(tokens):
        if token.type == "thead_open":
            header = []
        elif token.type == "tr_open":
            column = 0
        elif token.type == "th_open":
            header.append(origins.bare(text.content))
        elif token.type == "td_open":
            token.attrs["data-label"] = header[column]
            column += 1


def with_links(body: str) -> str:
    """Link figures, citations, sections and identifiers of documents in a text in HTML."""

    def figures(found: re.Match) -> str:
        return f'<a href="index.html#fig{found[1]:0>2}">{found[0]}</a>'

    def sections(found: re.Match) -> str:
        page = "supplement.html" if found[1].startswith("S") else "paper.html"
        return f'<a href="{page}#section-{found[1]}">{found[0]}</a>'

    def citations(found: re.Match) -> str:
        return re.sub(r"\d+", r'<a href="paper.html#reference-\g<0>">\g<0></a>', found[0])

    body = re.sub(r"<strong>Figure (\d+)\.</strong>", figures, body)
    body = re.sub(r"\bSection (S?\d(?:\.\d)?)", sections, body)
    body = re.sub(r"\[\d+(?:, \d+)*\]", citations, body)
    return re.sub(r"doi:(10\.[^\s<]+[^\s<.,])", r'<a href="https://doi.org/\1">\g<0></a>', body)


# The page of numbers


def numbers(
    texts: Mapping[str, str], origin: Mapping[str, Sequence[origins.Origin]], datasets: Datasets
) -> str:
    """Return the page of what the texts print: sentences, expressions, datasets and claims.

    `texts` have marks, and `origin` has the origins of their expressions.
    """
    judged = [row for group in tables.GROUPS for row in tables.claims_of(datasets["claims"], group)]
    sentences = {name: sentences_of(text, origin[name], judged) for name, text in texts.items()}
    others = [each for name in texts for each in without_dataset(texts[name], origin[name])]
    template = article.environment(article.TEMPLATES).get_template("numbers.html.j2")
    contents = [
        ("", "Where the numbers come from"),
        *((name, name.title()) for name in texts),
        ("others", "Without a dataset"),
    ]
    return framed(
        template.render(texts=sentences, others=dict.fromkeys(others)), "numbers", contents
    )


def sentences_of(
    text: str, origin: Sequence[origins.Origin], judged: Sequence[Mapping]
) -> list[tuple[str, list[dict]]]:
    """Return the sentences whose expressions name a dataset, with what each expression prints.

    An expression of several lines, as in tables, is listed with the first.
    """
    printed = origins.printed(text)
    found = []
    for line in text.splitlines():
        rows = []
        for number in origins.printed(line):
            if origin[number].datasets and number in printed:
                terms = [origin[number].expression, *dict.fromkeys(origin[number].names.values())]
                claims = re.findall(r'claim\["(.+?)"\]', " ".join(terms))
                rows.append(
                    {
                        "number": number,
                        "text": together(printed.pop(number)),
                        "terms": terms,
                        "datasets": origin[number].datasets,
                        "claims": [row for row in judged if row["claim"] in claims],
                    }
                )
        if rows:
            found.append((parser().renderInline(origins.bare(line).strip("| ")), rows))
    return found


def together(words: Sequence[str], shown: int = 6) -> str:
    """Join what an expression prints; of a long table the first words, and their number.

    >>> together(["1.03", "1.04"]), together(["1.03", "1.04", "1.05"], 2)
    ('1.03, 1.04', '1.03, 1.04, … (3 in all)')
    """
    text = ", ".join(words[:shown])
    return text if len(words) <= shown else f"{text}, … ({len(words)} in all)"


def without_dataset(text: str, origin: Sequence[origins.Origin]) -> list[tuple[str, str]]:
    """Return what the expressions without a dataset print, and these expressions."""
    return [
        (", ".join(dict.fromkeys(words)), origin[number].expression)
        for number, words in origins.printed(text).items()
        if not origin[number].datasets
    ]


# Both


def unbroken(page: str) -> str:
    """Keep relations, units and numbers of equations on one line.

    >>> unbroken("for r = 0.55 (1 %), by Eq. 8").replace("\\N{NO-BREAK SPACE}", "_")
    'for r_=_0.55 (1_%), by Eq._8'
    """
    parts = re.split(r"(<pre>.*?</pre>|<code>.*?</code>)", page, flags=re.DOTALL)
    return "".join(each if k % 2 else joined(each) for k, each in enumerate(parts))


def joined(page: str) -> str:
    """Keep relations, units and numbers of equations of a text without code on one line."""
    page = re.sub(r" (=|≤|≥|≈|&lt;|&gt;) ", "\N{NO-BREAK SPACE}\\1\N{NO-BREAK SPACE}", page)
    page = re.sub(r"(?<=\d) (?=%)", "\N{NO-BREAK SPACE}", page)
    numbered = r"\b(Eqs?\.|Figs?\.|Figure|Section|Table) (?=S?\d)"
    return re.sub(numbered, "\\1\N{NO-BREAK SPACE}", page)
