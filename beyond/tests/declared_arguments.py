"""What public functions declare of their arguments: ranges and names."""

import typing
from collections.abc import Callable, Mapping
from functools import cache
from types import ModuleType, UnionType

import xarray as xr

from bouncing_ball_beyond.inherited.drawing.result import Result
from bouncing_ball_beyond.inherited.errors import Range

Declared = Range | tuple[str, ...]
Arguments = Callable[[str], Mapping[str, Declared]]
# What is imported for type checkers only.
LATER = {
    "DataArray": xr.DataArray,
    "Dataset": xr.Dataset,
    "xr": xr,
    "Result": Result,
}


def declared(hint: typing.Any) -> Declared | None:
    """The range or the names of an argument with this annotation."""
    origin = typing.get_origin(hint)
    if origin is typing.Literal:
        return typing.get_args(hint)
    if origin is typing.Annotated:
        known = (each for each in hint.__metadata__ if isinstance(each, Range))
        return next(known, None)
    if origin in (typing.Union, UnionType):
        return next(filter(None, map(declared, typing.get_args(hint))), None)
    return None


def arguments_of(package: ModuleType, *later: type) -> Arguments:
    """The declared arguments of a package's public functions, by the function's name.

    ``later`` are further types that the package imports for type checkers only.
    """
    names = LATER | {each.__name__: each for each in later}

    @cache
    def arguments(name: str) -> Mapping[str, Declared]:
        """The arguments of a function, or the fields of a class, that have a range or names."""
        hints = typing.get_type_hints(getattr(package, name), localns=names, include_extras=True)
        found = {name: declared(hint) for name, hint in hints.items()}
        return {name: allowed for name, allowed in found.items() if allowed}

    return arguments
