"""The variables that the stages of a package declare."""

import importlib
from pathlib import Path
from types import ModuleType

from bouncing_ball_beyond.inherited.datasets.variables import SHARED


def variables_of(package: ModuleType) -> dict:
    """The variables of all datasets: those that stages share, and those of each stage."""
    folder = Path(package.__file__).parent
    found = dict(SHARED)
    for path in sorted(folder.rglob("*.py")):
        if "\nVARIABLES = {" in path.read_text(encoding="utf-8"):
            name = ".".join(path.relative_to(folder.parent).with_suffix("").parts)
            own = importlib.import_module(name).VARIABLES
            # A name has one meaning, whatever the dataset.
            assert not found.keys() & own.keys(), (name, found.keys() & own.keys())
            found |= own
    return found
