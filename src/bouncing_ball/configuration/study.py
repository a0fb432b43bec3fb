"""The study that an entry of the stages names.

A module of its own: jobs need it, and are not run again when an entry is added.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any


def load(study: str) -> Callable[..., Any]:
    """The function that an entry names.

    Examples
    --------
    >>> load("studies.parameters.grid")({"min": 1.0, "max": 4.0, "samples": 3})
    array([1., 2., 4.])
    """
    module, _, function = study.rpartition(".")
    return getattr(import_module(f"bouncing_ball.{module}"), function)
