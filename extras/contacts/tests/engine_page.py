"""What runs in engines write: docs/validation/*.csv, and the counts in docs/validation.md."""

import csv
import re
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
TABLES = DOCS / "validation"
PAGE = DOCS / "validation.md"
KEPT = {True: "kept", False: "differs", None: "not promised"}
"""The last cell of a row."""


def save(name, head, rows):
    """Save rows whose first cell is an engine; those of other engines stay as they are."""
    path = TABLES / f"{name}.csv"
    engines = {row[0] for row in rows}
    others = []
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            others = [row for row in list(csv.reader(file))[1:] if row[0] not in engines]
    TABLES.mkdir(exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([head, *sorted([*others, *rows], key=lambda row: row[0])])
    _count()


def _count():
    """Write how many promises are kept, by table and engine, into the page."""
    lines = ["| table | engine | rows | promised | kept |", "| --- | --- | --- | --- | --- |"]
    for path in sorted(TABLES.glob("*.csv")):
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))[1:]
        for engine in dict.fromkeys(row[0] for row in rows):
            last = [row[-1] for row in rows if row[0] == engine]
            promised = len(last) - last.count("not promised")
            link = f"[{path.stem}](validation/{path.name})"
            counts = f"{len(last)} | {promised} | {last.count('kept')}"
            lines.append(f"| {link} | {engine} | {counts} |")
    part = "\n".join(["<!-- counts -->", "", *lines, "", "<!-- end of counts -->"])
    page = PAGE.read_text("utf-8")
    pattern = re.compile("<!-- counts -->.*<!-- end of counts -->", re.DOTALL)
    PAGE.write_text(pattern.sub(lambda _: part, page), "utf-8")
