"""What the pages show is what the commands print."""

import doctest
import importlib
import re
import runpy
from decimal import Decimal
from pathlib import Path

import pytest

import bouncing_ball_contacts

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SHOWN = {
    program: [
        (page.name, command, shown)
        for page in PAGES
        for command, shown in re.findall(
            rf"^```\n\$ {program} ([^\n]*)\n(.*?)^```$",
            page.read_text("utf-8"),
            re.DOTALL | re.MULTILINE,
        )
    ]
    for program in ("bounce", "python")
}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def agrees(out, shown):
    """Words are the same; numbers differ by at most two units of the last digit that is printed.

    The rounding of another processor moves a last digit, and numbers that are chosen from a grid.
    """
    assert NUMBER.sub("0", out).split() == NUMBER.sub("0", shown).split()
    for printed, expected in zip(NUMBER.findall(out), NUMBER.findall(shown), strict=True):
        # The exponent of Decimal is that of the last digit.
        unit = Decimal(1).scaleb(Decimal(printed).as_tuple().exponent)
        assert abs(Decimal(printed) - Decimal(expected)) <= 2 * unit, out


@pytest.mark.parametrize("false", ["0.9230", "0.8967", "-0.8964"])
def test_a_false_number_on_a_page_is_seen(false):
    """Three per cent or 0.002 were allowed: an interval could stand upside down."""
    agrees("r = 0.8964", "r = 0.8966")
    with pytest.raises(AssertionError):
        agrees("r = 0.8964", f"r = {false}")


@pytest.mark.parametrize(("page", "command", "shown"), SHOWN["bounce"], ids=lambda text: text[:30])
def test_a_page_shows_what_the_command_prints(typed, page, command, shown):
    status, out, err = typed(command)
    assert (status, err) == (0, "")
    agrees(out, shown)


@pytest.mark.parametrize(("page", "script", "shown"), SHOWN["python"], ids=lambda text: text[:30])
def test_a_page_shows_what_the_script_prints(capsys, page, script, shown):
    """A page had 2.5 µs where the script printed 4.0 µs."""
    runpy.run_path(str(ROOT / script))
    agrees(capsys.readouterr().out, shown)


def test_the_answers_of_the_readme_are_short():
    """MuJoCo's had 16 lines and 207 words."""
    shown = [text for page, _, text in SHOWN["bounce"] if page == "README.md"]
    assert len(shown) == 3
    assert all(text.count("\n") <= 10 and len(text.split()) < 80 for text in shown)


def test_the_examples_in_python():
    failed, tried = doctest.testfile(str(ROOT / "docs" / "python.md"), module_relative=False)
    assert failed == 0 and tried > 10


MODULES = [
    f"bouncing_ball_contacts.{path.stem}"
    for path in Path(bouncing_ball_contacts.__path__[0]).glob("*.py")
    if ">>> " in path.read_text("utf-8")
]


@pytest.mark.parametrize("module", MODULES)
def test_the_examples_of_docstrings(module):
    failed, tried = doctest.testmod(importlib.import_module(module))
    assert failed == 0 and tried > 0


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_within_the_package_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
        path = (page.parent / target).resolve()
        # Pages of the other packages are theirs.
        assert path.exists() or ROOT not in path.parents, target
