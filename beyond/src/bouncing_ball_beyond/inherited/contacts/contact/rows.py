"""One table of rows for each result: its text, the page and JSON are made from them.

A result is a frozen dataclass. A field that a reader is shown is annotated with a :class:`Listed`;
JSON has all fields under their names, or what the class lists in ``KEYS``, properties included,
whose results are annotated alike; ``KEYS`` may also map names in JSON to those of attributes.
"""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple, get_type_hints

from bouncing_ball_beyond.inherited.contacts.contact.texts import shown


class Listed(NamedTuple):
    """How a result is listed: its description, and its unit for :func:`~.texts.shown`.

    ``none`` and ``zero`` are what is printed for None and, if it is not empty, for 0.
    """

    words: str
    unit: str = ""
    none: str = "none"
    zero: str = ""


class Entry(NamedTuple):
    """A number or a text of a result.

    ``key`` is the path of its name in JSON. Rows without ``words`` are in JSON only. The value is
    in the SI unit; a share has the unit "%".
    """

    key: tuple[str, ...]
    words: str
    unit: str
    value: Any
    none: str = "none"
    zero: str = ""

    @property
    def text(self) -> str:
        """The value as it is printed: with four digits and a prefix of its unit."""
        if isinstance(self.value, bool):
            return "yes" if self.value else "no"
        if isinstance(self.value, str):
            return self.value
        if self.value is None:
            return self.none
        if self.value == 0 and self.zero:
            return self.zero
        return shown(self.value, self.unit)


def rows(result: Any) -> list[Entry]:
    """The rows of a result in the order of its fields, including those of nested results.

    A field that holds a dict has one description for each of its values.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.assess import LargestTimeStep
    >>> [tuple(row)[:4] for row in rows(LargestTimeStep(2e-6, "a rule"))]
    [(('largest',), 'largest time step', 's', 2e-06), (('rule',), '', '', 'a rule')]
    """
    found: list[Entry] = []
    keys = getattr(result, "KEYS", None) or [field.name for field in fields(result)]
    for name in keys:
        attribute = keys[name] if isinstance(keys, Mapping) else name
        value = getattr(result, attribute)
        listed = _listed(type(result), attribute)
        if isinstance(value, Mapping) and listed:
            of_values = zip(value.items(), listed, strict=True)
            found += [
                Entry((name, key), each.words, each.unit, one) for (key, one), each in of_values
            ]
        elif is_dataclass(value):
            found += [row._replace(key=(name, *row.key)) for row in rows(value)]
        else:
            how = listed[0] if listed else Listed("")
            found.append(Entry((name,), how.words, how.unit, value, how.none, how.zero))
    return found


def _listed(kind: type, attribute: str) -> tuple[Any, ...]:
    """How an attribute is listed, a field or a property; empty if it is in JSON only."""
    member = getattr(kind, attribute, None)
    if isinstance(member, property):
        hint = get_type_hints(member.fget, include_extras=True).get("return")
    else:
        hint = get_type_hints(kind, include_extras=True).get(attribute)
    return getattr(hint, "__metadata__", ())


def texts(result: Any) -> list[tuple[str, str]]:
    """Description and printed value of each row that is shown to a reader.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.assess import LargestTimeStep
    >>> texts(LargestTimeStep(2e-6, "a rule"))
    [('largest time step', '2 µs')]
    """
    return [(row.words, row.text) for row in rows(result) if row.words]


def document(result: Any) -> dict[str, Any]:
    """A result as plain values for JSON, under the names of its fields.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.assess import LargestTimeStep
    >>> document(LargestTimeStep(2e-6, "a rule"))
    {'largest': 2e-06, 'rule': 'a rule'}
    """
    found: dict[str, Any] = {}
    for row in rows(result):
        place = found
        for name in row.key[:-1]:
            place = place.setdefault(name, {})
        place[row.key[-1]] = _plain(row.value)
    return found


def _plain(value: Any) -> Any:
    """A value as JSON has it; nested results, lists and dicts with their values."""
    if is_dataclass(value):
        return document(value)
    if isinstance(value, Mapping):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(one) for one in value]
    return value
