"""The reference numbers of bounces are those that their script writes."""

import csv
import json
import runpy
import shutil
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "docs" / "bounces"


def test_the_files_are_those_that_the_script_writes(tmp_path):
    shutil.copy(FOLDER / "reference_numbers.py", tmp_path)
    runpy.run_path(str(tmp_path / "reference_numbers.py"))["main"]()
    for name in ("bounces.csv", "bounces.json"):
        made = (tmp_path / "reference" / name).read_text()
        assert made == (FOLDER / "reference" / name).read_text()
    rows = json.loads((FOLDER / "reference" / "bounces.json").read_text())
    with (FOLDER / "reference" / "bounces.csv").open() as file:
        assert [{k: v for k, v in row.items() if v} for row in csv.DictReader(file)] == rows
