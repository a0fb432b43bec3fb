"""Pages for a browser: the results, texts in Markdown, and the origins of their numbers."""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any

import xarray as xr
from latex2mathml.converter import convert
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

from paper_replication import origins
from paper_replication.datasets import Datasets
from paper_replication.judgements import claims_of, counted, counts
from paper_replication.templates import environment
from paper_replication.verdicts import Claim


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
        The claims (`judgements.claims_of`).
    table
        Rows of texts, the header first.
    elsewhere
        Names of the figures and tables next to which the dataset decides a claim, too.
    """

    name: str
    title: str
    caption: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    rows: Sequence[Mapping] = ()
    table: Sequence[Sequence[str]] = ()
    elsewhere: Sequence[str] = ()


# The page of the results


SEVERAL = {"several": "Several figures", "": "Statements that no figure shows"}
"""Parts with claims that belong to no single figure or table."""


def parts(
    datasets: Datasets,
    entries: Mapping[str, Mapping],
    claims: Sequence[Claim],
    tables: Mapping[str, Callable[[xr.Dataset], list[list[str]]]],
    elsewhere: str = "",
) -> list[Part]:
    """Return all figures in the order of the paper, tables and datasets, then `SEVERAL`.

    `tables` has the functions of the tables. The claims of the item `elsewhere` are in their table.
    """
    shown_parts = []
    for name in sorted(entries, key=lambda name: (not name.startswith("fig"), name)):
        entry = entries[name]
        kinds = {"dataset": "nc"} if name in datasets else {}
        if "caption" in entry:
            kinds |= {"PNG": "png", "SVG": "svg"}
        if entry.get("table"):
            kinds |= {"CSV": "csv", "Markdown": "md"}
        decided = {claim.beside for claim in claims if name in claim.datasets}
        shown_parts.append(
            Part(
                name,
                title=entry["title"],
                caption=entry.get("caption", ""),
                files={label: f"{name}.{kind}" for label, kind in kinds.items()},
                rows=rows_beside(name, datasets, elsewhere),
                table=tables[name](datasets[name]) if entry.get("table") else (),
                elsewhere=sorted(decided & {*entries}),
            )
        )
    general = [
        Part(key, title, rows=rows_beside(key, datasets, elsewhere))
        for key, title in SEVERAL.items()
    ]
    return shown_parts + general


def rows_beside(name: str, datasets: Datasets, elsewhere: str) -> list[dict]:
    """Return the claims next to a figure or table, without those of the table `elsewhere`."""
    return [
        claim
        for claim in [*counted(datasets["claims"]), *claims_of(datasets["claims"], "own claim")]
        if claim["beside"] == name and claim["item"] != elsewhere
    ]


def shown(datasets: Datasets, every: Sequence[Part]) -> dict[str, Any]:
    """Return what results.html.j2 and templates that extend it show, by names."""
    claims = datasets["claims"]
    return {
        "counts": counts(claims),
        "unasked": sum(claim["verdict"] == "not asked" for claim in counted(claims)),
        "titles": {name: data.attrs["title"] for name, data in datasets.items()},
        "code": {name: next(iter(json.loads(data.code))) for name, data in datasets.items()},
        "parts": every,
        "figures": [part for part in every if "PNG" in part.files],
        "tabulated": [part for part in every if part.table],
        "others": [part for part in every if part.files.keys() == {"dataset"}],
        "general": [part for part in every if not part.files],
    }


def results(title: str, datasets: Datasets, every: Sequence[Part], pages: Mapping[str, str]) -> str:
    """Return the page of the results: verdicts, figures, tables and datasets.

    `pages` are those of the replication, as in `PAGES`.
    """
    template = environment(Path(__file__).parent).get_template("results.html.j2")
    return unbroken(template.render(title=title, pages=pages, **shown(datasets, every)))


# The article and its supplement


PAGES = {
    "index.html": "Results",
    "paper.html": "Article",
    "supplement.html": "Supplement",
    "claims.html": "Evidence",
    "numbers.html": "Numbers",
}
"""The pages of a replication, with their names in the bar at the top. A smaller one has fewer, and
no links to the others."""


def page_of(
    markdown: str,
    name: str,
    origin: Sequence[origins.Origin] = (),
    pages: Mapping[str, str] = PAGES,
) -> str:
    """Return the page of a text in Markdown. `name` is its name in `pages`, such as "paper".

    Formulas become MathML, and pictures SVG. Links to texts lead to their pages, and citations to
    the references. What an expression printed leads to its origin on the page of numbers; `origin`
    has the origins of all expressions.
    """
    tokens = parser().parse(markdown)
    inside = [token for block in tokens for token in (block, *(block.children or ()))]
    for token in inside:
        if token.type == "image":
            token.attrs["src"] = token.attrs["src"].removesuffix(".png") + ".svg"
        elif token.type == "link_open":
            token.attrs["href"] = link(token.attrs["href"], pages)
    contents = name_headings(tokens) or [("", name.title())]
    name_references(tokens)
    name_cells(tokens)
    body = parser().renderer.render(tokens, parser().options, {})
    # A formula stays with the punctuation after it, and with a bracket before it.
    inline = r'(\(?<span class="math inline">(?:(?!</span>).)*</span>[.,;:)]+)'
    body = re.sub(inline, r'<span class="whole">\1</span>', body)
    return framed(with_origins(with_links(body, pages), name, origin), name, contents, pages)


def framed(
    body: str,
    name: str,
    contents: Sequence[tuple[str, str]],
    pages: Mapping[str, str] = PAGES,
) -> str:
    """Return a page of text. `contents` are anchors and texts of its headings, the title first."""
    template = environment(Path(__file__).parent).get_template("pages.html.j2")
    (_, title), *headings = contents
    return unbroken(
        template.render(name=name, title=title, contents=headings, body=body, pages=pages)
    )


def with_origins(body: str, name: str, origin: Sequence[origins.Origin]) -> str:
    """Link what the expressions printed, if they name a dataset."""

    def linked(mark: re.Match) -> str:
        number = int(mark[1])
        text = mark[2]
        if not origin[number].datasets:
            return text
        title = escape(origin[number].expression)
        return f'<a class="number" href="numbers.html#{name}-{number}" title="{title}">{text}</a>'

    return origins.MARK.sub(linked, body)


@cache
def parser() -> MarkdownIt:
    """The parser of our texts: Markdown with tables, line breaks in cells, and formulas."""
    markdown = MarkdownIt("commonmark").enable("table")
    return markdown.use(dollarmath_plugin, renderer=formula, allow_digits=False)


def formula(tex: str, options: Mapping) -> str:
    """A formula as MathML. A displayed one is split at its wide spaces, where a line may break.

    The number of an equation stays with its formula.
    """
    tex = origins.bare(tex)
    # The library leaves no space around the names of functions.
    tex = re.sub(r"(?<=[\w}])(?=\\(?:sin|cos|ln)\b)", r"\\,", tex)
    tex = re.sub(r"(\\(?:sin|cos|ln|max))(?=\\| )", r"\1\\,", tex)
    if not options["display_mode"]:
        return convert(tex)
    numbered = re.split(r"\\q?quad(?!\s*\\text\{\()", tex)
    return "".join(
        f'<span class="numbered">{"".join(convert(part, display="block") for part in parts)}</span>'
        for parts in (re.split(r"\\q?quad", part) for part in numbered)
    )


def link(target: str, pages: Mapping[str, str] = PAGES) -> str:
    """Where a link of a text leads in a browser. The page of a table is a part of claims.html.

    >>> link("supplement.md"), link("figures/table1.md"), link("figures/claims.csv")
    ('supplement.html', 'claims.html#table1', 'figures/claims.csv')
    """
    special = {"figures/README.md": "index.html", "figures/claims.md": "claims.html"}
    page = special.get(target, target.replace(".md", ".html"))
    if page in pages:
        return page
    table = re.fullmatch(r"figures/(\w+)\.md", target)
    return f"claims.html#{table[1]}" if table and "claims.html" in pages else target


def name_headings(tokens: Sequence[Token]) -> list[tuple[str, str]]:
    """Give each heading its number as an anchor, and return anchors and texts."""
    headings = []
    for heading, text in pairwise(tokens):
        if heading.type == "heading_open":
            words = origins.bare(text.content)
            number = re.match(r"S?\d[\d.]*", words)
            anchor = f"section-{number[0].rstrip('.')}" if number else words.lower()
            heading.attrs["id"] = anchor
            if heading.tag != "h3":
                headings.append((anchor, words))
    return headings


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


def with_links(body: str, pages: Mapping[str, str] = PAGES) -> str:
    """Link figures, citations, sections and identifiers of documents in a text in HTML."""

    def linked(text: str, page: str, anchor: str) -> str:
        return f'<a href="{page}#{anchor}">{text}</a>' if page in pages else text

    def figures(match: re.Match) -> str:
        return match[1] + linked(match[3], "index.html", match[2])

    def sections(match: re.Match) -> str:
        page = "supplement.html" if match[1].startswith("S") else "paper.html"
        return linked(match[0], page, f"section-{match[1]}")

    def citations(match: re.Match) -> str:
        return re.sub(r"\d+", lambda n: linked(n[0], "paper.html", f"reference-{n[0]}"), match[0])

    caption = r'(<img src="figures/(\w+)\.svg"[^>]*>\s*)(<strong>.*?</strong>)'
    body = re.sub(caption, figures, body)
    body = re.sub(r"\bSection (S?\d(?:\.\d)?)", sections, body)
    body = re.sub(r"\[\d+(?:, \d+)*\]", citations, body)
    return re.sub(r"doi:(10\.[^\s<]+[^\s<.,])", r'<a href="https://doi.org/\1">\g<0></a>', body)


# The page of numbers


def numbers(
    texts: Mapping[str, str],
    origin: Mapping[str, Sequence[origins.Origin]],
    datasets: Datasets,
    pages: Mapping[str, str] = PAGES,
    functions: Sequence[str] = (),
    elsewhere: str = "",
) -> str:
    """Return the page of what the texts print: sentences, expressions, datasets and claims.

    `texts` have marks, and `origin` has the origins of their expressions. `functions` are the
    modules of the functions in expressions. The claims of the item `elsewhere` are in their table.
    """
    judged = counted(datasets["claims"])
    sentences = {name: sentences_of(text, origin[name], judged) for name, text in texts.items()}
    every = [row for listed in sentences.values() for _, rows in listed for row in rows]
    terms = [row["terms"][0].partition(" | ")[0] for row in every]
    examples = (
        term
        for term in terms
        if re.fullmatch(r"\w+\.\w+", term) and term.partition(".")[0] in datasets
    )
    template = environment(Path(__file__).parent).get_template("numbers.html.j2")
    contents = [
        ("", "Where the numbers come from"),
        *((name, name.title()) for name in texts),
    ]
    body = template.render(
        texts=sentences,
        example=next(examples, ""),
        functions=functions,
        elsewhere=elsewhere,
        pages=pages,
    )
    return framed(body, "numbers", contents, pages)


def sentences_of(
    text: str, origin: Sequence[origins.Origin], judged: Sequence[Mapping]
) -> list[tuple[str, list[dict]]]:
    """Return the sentences whose expressions name a dataset, with what each expression prints.

    An expression of several lines, as in tables, is listed with the first.
    """
    printed = origins.printed(text)
    sentences = []
    for line in text.splitlines():
        rows = []
        for number in origins.printed(line):
            if origin[number].datasets and number in printed:
                terms = [origin[number].expression, *dict.fromkeys(origin[number].names.values())]
                claims = re.findall(r'claim\["(.+?)"\]', " ".join(terms))
                rows.append(
                    {
                        "number": number,
                        "text": ", ".join(printed.pop(number)),
                        "terms": terms,
                        "datasets": origin[number].datasets,
                        "claims": [row for row in judged if row["claim"] in claims],
                    }
                )
        if rows:
            sentences.append((parser().renderInline(origins.bare(line).strip("| ")), rows))
    return sentences


# Both


def unbroken(page: str) -> str:
    """Keep relations, units and numbers of equations on one line.

    >>> unbroken("for r = 0.55 (1 %), by Eq. 8").replace("\\N{NO-BREAK SPACE}", "_")
    'for r_=_0.55 (1_%), by Eq._8'
    """
    parts = re.split(r"(<pre>.*?</pre>|<code>.*?</code>)", page, flags=re.DOTALL)
    return "".join(part if k % 2 else joined(part) for k, part in enumerate(parts))


def joined(page: str) -> str:
    """Keep relations, units and numbers of equations of a text without code on one line."""
    page = re.sub(r" (=|≤|≥|≈|&lt;|&gt;) ", "\N{NO-BREAK SPACE}\\1\N{NO-BREAK SPACE}", page)
    page = re.sub(r"(?<=\d) (?=%)", "\N{NO-BREAK SPACE}", page)
    numbered = r"\b(Eqs?\.|Figs?\.|Figure|Section|Table) (?=S?\d)"
    return re.sub(numbered, "\\1\N{NO-BREAK SPACE}", page)
