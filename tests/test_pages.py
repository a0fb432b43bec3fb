"""Every file, module and command that a page names exists, its examples run, and docstrings refer
to what there is.
"""

import re
from functools import cache
from pathlib import Path

import pytest
from page_checks import every_module_exists, its_examples_run, lost_references
from readme import pages

import bouncing_ball
from bouncing_ball.cli.commands import COMMANDS, how_to_install
from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.datasets.selection import each

ROOT = Path(__file__).parents[1]
LIST = ROOT / "figures" / "README.md"
DOCS = sorted((ROOT / "docs").glob("*.md"))
PAGES = [*sorted(ROOT.glob("*.md")), ROOT / "config" / "README.md", LIST, *DOCS]
# The changelog tells of files that are gone; the article is made and has tests of its own.
MADE_TEXTS = ("paper.md", "supplement.md")
PAGES = [page for page in PAGES if page.name not in ("CHANGELOG.md", *MADE_TEXTS)]
FOLDERS = "src|tests|docs|config|workflow|figures|profiles|beyond|contacts"
PATH = re.compile(rf"(?<![\w/.-])(?:{FOLDERS})/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball(?:\.\w+)+")
LINK = re.compile(r"\]\(([^):\s#]+)[^):\s]*\)")
# The figure and the study that the recipes of CONTRIBUTING make, and the schema for editors, which
# is made and not in git.
MADE = re.compile("heights|height_levels|compute_level|schema.json")

every_page = pytest.mark.parametrize(
    "page", PAGES, ids=lambda page: f"{page.parent.name}/{page.name}"
)


def test_the_generated_parts_of_readme_and_the_list_of_figures_follow_the_record():
    # Otherwise `make readme` writes them.
    for path, text in pages(ROOT).items():
        assert (ROOT / path).read_text(encoding="utf-8") == text, path


def test_readme_shows_the_sixteen_figures_in_their_order():
    shown = re.findall(r'<img src="figures/fig(\d+)\.png"', (ROOT / "README.md").read_text("utf-8"))
    assert shown == [f"{number:02}" for number in range(1, 17)]


def test_the_page_of_the_figures_has_all_of_them_and_what_the_paper_says_of_them():
    text = LIST.read_text("utf-8")
    shown = re.findall(r'<img src="fig(\d+)\.png"', text)
    assert shown == [f"{number:02}" for number in range(1, 17)] and "| Table 1:" in text
    data = read_dataset(ROOT / "figures/claims.nc")
    for row in each(data, "claim"):
        if "Fig" in row["item"].item() or row["item"].item() == "Table 1":
            printed = row.printed_table.item()
            assert printed or f"| {row.statement.item()} | *{row.verdict.item()}*: " in text


def test_every_accepted_file_is_in_the_list():
    linked = {LIST.parent / path for path in LINK.findall(LIST.read_text("utf-8"))}
    assert {path for path in LIST.parent.iterdir() if path.is_file()} - {LIST} <= linked


@every_page
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {ROOT / path for path in PATH.findall(text)}
    linked = {page.parent / path for path in LINK.findall(text)}
    missing = [path for path in named | linked if not path.exists() and not MADE.search(str(path))]
    assert missing == []


@every_page
def test_every_command_that_a_page_shows_is_one(page):
    shown = re.findall(r"bouncing-ball ([a-z][\w-]*)", page.read_text(encoding="utf-8"))
    assert [name for name in shown if name not in COMMANDS and not how_to_install(name)] == []


# The lesson draws pictures, and has a test of them.
@pytest.mark.parametrize(
    "page", [page for page in DOCS if page.name != "lesson.md"], ids=lambda page: page.name
)
def test_the_examples_of_a_page_run(page, monkeypatch):
    monkeypatch.chdir(page.parent)
    shown = re.findall("^>>> ", page.read_text(encoding="utf-8"), re.M)
    assert its_examples_run(page) == len(shown)


@cache
def files_of_code():
    """The paths of all modules, scripts and rules, a line each."""
    folders = (ROOT / name for name in ("src", "tests", "workflow", "docs", "beyond", "contacts"))
    files = [path for folder in folders for path in folder.rglob("*.[ps][ym]*")]
    return "\n".join(f"/{path.relative_to(ROOT).as_posix()}" for path in files)


@every_page
def test_every_short_name_of_a_file_that_a_page_has_exists(page):
    named = re.findall(r"`([\w/]+\.(?:py|smk))`", page.read_text(encoding="utf-8"))
    missing = [name for name in named if not re.search(rf"/{name}$", files_of_code(), re.M)]
    assert [name for name in missing if not MADE.search(name)] == []


@every_page
def test_every_module_that_a_page_names_exists(page):
    every_module_exists(page, MODULE, but=MADE)


@pytest.mark.slow
def test_everything_that_a_docstring_refers_to_exists():
    assert lost_references(bouncing_ball) == []
