"""Which figures, tables and equations a place in the paper names."""

import re


def places(text: str) -> set[str]:
    """The single items named in a text such as "Figs. 8-10 and Table 1".

    Examples
    --------
    >>> sorted(places("Figs. 5, 6 and 8-10, Table 1"))
    ['Fig. 10', 'Fig. 5', 'Fig. 6', 'Fig. 8', 'Fig. 9', 'Table 1']
    """
    found = set()
    for kind, numbers in re.findall(r"(Fig|Eq|Table)s?\.? ((?:\d+(?:-\d+)?(?:, | and )?)+)", text):
        dot = "" if kind == "Table" else "."
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", numbers):
            span = range(int(first), int(last or first) + 1)
            found |= {f"{kind}{dot} {number}" for number in span}
    return found
