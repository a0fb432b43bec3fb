"""Numbers of sections, figures and tables, and the references to them."""

import re
from collections import Counter

_HEADING = re.compile(r"^(##+) (?!Abstract|References)(.+)$", re.MULTILINE)
# The first words of a caption, and a reference from anywhere.
_CAPTION = re.compile(r"\*\*(Figure|Table) «(\w+)»")
_REFERENCE = re.compile(r"«([^»\n]+)»")


def numbered(text: str) -> str:
    """The text with numbers in its headings and in place of the references ``«name»``.

    The name of a section is its heading. Figures and tables are numbered in the order of their
    captions, ``**Figure «name»`` and ``**Table «name»``. The numbers follow those of the 16 figures
    and the table of the paper; in a supplement they begin with S1.

    Raises
    ------
    KeyError
        If no section, figure or table has the name of a reference.

    Examples
    --------
    >>> print(numbered("## Models\\n### Flight\\n**Figure «ball».** See «Flight».\\n## Results"))
    ## 1. Models
    ### 1.1 Flight
    **Figure 17.** See 1.1.
    ## 2. Results
    """
    numbers: dict[str, str] = {}
    section = part = 0

    def heading(found: re.Match[str]) -> str:
        nonlocal section, part
        section, part = (section + 1, 0) if found[1] == "##" else (section, part + 1)
        numbers[found[2]] = f"{prefix}{section}.{part}" if part else f"{prefix}{section}"
        return f"{found[1]} {numbers[found[2]]}{'' if part else '.'} {found[2]}"

    prefix = "S" if text.startswith("# Supplement") else ""
    text = _HEADING.sub(heading, text)
    count = Counter() if prefix else Counter(Figure=16, Table=1)
    for kind, name in _CAPTION.findall(text):
        count[kind] += 1
        numbers[name] = f"{prefix}{count[kind]}"
    return _REFERENCE.sub(lambda found: numbers[found[1]], text)
