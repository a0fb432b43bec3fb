"""The dictionary of the datasets has every variable of the record, and is current."""

from pathlib import Path

from declared_artifacts import ARTIFACTS

from bouncing_ball.pipeline.dataset_docs import dictionary

PAGE = Path(__file__).resolve().parents[2] / "docs" / "datasets.md"


def test_the_page_is_that_of_the_record(recorded):
    page = PAGE.read_text(encoding="utf-8")
    assert page == dictionary(ARTIFACTS.values(), recorded), "run `make config-docs`"


def test_every_variable_of_the_record_has_a_row(recorded):
    sections = PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    by_name = {section.partition("\n")[0]: section for section in sections}
    assert by_name.keys() == recorded.keys()
    for name, data in recorded.items():
        rows = by_name[name].splitlines()
        for variable in data.variables:
            (row,) = (row for row in rows if row.startswith(f"| `{variable}` |"))
            # The name, five cells about it, and nothing empty but symbols and equations.
            cells = [cell.strip() for cell in row.replace(r"\|", "").strip("|").split("|")]
            assert len(cells) == 6 and cells[2] and cells[5]
