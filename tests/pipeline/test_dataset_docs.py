"""The dictionary of the datasets has every variable of the record, and is current."""

from pathlib import Path

import pytest
from declared_artifacts import ARTIFACTS

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.dataset_docs import dictionary, in_record

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "variables.md"


@pytest.fixture(scope="module")
def accepted():
    """The accepted datasets by the names of their artifacts."""
    paths = {one.name: ROOT / in_record(one.dataset) for one in ARTIFACTS.values() if one.dataset}
    return {name: read_dataset(path) for name, path in paths.items() if path.is_file()}


def test_the_page_is_that_of_the_record(accepted):
    page = PAGE.read_text(encoding="utf-8")
    assert len(accepted) > 30
    assert page == dictionary(ARTIFACTS.values(), accepted), "run `make config-docs`"


def test_every_variable_of_the_record_has_a_row(accepted):
    sections = PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    by_name = {section.partition("\n")[0]: section for section in sections}
    assert by_name.keys() == accepted.keys()
    for name, data in accepted.items():
        rows = by_name[name].splitlines()
        for variable in data.variables:
            (row,) = (row for row in rows if row.startswith(f"| `{variable}` |"))
            # The name, five cells about it, and nothing empty but symbols and equations.
            cells = [cell.strip() for cell in row.replace(r"\|", "").strip("|").split("|")]
            assert len(cells) == 6 and cells[2] and cells[5]
