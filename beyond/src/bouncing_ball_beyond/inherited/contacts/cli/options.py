"""The options of ``design`` that neither the root's commands nor beyond's have."""

import inspect
from collections.abc import Callable, Iterable

from bouncing_ball_beyond.cli.options import add_assignments
from bouncing_ball_beyond.inherited.cli import options
from bouncing_ball_beyond.inherited.cli.options import Parser, add_parameters, meanings

NAMES = {"parameters": "set", "from_engine": "from", "all_families": "all"}
"""The options that are not called as their parameters."""


def option(name: str) -> str:
    """The option of ``design`` for a parameter.

    Examples
    --------
    >>> option("contact_time"), option("from_engine")
    ('--contact-time', '--from')
    """
    return options.option(NAMES.get(name, name))


def add_optional(parser: Parser, call: Callable, names: Iterable[str]) -> None:
    """Add options for some parameters of a call, of which none is required."""
    texts = meanings(call)
    parameters = inspect.signature(call).parameters
    for name in names:
        if name == "parameters":
            add_assignments(parser, name, texts[name])
        elif name in NAMES:
            parser.add_argument(option(name), dest=name, metavar="X", help=texts[name])
        else:
            add_parameters(parser, _CallWith(parameters[name], texts[name]))


class _CallWith:
    """A call that has one parameter alone, which is not required, for :func:`add_parameters`."""

    def __init__(self, parameter: inspect.Parameter, text: str) -> None:
        if parameter.name == "law":
            text += laws()
        if parameter.default is parameter.empty:
            parameter = parameter.replace(default=None)
        self.__doc__ = f"Parameters\n----------\n{parameter.name}\n    {text}"
        self.__signature__ = inspect.Signature([parameter])

    def __call__(self) -> None:
        """Nothing: only the signature and the docstring are read."""


def laws() -> str:
    """A sentence with the names of the contact laws."""
    # Imported here, because the import needs numpy, which the general help does not need.
    from bouncing_ball_beyond.inherited.contacts.engines.laws import LAWS

    return f" Laws: {', '.join(LAWS)}."
