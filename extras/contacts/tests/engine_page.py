"""docs/validation.md: what the runs in the engines write."""

import re
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"


def said(pattern):
    """Return what a pattern finds in the lines of the page."""
    return re.findall(pattern, PAGE.read_text("utf-8"), re.MULTILINE)


def write(name, lines):
    """Replace the part of the page between the comments of a name, or add it at the end."""
    start, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    part = "\n".join([start, "", *lines, "", end])
    page = PAGE.read_text("utf-8") if PAGE.exists() else "# Validation\n"
    pattern = re.compile(re.escape(start) + ".*?" + re.escape(end), re.DOTALL)
    if pattern.search(page):
        page = pattern.sub(lambda _: part, page)
    else:
        page = f"{page.rstrip()}\n\n{part}\n"
    PAGE.write_text(page, "utf-8")
