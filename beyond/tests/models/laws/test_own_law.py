"""The worked example of a user's law in the documentation, run as it stands."""

import doctest
from pathlib import Path

PAGE = Path(__file__).parents[3] / "docs" / "contact-laws.md"


def test_the_example_of_the_documentation_runs():
    result = doctest.testfile(str(PAGE), module_relative=False)
    assert result.attempted > 10 and result.failed == 0
