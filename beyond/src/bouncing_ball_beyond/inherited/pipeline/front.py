"""The generated parts of a page, which stand between comments; the rest is written by hand."""

from collections.abc import Mapping


def with_parts(page: str, parts: Mapping[str, str]) -> str:
    """The page with new texts between the comments ``<!-- name -->`` and ``<!-- end of name -->``.

    Raises
    ------
    KeyError
        If the page has no such comments.

    Examples
    --------
    >>> page = "One.\\n<!-- two -->\\nold\\n<!-- end of two -->\\nThree.\\n"
    >>> with_parts(page, {"two": "Two.\\n"}) == page.replace("old", "\\nTwo.\\n")
    True
    """
    for name, text in parts.items():
        begin = f"<!-- {name} -->\n"
        end = f"<!-- end of {name} -->\n"
        before, found, rest = page.partition(begin)
        _, also_found, after = rest.partition(end)
        if not (found and also_found):
            raise KeyError(name)
        page = f"{before}{begin}\n{text}\n{end}{after}"
    return page
