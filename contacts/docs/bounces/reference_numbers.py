"""Bounce heights and times with certified digits, as CSV and JSON: for test suites of engines."""

import csv
import json
from pathlib import Path

from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.documents.certified_bounces import enclosed_rebounds, hard, rounded_ball

FOLDER = Path(__file__).with_name("reference")
HEIGHT, GRAVITY, COUNT = "1", "9.81", 3
COLUMNS = ("impact_time", "release_time", "top_time", "impact_speed", "top_height")


def rows():
    """The cases and their bounces; all numbers are texts, in SI units."""
    given = {"drop_height": HEIGHT, "gravity": GRAVITY}
    for r in ("0.3", "0.5", "0.75", "0.9", "1"):
        yield given | {"rule": "restitution", "r": r}, hard(r, HEIGHT, GRAVITY, COUNT)
    for k, c in (("1e4", "5"), ("1e4", "20"), ("1e4", "60"), ("1e6", "50"), ("1e6", "200")):
        for rule in map(str, Release):
            contact = ("1", k, c)
            case = {"rule": rule, "mass": "1", "stiffness": k, "damping": c}
            yield given | case, enclosed_rebounds(rule, contact, HEIGHT, GRAVITY, COUNT)


def main():
    table = []
    for case, bounces in rows():
        for number, one in enumerate(bounces, 1):
            balls = (one.impact, one.release, one.top, one.speed, one.height)
            values = dict(zip(COLUMNS, map(rounded_ball, balls), strict=True))
            table.append(case | {"bounce": str(number)} | values)
    names = list(dict.fromkeys(name for row in reversed(table) for name in row))
    FOLDER.mkdir(exist_ok=True)
    with (FOLDER / "bounces.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)
    (FOLDER / "bounces.json").write_text(json.dumps(table, indent=1) + "\n")
    print(f"{len(table)} bounces of {sum(1 for _ in rows())} balls")


if __name__ == "__main__":
    main()
