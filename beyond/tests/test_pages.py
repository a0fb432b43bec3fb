"""Every file, module and command that a page names exists, its examples run, and docstrings refer
to what there is.
"""

import re
from pathlib import Path

import pytest
from page_checks import every_module_exists, its_examples_run, lost_references

import bouncing_ball_beyond
from bouncing_ball_beyond.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.cli.commands import COMMANDS as INHERITED
from bouncing_ball_beyond.inherited.contacts.cli.commands import COMMANDS as OF_CONTACTS

HOUSE = Path(__file__).resolve().parents[1]
DOCS = sorted((HOUSE / "docs").rglob("*.md"))
LIST = HOUSE / "figures" / "README.md"
PAGES = [HOUSE / "README.md", LIST, *DOCS]
FOLDERS = "src|tests|docs|config|figures"
PATH = re.compile(rf"(?<![\w/.-])(?:{FOLDERS})/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball_beyond(?:\.\w+)+")
LINK = re.compile(r"(?:\]\(|src=\")([^):\s#\"]+)[^):\s]*[)\"]")
FIRST_LESSON = ("inherited", "lesson.md")

every_page = pytest.mark.parametrize(
    "page", PAGES, ids=lambda page: f"{page.parent.name}/{page.name}"
)


@every_page
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {HOUSE / path for path in PATH.findall(text)}
    linked = {(page.parent / path).resolve() for path in LINK.findall(text)}
    # Other packages of the repository have pages of their own.
    ours = {path for path in named | linked if path.is_relative_to(HOUSE)}
    assert [path for path in ours if not path.exists()] == []


@every_page
def test_every_module_that_a_page_names_exists(page):
    every_module_exists(page, MODULE)


@every_page
def test_every_command_that_a_page_shows_is_one(page):
    shown = re.findall(r"bouncing-ball ([a-z][\w-]*)", page.read_text(encoding="utf-8"))
    assert {*shown} <= {*COMMANDS, *INHERITED, *OF_CONTACTS}


# The first part of the lesson draws pictures, and has a test of them.
EXAMPLES = [page for page in (HOUSE / "README.md", *DOCS) if page.parts[-2:] != FIRST_LESSON]


@pytest.mark.parametrize("page", EXAMPLES, ids=lambda page: f"{page.parent.name}/{page.name}")
def test_the_examples_of_a_page_run(page):
    its_examples_run(page)


def test_every_accepted_file_is_in_the_list():
    linked = {LIST.parent / path for path in LINK.findall(LIST.read_text("utf-8"))}
    assert {path for path in LIST.parent.iterdir() if path.is_file()} - {LIST} <= linked


def test_readme_names_every_command():
    text = (HOUSE / "README.md").read_text("utf-8")
    assert [name for name in COMMANDS if f"`{name}" not in text] == []


@pytest.mark.slow
def test_everything_that_a_docstring_refers_to_exists():
    assert lost_references(bouncing_ball_beyond) == []
