"""Find the dataset and the expression behind each number of a text.

The text is filled in with marks around what each expression of its template prints. `bare` removes
the marks, and the pages turn them into links. One pass over the template finds the datasets that an
expression names, itself or through the names that it uses.
"""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import count

from jinja2.ext import Extension

PART = re.compile(
    r"\{\{ (?P<printed>.+?) \}\}"
    r"|\{% set (?P<set>\w+) = (?P<value>.+?) -?%\}"
    r"|\{% for (?P<each>[\w, ]+) in (?P<values>.+?) %\}"
    r"|\{% macro (?P<macro>\w+)\((?P<arguments>.*?)\)"
    r"|\{%-? (?P<end>endmacro)"
)
"""A part of a template that prints an expression, or that defines a name."""

WORD = re.compile(r'"[^"]*"|(?<![\w.])(?<!\| )(?:given\.)?(\w+)\b(?!=[^=])')
"""A name in an expression, or a text in quotation marks, which has no group. Attributes, filters
and keywords do not match."""

MARK = re.compile("\ue000(\\d+)\ue001(.*?)\ue002")
"""The text that an expression printed, after the index of the expression in its template. The
characters around them are of the private use area of Unicode."""


class Marks(Extension):
    """Mark what the expressions of a template print."""

    def preprocess(self, source: str, name: str | None, filename: str | None = None) -> str:
        place = count()

        def marked(part: re.Match) -> str:
            text = part["printed"]
            return f"{{{{ ({text}) | mark({next(place)}) }}}}" if text else part[0]

        return PART.sub(marked, source)


def mark(value: object, number: int) -> str:
    """Mark a text, or each number that begins a cell if the text is a table. Marks do not nest."""
    text = bare(str(value))
    part = r"(?<=\| )[^|\w\n]*\d[^|\n]*?(?= \|)" if "\n" in text else "^.+$"
    return re.sub(part, f"\ue000{number}\ue001\\g<0>\ue002", text)


def bare(text: str) -> str:
    """Remove the marks from a text."""
    return re.sub("\ue000\\d+\ue001|\ue002", "", text)


def printed(text: str) -> dict[int, list[str]]:
    """Return the texts that each expression printed, by its index in the template."""
    found: dict[int, list[str]] = {}
    for number, words in MARK.findall(text):
        found.setdefault(int(number), []).append(words.replace("**", ""))
    return found


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
) -> list[Origin]:
    """Return the origin of each printed expression of a template, in their order.

    >>> each, = origins("{% set far = fig14.n %}{{ far.max() | fixed(2) }}", ["fig14"])
    >>> each.names, [*each.datasets]
    ({'far': 'far = fig14.n'}, ['fig14'])
    """
    known = {name: Origin("", {}, {name: 0}) for name in datasets}
    known |= {name: Origin("", {}, dict.fromkeys(sources)) for name, sources in behind.items()}
    found: list[Origin] = []
    outside = 0
    for part in PART.finditer(source):
        text = part["printed"] or part["value"] or part["values"] or ""
        used = {word: known[word] for word in WORD.findall(text) if word in known}
        if part["printed"]:
            found.append(together(text, used))
        elif part["set"]:
            known[part["set"]] = together(f"{part['set']} = {text}", used)
        elif part["each"]:
            each = together(f"{part['each']} in {text}", used)
            known |= dict.fromkeys(WORD.findall(part["each"]), each)
        elif part["macro"]:
            macro = part["macro"]
            outside = len(found)
            known |= dict.fromkeys(WORD.findall(part["arguments"]), Origin("", {}, []))
        else:
            known[macro] = together("", {each.expression: each for each in found[outside:]})
    return found


def together(text: str, used: Mapping[str, Origin]) -> Origin:
    """Return the origin of an expression that uses names."""
    names: dict[str, str] = {}
    datasets: dict[str, None] = {}
    for name, origin in used.items():
        names |= origin.names
        names |= {name: origin.expression} if origin.expression else {}
        datasets |= dict.fromkeys(origin.datasets)
    return Origin(text, names, datasets)
