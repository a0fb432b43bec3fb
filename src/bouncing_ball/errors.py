"""The errors a user can cause, as one-line messages.

Both derive from :class:`ValueError`, so that callers who do not care for the
distinction can catch that.
"""


class ModelError(ValueError):
    """A parameter outside the range in which the model is defined."""


class NoOrbitError(ValueError):
    """The requested periodic orbit does not exist, with the reason why."""
