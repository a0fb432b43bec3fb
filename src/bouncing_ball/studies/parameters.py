"""Small helpers that turn parameters of the configuration into model objects."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.spring_damper import Contact, Release


def grid(span: Mapping[str, Any]) -> np.ndarray:
    """Logarithmic grid from ``min``, ``max`` and ``samples``.

    Examples
    --------
    >>> grid({"min": 1.0, "max": 100.0, "samples": 3}).tolist()
    [1.0, 10.0, 100.0]
    """
    return np.geomspace(span["min"], span["max"], span["samples"])


def contact(frequency_ratio, restitution: float, release: str) -> Contact:
    """The contact with the damping of a restitution coefficient (Eq. 16)."""
    return Contact(frequency_ratio, float(damping_ratio(restitution)), Release(release))
