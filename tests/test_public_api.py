"""What users import from the top, as README shows it."""

import doctest
import pydoc
import subprocess
import sys
from pathlib import Path

import pytest

import bouncing_ball

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_of_the_readme_print_what_it_says():
    result = doctest.testfile(str(README), module_relative=False)
    assert result.failed == 0
    assert result.attempted >= 8


def test_every_public_name_is_there_and_documented():
    for name in bouncing_ball.__all__:
        assert getattr(bouncing_ball, name).__doc__, name
    assert set(bouncing_ball.__all__) <= set(dir(bouncing_ball))


def test_help_shows_the_way_in():
    text = pydoc.render_doc(bouncing_ball, renderer=pydoc.plaintext)
    for call in ("bouncing_ball.orbit(", "bouncing_ball.limits(", "bouncing_ball.simulate("):
        assert call in text


@pytest.mark.parametrize("impacts", [0, -1, 2.5])
def test_what_the_command_line_refuses_is_refused(impacts, one_line):
    with pytest.raises(bouncing_ball.ModelError) as error:
        bouncing_ball.simulate(1.0, restitution=0.85, impacts=impacts)
    one_line(error, f"impacts = {impacts} is not a whole number from 1 to 100000")


def test_the_package_itself_needs_no_numpy():
    code = "import sys, bouncing_ball; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
