"""What runs in engines write: docs/validation/*.csv, and tables of them in docs/validation.md."""

import csv
import re
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
TABLES = DOCS / "validation"
PAGE = DOCS / "validation.md"
KEPT = {True: "kept", False: "differs", None: "not promised"}
NOT_RUN = "not run"
"""The last cell of a row; of an engine that was not run, whose second cell has the reason."""


def rows_of(name):
    """Return the saved rows, without the head."""
    path = TABLES / f"{name}.csv"
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.reader(file))[1:]


def save(name, head, rows):
    """Save rows whose first cell is an engine.

    Those of other engines stay as they are, and those of a run that cannot be made again.
    """
    path = TABLES / f"{name}.csv"
    others = rows_of(name)
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
    """Write how many promises are kept, by table, into the page."""
    lines = ["| table | engines | rows | promised | kept |", "| --- | --- | --- | --- | --- |"]
    missing = []
    for path in sorted(TABLES.glob("*.csv")):
        rows = rows_of(path.stem)
        named = ", ".join(row[0] for row in rows if row[-1] == NOT_RUN)
        missing += [f"{path.stem}: {named}"] * bool(named)
        last = [row[-1] for row in rows if row[-1] != NOT_RUN]
        engines = len({row[0] for row in rows if row[-1] != NOT_RUN})
        counts = f"{len(last)} | {len(last) - last.count('not promised')} | {last.count('kept')}"
        lines.append(f"| [{path.stem}](validation/{path.name}) | {engines} | {counts} |")
    lines += ["", f"Not run, for a reason that the table has: {'; '.join(missing)}."]
    write_part("counts", lines)


def write_part(name, lines):
    """Write lines between two comments of the page."""
    part = "\n".join([f"<!-- {name} -->", "", *lines, "", f"<!-- end of {name} -->"])
    pattern = re.compile(f"<!-- {name} -->.*<!-- end of {name} -->", re.DOTALL)
    PAGE.write_text(pattern.sub(lambda _: part, PAGE.read_text("utf-8")), "utf-8")
