"""Objects whose attributes are suggested, as keywords of calls are."""

from typing import TYPE_CHECKING, ClassVar, NoReturn

from bouncing_ball_beyond.inherited.errors import did_you_mean


class Suggesting:
    """An object that answers an unknown attribute with the one that it resembles, or with a
    sentence of its own.

    Examples
    --------
    >>> class Table(Suggesting):
    ...     amplitude = 1.0
    >>> Table().amplitud
    Traceback (most recent call last):
    AttributeError: Table has no attribute 'amplitud'; did you mean amplitude?
    """

    _elsewhere: ClassVar[str] = ""

    # A type checker would accept every attribute.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            # Attributes with an underscore are asked for by programs, such as numpy and pickle.
            known = [] if name.startswith("_") else dir(self)
            kind = type(self).__name__
            hint = did_you_mean(name, known) or (self._elsewhere if known else "")
            raise AttributeError(f"{kind} has no attribute {name!r}{hint}")
