"""Every file and module that a page names exists, and everything that a docstring refers to."""

import re
from functools import cache
from pathlib import Path

import pytest
from declared_artifacts import ARTIFACTS
from page_checks import every_module_exists, lost_references
from readme import pages

import bouncing_ball

ROOT = Path(__file__).parents[1]
LISTS = [ROOT / "figures" / "README.md", ROOT / "figures" / "beyond" / "README.md"]
PAGES = [*ROOT.glob("*.md"), ROOT / "config" / "README.md", *LISTS, *(ROOT / "docs").glob("*.md")]
# The changelog tells of files that are gone; the article is made and has tests of its own.
MADE_TEXTS = ("paper.md", "supplement.md")
PAGES = [page for page in PAGES if page.name not in ("CHANGELOG.md", *MADE_TEXTS)]
FOLDERS = "src|tests|docs|config|workflow|figures|profiles"
PATH = re.compile(rf"(?<![\w/.-])(?:{FOLDERS})/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball(?:\.\w+)+")
LINK = re.compile(r"\]\(([^):\s#]+)[^):\s]*\)")
# The figure and the study that the recipes of CONTRIBUTING make, and the schema for editors, which
# is made and not in git.
MADE = re.compile("heights|height_levels|schema.json")


def test_the_generated_parts_of_readme_and_the_lists_of_figures_follow_the_record():
    # Otherwise `make readme` writes them.
    for path, text in pages(ROOT, ARTIFACTS).items():
        assert (ROOT / path).read_text(encoding="utf-8") == text, path


def test_readme_shows_the_sixteen_figures_in_their_order():
    shown = re.findall(r'<img src="figures/fig(\d+)\.png"', (ROOT / "README.md").read_text("utf-8"))
    assert shown == [f"{number:02}" for number in range(1, 17)]


def test_every_accepted_file_is_in_the_list_of_its_folder():
    for page in LISTS:
        linked = {page.parent / path for path in LINK.findall(page.read_text("utf-8"))}
        beside = {path for path in page.parent.iterdir() if path.is_file()} - {page}
        assert beside <= linked


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {ROOT / path for path in PATH.findall(text)}
    linked = {page.parent / path for path in LINK.findall(text)}
    missing = [path for path in named | linked if not path.exists() and not MADE.search(str(path))]
    assert missing == []


@cache
def files_of_code():
    """The paths of all modules, scripts and rules, a line each."""
    folders = (ROOT / name for name in ("src", "tests", "workflow", "docs"))
    files = [path for folder in folders for path in folder.rglob("*.[ps][ym]*")]
    return "\n".join(f"/{path.relative_to(ROOT).as_posix()}" for path in files)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_short_name_of_a_file_that_a_page_has_exists(page):
    named = re.findall(r"`([\w/]+\.(?:py|smk))`", page.read_text(encoding="utf-8"))
    missing = [name for name in named if not re.search(rf"/{name}$", files_of_code(), re.M)]
    assert [name for name in missing if not MADE.search(name)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_module_that_a_page_names_exists(page):
    every_module_exists(page, MODULE)


@pytest.mark.slow
def test_everything_that_a_docstring_refers_to_exists():
    assert lost_references(bouncing_ball) == []
