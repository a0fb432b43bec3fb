"""Find the dataset and the expression behind each number of a text.

The text is filled in with marks around what each expression of its template prints. `bare` removes
the marks, and the pages turn them into links. One pass over the template finds the datasets that an
expression names, itself or through the names that it uses. A statement in which this pass would
miss a name is refused.
"""

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from itertools import count

import jinja2
from jinja2.ext import Extension
from jinja2.lexer import Token, TokenStream

STATEMENT = re.compile(
    r"\{\{ (?P<printed>.+) \}\}"
    r"|\{% set (?P<set>\w+) = (?P<value>.+?) -?%\}"
    r"|\{% for (?P<each>[\w, ]+) in (?P<values>.+) %\}"
    r"|\{% macro (?P<macro>\w+)\((?P<arguments>[\w, ]*)\) -?%\}"
    r"|\{%-? (?P<end>endmacro|endfor) %\}"
    r"|\{% (?:if .+|elif .+|else|endif) %\}"
)
"""A statement of a template, on one line."""

SPELLINGS = "{{ x }}, {% set a = x %}, {% for a, b in x %}, {% macro f(a, b) -%} and {% if x %}"

WORD = re.compile(
    r"'(?:[^'\\]|\\.)*'"
    r'|"(?:[^"\\]|\\.)*"'
    r"|(?<![\w.])(?<!\| )(?:given\.)?(\w+)\b(?!=[^=])"
)
"""A name in an expression, or a text in quotation marks, which has no group. Attributes, filters
and keywords do not match."""

MARK = re.compile("\ue000(\\d+)\ue001(.*?)\ue002")
"""The text that an expression printed, after the index of the expression in its template. The
characters around them are of the private use area of Unicode."""


class Marks(Extension):
    """Mark what the expressions of a template print: `{{ x }}` is `{{ (x) | mark("0") }}`."""

    def preprocess(self, source: str, name: str | None, filename: str | None = None) -> str:
        origins(source, (), name=name, filename=filename)
        return source

    def filter_stream(self, stream: TokenStream) -> Iterator[Token]:
        place = count()
        for token in stream:
            if token.type == "variable_end":
                end = [("rparen", ")"), ("pipe", "|"), ("name", "mark")]
                end += [("lparen", "("), ("string", str(next(place))), ("rparen", ")")]
                yield from (Token(token.lineno, *new) for new in end)
            yield token
            if token.type == "variable_begin":
                yield Token(token.lineno, "lparen", "(")


def mark(value: object, number: str) -> str:
    """Mark a text, or each number that begins a cell if the text is a table. Marks do not nest."""
    text = bare(str(value))
    part = r"(?<=\| )[^|\w\n]*\d[^|\n]*?(?= \|)" if "\n" in text else "^.+$"
    return re.sub(part, f"\ue000{number}\ue001\\g<0>\ue002", text)


def bare(text: str) -> str:
    """Remove the marks from a text."""
    return re.sub("\ue000\\d+\ue001|\ue002", "", text)


def printed(text: str) -> dict[int, list[str]]:
    """Return the texts that each expression printed, by its index in the template."""
    texts: dict[int, list[str]] = {}
    for number, words in MARK.findall(text):
        texts.setdefault(int(number), []).append(words.replace("**", ""))
    return texts


@dataclass(frozen=True)
class Origin:
    """The origin of what an expression prints.

    Attributes
    ----------
    expression
        The expression.
    names
        Definitions of the names in the expression, by name, in the order of the template.
    datasets
        Names of the datasets in the expression and in these definitions.
    """

    expression: str
    names: Mapping[str, str]
    datasets: Collection[str]


def origins(
    source: str,
    datasets: Collection[str],
    behind: Mapping[str, Collection[str]] = {},
    name: str | None = None,
    filename: str | None = None,
) -> list[Origin]:
    """Return the origin of each printed expression of a template, in their order.

    `behind` are the datasets behind further names; `name` and `filename` of the template are for
    messages. Raises TemplateSyntaxError for a statement in which a name could be missed: another
    spelling than those of `STATEMENT`, or a second definition of a name.

    >>> number, = origins("{% set far = fig14.n %}{{ far.max() | fixed(2) }}", ["fig14"])
    >>> number.names, [*number.datasets]
    ({'far': 'far = fig14.n'}, ['fig14'])
    """
    known = {"given": Origin("", {}, datasets)}
    known |= {dataset: Origin("", {}, [dataset]) for dataset in datasets}
    known |= {given: Origin("", {}, sources) for given, sources in behind.items()}
    expressions: list[Origin] = []
    free: set[str] = set()
    outside: list[tuple[str, int, dict[str, Origin]]] = []
    for line, text in statements(source, name, filename):
        part = STATEMENT.fullmatch(text)
        if part is None:
            message = f"{text}: write {SPELLINGS}, each on one line"
            raise jinja2.TemplateSyntaxError(message, line, name, filename)
        expression = part["printed"] or part["value"] or part["values"] or ""
        words = WORD.findall(expression)
        used = {word: known[word] for word in words if word in known}
        free |= {*words} - known.keys()
        if (defined := part["set"] or part["macro"]) in free | known.keys():
            message = f"{text}: {defined} has another meaning before: give this another name"
            raise jinja2.TemplateSyntaxError(message, line, name, filename)
        if part["printed"]:
            expressions.append(together(expression, used))
        elif part["set"]:
            known[part["set"]] = together(f"{part['set']} = {expression}", used)
        elif part["each"]:
            outside.append(("", 0, known))
            origin = together(f"{part['each']} in {expression}", used)
            known = known | dict.fromkeys(WORD.findall(part["each"]), origin)
        elif part["macro"]:
            outside.append((part["macro"], len(expressions), known))
            known = known | dict.fromkeys(WORD.findall(part["arguments"]), Origin("", {}, []))
        elif part["end"]:
            macro, first, known = outside.pop()
            if macro:
                known[macro] = together("", {one.expression: one for one in expressions[first:]})
    return expressions


def statements(
    source: str, name: str | None = None, filename: str | None = None
) -> Iterator[tuple[int, str]]:
    """Yield the line and the text of each statement and expression, as Jinja's lexer finds them."""
    jinja = jinja2.Environment()
    jinja.parse(source, name, filename)
    text = ""
    for line, kind, part in jinja.lex(source):
        text = part if kind in ("variable_begin", "block_begin") else text + part
        if kind in ("variable_end", "block_end"):
            yield line, text.rstrip()


def together(text: str, used: Mapping[str, Origin]) -> Origin:
    """Return the origin of an expression that uses names."""
    names: dict[str, str] = {}
    datasets: dict[str, None] = {}
    for name, origin in used.items():
        names |= origin.names
        names |= {name: origin.expression} if origin.expression else {}
        datasets |= dict.fromkeys(origin.datasets)
    return Origin(text, names, datasets)
