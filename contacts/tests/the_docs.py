"""The folder of the docs and that of their data."""

from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
DATA = DOCS / "data"

MEASURED = "measured by make test-engines"
"""The history of the data that engines measured."""
