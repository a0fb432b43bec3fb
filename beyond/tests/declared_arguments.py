"""What public functions declare of their arguments: ranges and names."""

import typing
from collections.abc import Callable, Mapping
from functools import cache
from types import UnionType

import xarray as xr

import bouncing_ball_beyond as bb
from bouncing_ball.drawing.result import Result
from bouncing_ball.errors import Range
from bouncing_ball_beyond.periodic.branches.labelled import FollowedBranch, SpecialCurve

Declared = Range | tuple[str, ...]
# What is imported for type checkers only.
LATER = {
    "DataArray": xr.DataArray,
    "Dataset": xr.Dataset,
    "xr": xr,
    "Result": Result,
    "FollowedBranch": FollowedBranch,
    "SpecialCurve": SpecialCurve,
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


@cache
def declared_by(function: Callable) -> Mapping[str, Declared]:
    """The arguments of a function that have a range or names."""
    hints = typing.get_type_hints(function, localns=LATER, include_extras=True)
    found = {name: declared(hint) for name, hint in hints.items()}
    return {name: allowed for name, allowed in found.items() if allowed}


def arguments(name: str) -> Mapping[str, Declared]:
    """The declared arguments of a public function by its name."""
    return declared_by(getattr(bb, name))
