"""Every file, module and command that a page names exists, its examples run, and docstrings refer
to what there is.
"""

import builtins
import doctest
import re
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import matplotlib.pyplot as plt
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.cli.commands import COMMANDS

HOUSE = Path(__file__).parents[1]
DOCS = sorted((HOUSE / "docs").glob("*.md"))
LIST = HOUSE / "figures" / "README.md"
PAGES = [HOUSE / "README.md", LIST, *DOCS]
FOLDERS = "src|tests|docs|config|figures"
PATH = re.compile(rf"(?<![\w/.-])(?:{FOLDERS})/[\w./-]*\w")
MODULE = re.compile(r"\bbouncing_ball_beyond(?:\.\w+)+")
LINK = re.compile(r"(?:\]\(|src=\")([^):\s#\"]+)[^):\s]*[)\"]")
# Pages and files of the house above this one.
ABOVE = "contacts"

every_page = pytest.mark.parametrize(
    "page", PAGES, ids=lambda page: f"{page.parent.name}/{page.name}"
)


@every_page
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    # A page speaks of the files of this house, and now and then of those of the root.
    named = [
        path
        for path in PATH.findall(text)
        if not any((x / path).exists() for x in (HOUSE, HOUSE.parent))
    ]
    linked = [
        path
        for path in LINK.findall(text)
        if not (page.parent / path).exists() and f"/{ABOVE}/" not in path
    ]
    assert (named, linked) == ([], [])


@every_page
def test_every_module_that_a_page_names_exists(page):
    for name in MODULE.findall(page.read_text(encoding="utf-8")):
        # The longest part that is a module has the rest as an attribute.
        *parts, last = name.split(".")
        module = ".".join(parts)
        assert find_spec(module) is not None, name
        assert hasattr(import_module(module), last) or find_spec(name) is not None, name


@every_page
def test_every_command_that_a_page_shows_is_one(page):
    shown = re.findall(r"bouncing-ball ([a-z][\w-]*)", page.read_text(encoding="utf-8"))
    assert {*shown} <= {*COMMANDS, "explain"}


@pytest.mark.parametrize("page", DOCS, ids=lambda page: page.name)
def test_the_examples_of_a_page_run(page):
    plt.switch_backend("agg")
    try:
        found = doctest.testfile(str(page), module_relative=False)
    finally:
        plt.close("all")
    assert found.failed == 0


def test_every_accepted_file_is_in_the_list():
    linked = {LIST.parent / path for path in LINK.findall(LIST.read_text("utf-8"))}
    assert {path for path in LIST.parent.iterdir() if path.is_file()} - {LIST} <= linked


def test_readme_names_every_command():
    text = (HOUSE / "README.md").read_text("utf-8")
    assert [name for name in COMMANDS if f"`{name}" not in text] == []


PACKAGE = Path(bouncing_ball_beyond.__file__).parent
ROLE = re.compile(r":(?:mod|func|class|meth|data|attr|exc):`(?:[^`<]*<)?[~.]*([\w.\s]+)>?`")
# The root has tests of its own names, and some docstrings refer to them.
OTHERS = ("numpy.", "scipy.", "xarray.", "matplotlib.", "pydantic.", "bouncing_ball.", "numerics.")


def dotted(path):
    name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
    return name.removesuffix(".__init__")


@cache
def known_names():
    """Names of all modules, of what they define, and of the attributes of their classes."""
    names = set()
    for path in PACKAGE.rglob("*.py"):
        module = import_module(dotted(path))
        names.add(module.__name__)
        # Public functions are loaded when they are first used: dir names more than vars.
        for name in {*dir(module), *vars(module)}:
            value = vars(module).get(name)
            if isinstance(value, ModuleType):
                continue
            names.add(f"{module.__name__}.{name}")
            if isinstance(value, type):
                attributes = {*dir(value), *getattr(value, "__annotations__", {})}
                names |= {f"{module.__name__}.{name}.{each}" for each in attributes}
    return names


@pytest.mark.slow
def test_everything_that_a_docstring_refers_to_exists():
    ends = {name.split(".", k)[-1] for name in known_names() for k in range(name.count(".") + 1)}
    lost = []
    for path in PACKAGE.rglob("*.py"):
        for name in ROLE.findall(path.read_text(encoding="utf-8")):
            whole = name.startswith("bouncing_ball_beyond")
            elsewhere = name.startswith(OTHERS) or hasattr(builtins, name)
            if not elsewhere and name not in (known_names() if whole else ends):
                lost.append((str(path.relative_to(PACKAGE)), name))
    assert lost == []
