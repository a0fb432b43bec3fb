"""Every file and module that a page names exists."""

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [*ROOT.glob("*.md"), ROOT / "config" / "README.md", *(ROOT / "docs").glob("*.md")]
# The changelog tells of files that are gone; the article is made and has a test of its own.
PAGES = [page for page in PAGES if page.name not in ("CHANGELOG.md", "paper.md", "supplement.md")]
FOLDERS = "src|tests|docs|config|workflow|figures|profiles"
PATH = re.compile(rf"(?<![\w/.-])(?:{FOLDERS})/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball(?:\.\w+)+")
LINK = re.compile(r"\]\(([^):\s#]+)[^):\s]*\)")
# The figure that the recipes of CONTRIBUTING make.
MADE = re.compile("heights")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {ROOT / path for path in PATH.findall(text)}
    linked = {page.parent / path for path in LINK.findall(text)}
    missing = [path for path in named | linked if not path.exists() and not MADE.search(str(path))]
    assert missing == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_module_that_a_page_names_exists(page):
    for name in MODULE.findall(page.read_text(encoding="utf-8")):
        # The longest part that is a module has the rest as an attribute.
        *parts, last = name.split(".")
        module = ".".join(parts)
        assert find_spec(module) is not None, name
        owner = __import__(module, fromlist=[last])
        assert hasattr(owner, last) or find_spec(name) is not None, name
