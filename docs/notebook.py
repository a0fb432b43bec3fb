"""The lesson as a notebook: ``python docs/notebook.py`` writes it beside the page."""

import json
import re
from doctest import DocTestParser
from pathlib import Path

PAGE = Path(__file__).with_name("lesson.md")


def parts(block: str) -> list[str]:
    """The code of a block; what prints something ends a cell, which so shows it."""
    cells = [""]
    for example in DocTestParser().get_examples(block):
        cells[-1] += example.source
        cells += [""] if example.want else []
    return [cell.rstrip() for cell in cells if cell]


def notebook(page: str) -> str:
    """The notebook of a page, without what the code prints."""
    cells = [("code", "%matplotlib inline")]
    for k, part in enumerate(re.split(r"```python\n(.*?)```\n", page, flags=re.DOTALL)):
        if k % 2:
            cells += [("code", code) for code in parts(part)]
        elif text := re.sub(r"^!\[.*\)$\n", "", part, flags=re.MULTILINE).strip():
            # The pictures are drawn by the cells.
            cells.append(("markdown", text))
    code = {"execution_count": None, "outputs": []}
    document = {
        "cells": [
            {"cell_type": kind, "id": f"cell-{k}", "metadata": {}, "source": text}
            | (code if kind == "code" else {})
            for k, (kind, text) in enumerate(cells)
        ],
        "metadata": {"language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


if __name__ == "__main__":
    PAGE.with_suffix(".ipynb").write_text(notebook(PAGE.read_text("utf-8")), encoding="utf-8")
