"""Every design of the table, dropped in its engine."""

import importlib
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
engine_table = importlib.import_module("engine_table")
pytestmark = pytest.mark.engines


@pytest.mark.parametrize("case", engine_table.CASES, ids=lambda case: f"{case[0]} {case[1]}")
@pytest.mark.filterwarnings("ignore")
def test_the_engine_does_what_is_printed(case):
    try:
        texts, agrees = engine_table.cells(*case)
    except ImportError as missing:
        pytest.skip(f"{missing.name} is not installed")
    assert agrees, texts
