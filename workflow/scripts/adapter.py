"""The functions that the stages name: the only place of the workflow that imports by a name."""

import gc
from collections.abc import Callable
from importlib import import_module
from typing import Any

from bouncing_ball.pipeline.yaml_files import ConfigurationError

# A job mostly imports, and what it imports remains: looking for garbage there takes a tenth of its
# time.
gc.set_threshold(100_000)


def function(module: str, name: str) -> Callable[..., Any]:
    """The function with this name in a module of a house.

    Raises
    ------
    ConfigurationError
        If there is no such module or function.
    """
    try:
        return getattr(import_module(module), name)
    except (ModuleNotFoundError, AttributeError) as error:
        raise ConfigurationError(f"{module}.{name}: {error}") from None
