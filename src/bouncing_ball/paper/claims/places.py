"""The figures and tables that the place of a claim in the paper names."""

import re

_NAMED = re.compile(r"(Fig|Table)s?\.? ([\d, and-]+)")
_RANGE = re.compile(r"(\d+)(?:-(\d+))?")


def place_of(name: str) -> str:
    """The figure or table of the paper that an artifact is, or the name of any other artifact.

    Examples
    --------
    >>> place_of("fig05"), place_of("table1"), place_of("formulas")
    ('Fig. 5', 'Table 1', 'formulas')
    """
    found = re.fullmatch(r"(fig|table)(\d+)", name)
    return f"{'Fig.' if found[1] == 'fig' else 'Table'} {int(found[2])}" if found else name


def exhibits_in(place: str) -> list[str]:
    """The names of the artifacts of the figures and tables that a place names.

    Examples
    --------
    >>> exhibits_in("Figs. 8 and 9, Table 1"), exhibits_in("Eq. 38, Fig. 16")
    (['fig08', 'fig09', 'table1'], ['fig16'])
    >>> exhibits_in("Figs. 3, 5 and 8-10"), exhibits_in("after Eq. 16")
    (['fig03', 'fig05', 'fig08', 'fig09', 'fig10'], [])
    """
    names = []
    for kind, numbers in _NAMED.findall(place):
        for first, last in _RANGE.findall(numbers):
            for number in range(int(first), int(last or first) + 1):
                names.append(f"fig{number:02}" if kind == "Fig" else f"table{number}")
    return names
