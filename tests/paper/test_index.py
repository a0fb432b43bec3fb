"""The indexes of equations and of figures lead to places that exist."""

import re
from importlib.util import find_spec
from pkgutil import resolve_name

import pytest
from declared_artifacts import DRAWINGS, STUDIES

import bouncing_ball.paper
import bouncing_ball.paper.exhibits
from bouncing_ball.paper.artifacts import ARTIFACTS

# The equations of each row of the index, none in a row that belongs to the one before, and the
# place in the package.
ROWS = re.findall(r"^([\d, -]+|\.\.) +\S.*``([\w.]+)``.*$", bouncing_ball.paper.__doc__, flags=re.M)


def numbers(text):
    """The numbers of equations in the first column of a row."""
    parts = [part.partition("-") for part in text.strip(". ").split(",") if part]
    return [k for low, _, high in parts for k in range(int(low), int(high or low) + 1)]


def test_the_index_of_equations_has_each_equation_once():
    assert sorted(k for text, _ in ROWS for k in numbers(text)) == list(range(1, 39))


@pytest.mark.parametrize("place", [place for _, place in ROWS])
def test_what_each_place_of_the_index_of_equations_names_is_written_there(place):
    """In the module or class itself: not imported from elsewhere, nor inherited."""
    owner, _, name = f"bouncing_ball.{place}".rpartition(".")
    there = resolve_name(owner)
    found = vars(there)[name]
    assert found.__doc__
    # A function or a class knows its module; a number does not.
    module = there.__module__ if isinstance(there, type) else there.__name__
    assert getattr(found, "__module__", module) == module


def test_each_equation_is_shown_where_the_index_leads():
    shown: dict[str, str] = {}
    of = ""
    for text, place in ROWS:
        # A row without equations belongs to the one before.
        of = text.strip(". ") or of
        shown[of] = shown.get(of, "") + resolve_name(f"bouncing_ball.{place}").__doc__
    for of, docstrings in shown.items():
        for k in numbers(of):
            # As (7) beside the equation, or as Eq. 7 in a sentence.
            assert re.search(rf"\({k}\)|Eqs?\. [\d, -]*\b{k}\b", docstrings), k


def test_each_module_of_the_index_of_figures_exists():
    named = re.findall(r":mod:`(\.[\w.]+)`", bouncing_ball.paper.exhibits.__doc__)
    missing = [name for name in named if not find_spec(name, "bouncing_ball.paper.exhibits")]
    assert len(named) > 8 and not missing


def test_the_index_of_figures_has_every_figure_and_the_table():
    index = bouncing_ball.paper.exhibits.__doc__
    rows = re.findall(r"^Fig\. ([\d, ]+?)  *:mod:", index, flags=re.M)
    figures = sorted(int(number) for row in rows for number in row.split(","))
    assert figures == list(range(1, 17)) and "Table 1" in index


def test_the_index_of_figures_leads_to_the_functions_that_make_each_figure():
    index = bouncing_ball.paper.exhibits.__doc__
    row = re.compile(r"^Fig\. ([\d, ]+?)  *:mod:`\.(\w+)` +(\S+) +``(\w+)``$", flags=re.M)
    for numbers, module, study, drawing in row.findall(index):
        for number in numbers.split(","):
            name = f"fig{int(number):02d}"
            place = f"bouncing_ball.paper.exhibits.{module}"
            # The schematics have pictures only.
            if made := STUDIES.get(name):
                assert (made.__module__, made.__name__) == (place, study.strip("`"))
                place += "_figures"
            assert DRAWINGS[name] is resolve_name(f"{place}:{drawing}")
            assert ARTIFACTS[name].drawing == (f"{place}:{drawing}" if made else "")
