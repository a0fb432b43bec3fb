"""Parameters of the configuration as arrays."""

from collections.abc import Mapping
from typing import Any

import numpy as np


def grid(span: Mapping[str, Any]) -> np.ndarray:
    """Logarithmic grid from ``min``, ``max`` and ``samples``.

    Examples
    --------
    >>> grid({"min": 1.0, "max": 100.0, "samples": 3}).tolist()
    [1.0, 10.0, 100.0]
    """
    return np.geomspace(span["min"], span["max"], span["samples"])
