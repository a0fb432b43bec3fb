"""What runs in engines write: docs/validation/*.csv, and the counts in docs/validation.md."""

import csv
import re
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
TABLES = DOCS / "validation"
PAGE = DOCS / "validation.md"
KEPT = {True: "kept", False: "differs", None: "not promised"}
NOT_RUN = "not run"
"""The last cell of a row; of an engine that was not run, whose second cell has the reason."""


def save(name, head, rows):
    """Save rows whose first cell is an engine.

    Those of other engines stay as they are, and those of a run that cannot be made again.
    """
    path = TABLES / f"{name}.csv"
    others = []
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            others = list(csv.reader(file))[1:]
    ran = {row[0] for row in others if row[-1] != NOT_RUN}
    rows = [row for row in rows if row[-1] != NOT_RUN or row[0] not in ran]
    engines = {row[0] for row in rows}
    others = [row for row in others if row[0] not in engines]
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
            link = f"[{path.stem}](validation/{path.name})"
            if last == [NOT_RUN]:
                (reason,) = (row[1] for row in rows if row[0] == engine)
                lines.append(f"| {link} | {engine} | not run: {reason} | | |")
                continue
            promised = len(last) - last.count("not promised")
            counts = f"{len(last)} | {promised} | {last.count('kept')}"
            lines.append(f"| {link} | {engine} | {counts} |")
    part = "\n".join(["<!-- counts -->", "", *lines, "", "<!-- end of counts -->"])
    page = PAGE.read_text("utf-8")
    pattern = re.compile("<!-- counts -->.*<!-- end of counts -->", re.DOTALL)
    PAGE.write_text(pattern.sub(lambda _: part, page), "utf-8")
