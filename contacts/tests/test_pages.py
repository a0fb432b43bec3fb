"""The pages: what they name exists, and their numbers are those of the data."""

import re

import make_data
import pytest
from page_checks import every_module_exists, its_examples_run, lost_references
from the_docs import DATA, DOCS

import bouncing_ball_beyond
import bouncing_ball_contacts
from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import compare_datasets

HOUSE = DOCS.parent
PAGES = [HOUSE / "README.md", *sorted(DOCS.glob("*.md"))]
PATH = re.compile(r"(?<![\w/.-])(?:src|tests|docs)/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball(?:_beyond|_contacts)?(?:\.\w+)+")
LINK = re.compile(r"\]\(([^):\s#]+)[^):\s]*\)")


def test_the_parts_of_pages_that_are_made_have_the_numbers_of_the_data():
    # Otherwise `python docs/make_data.py` writes them.
    for page, text in make_data.pages().items():
        assert (DOCS / page).read_text(encoding="utf-8") == text, page


@pytest.mark.parametrize("name", make_data.SHOWN)
def test_a_table_has_the_numbers_of_its_data(name):
    data = read_dataset(DATA / f"{name}.nc")
    for suffix, text in make_data.tables(name, data).items():
        assert (DATA / f"{name}{suffix}").read_text(encoding="utf-8") == text
    assert data.attrs["title"] == make_data.SHOWN[name].title


@pytest.mark.parametrize("name", make_data.STUDIES)
def test_the_data_that_need_no_engine_can_be_made_again(name):
    data = read_dataset(DATA / f"{name}.nc")
    again = make_data.computed(name)
    assert [*again.attrs] == [*data.attrs]
    for each in again.variables.values():
        assert each.attrs["long_name"] and each.attrs["units"]
    rows = compare_datasets(data, again.assign_attrs(data.attrs))
    assert [str(row) for row in rows if not row.outcome.agrees] == []


def test_every_dataset_is_on_a_page_or_beside_it():
    named = " ".join(page.read_text(encoding="utf-8") for page in PAGES)
    for name in make_data.SHOWN:
        assert f"data/{name}.md" in named
        assert make_data.SHOWN[name].draw is None or f"data/{name}.png" in named


@pytest.mark.slow
def test_the_examples_in_python_are_right():
    assert its_examples_run(DOCS / "python.md") == 16


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {HOUSE / path for path in PATH.findall(text)}
    linked = {page.parent / path for path in LINK.findall(text)}
    assert [path for path in named | linked if not path.exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_module_that_a_page_names_exists(page):
    every_module_exists(page, MODULE)


@pytest.mark.slow
def test_everything_that_a_docstring_refers_to_exists():
    assert lost_references(bouncing_ball_contacts, bouncing_ball_beyond) == []
