"""The pages: what they name exists, and their numbers are those of the data."""

import builtins
import doctest
import re
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import make_data
import pytest
from the_docs import DATA, DOCS

import bouncing_ball_contacts
from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.diff.datasets import compare_datasets

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
    result = doctest.testfile(str(DOCS / "python.md"), module_relative=False)
    assert result.failed == 0 and result.attempted == 16


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    named = {HOUSE / path for path in PATH.findall(text)}
    linked = {page.parent / path for path in LINK.findall(text)}
    assert [path for path in named | linked if not path.exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_module_that_a_page_names_exists(page):
    for name in MODULE.findall(page.read_text(encoding="utf-8")):
        # The longest part that is a module has the rest as an attribute.
        module, _, last = name.rpartition(".")
        assert find_spec(module) is not None, name
        assert hasattr(import_module(module), last) or find_spec(name) is not None, name


SOURCE = Path(bouncing_ball_contacts.__file__).parent
BELOW = ("bouncing_ball_beyond", "bouncing_ball.")
ROLE = re.compile(r":(?:mod|func|class|meth|data|attr|exc):`(?:[^`<]*<)?[~.]*([\w.\s]+)>?`")
OTHERS = ("numpy.", "scipy.", "xarray.", "matplotlib.")


def module_of(path):
    name = ".".join(path.relative_to(SOURCE.parent).with_suffix("").parts)
    return name.removesuffix(".__init__")


def exists(name):
    """Whether a dotted name is a module, or an attribute or a field of one or of its class."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            value = import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            if part in getattr(value, "__annotations__", {}):
                return True
            if not hasattr(value, part):
                return False
            value = getattr(value, part)
        return True
    return False


@cache
def known_names():
    """Names of all modules, of what they define, and of the attributes of their classes."""
    names = set()
    for path in SOURCE.rglob("*.py"):
        module = import_module(module_of(path))
        names.add(module.__name__)
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
    for path in SOURCE.rglob("*.py"):
        for name in ROLE.findall(path.read_text(encoding="utf-8")):
            if name.startswith(OTHERS) or hasattr(builtins, name):
                continue
            found = exists(name) if name.startswith("bouncing_ball") else name in ends
            if not found:
                lost.append((str(path.relative_to(SOURCE)), name))
    assert lost == []
