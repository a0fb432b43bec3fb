"""Models as text, from which they come back exactly.

The text is JSON, in which each law is an object with its type and its parameters. A number is
written with as many digits as it needs to come back with the same bits. A parameter that is an
array is left out: the text names the variable of the dataset beside it that has the values.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.named_laws import LAWS
from bouncing_ball_beyond.models.restitution_by_speed import RestitutionLaw, RestitutionLawModel
from bouncing_ball_beyond.models.rigid import RestitutionModel

_MODELS = (RestitutionModel, ContactModel, CorrectedModel, RestitutionLawModel)
_OF_USERS = (ForceLaw, RestitutionLaw, Model)
_KNOWN = {each.__name__: each for each in (*_MODELS, Signature, *LAWS.values())}
# The keys of the type of an object, and of the name of the variable with an array.
_TYPE = "type"
_ARRAY = "array"


def text_of(model: Model) -> tuple[str, dict[str, np.ndarray]]:
    """A model as text, and those of its parameters that are arrays, by name.

    Examples
    --------
    >>> text, arrays = text_of(RestitutionModel(np.array([0.5, 0.6])))
    >>> text, list(arrays)
    ('{"type": "RestitutionModel", "restitution": {"array": "restitution"}}', ['restitution'])
    """
    arrays: dict[str, np.ndarray] = {}
    return json.dumps(_written(model, "", arrays), ensure_ascii=False), arrays


def model_of(text: str, arrays: Mapping[str, Any]) -> Any:
    """The model of a text, whose parameters that are arrays are given by name.

    A law that the library does not have is found by the name of its class, which must be defined.

    Raises
    ------
    ModelError
        If the text is that of no model, or if it names a class that is not known.

    Examples
    --------
    >>> model_of(*text_of(RestitutionModel(0.5)))
    RestitutionModel(restitution=0.5)
    """
    # A law of a user may have the name of one of the library.
    known = {x.__name__: x for base in _OF_USERS for x in _subclasses(base)} | _KNOWN
    try:
        found = _read(json.loads(text), arrays, known)
    except (json.JSONDecodeError, KeyError, TypeError, AttributeError):
        raise ModelError(f"{text[:60]!r} is not the text of a model") from None
    if not isinstance(found, Model):
        raise ModelError(f"{text[:60]!r} is not the text of a model")
    return found


def _subclasses(base: type) -> Iterator[type]:
    """The subclasses of a class that are defined at present."""
    found: list[type] = base.__subclasses__()
    for each in found:
        yield each
        yield from _subclasses(each)


def _written(value: Any, name: str, arrays: dict[str, np.ndarray]) -> Any:
    kind = {_TYPE: type(value).__name__}
    if is_dataclass(value):
        names = [field.name for field in fields(value)]
        return kind | {part: _written(getattr(value, part), part, arrays) for part in names}
    if value is None or isinstance(value, str):
        return None if value is None else str(value)
    if np.ndim(value):
        arrays[name] = np.asarray(value)
        return {_ARRAY: name}
    return np.asarray(value).item()


def _read(value: Any, arrays: Mapping[str, Any], known: Mapping[str, type]) -> Any:
    if not isinstance(value, dict):
        return value
    if _ARRAY in value:
        return arrays[value[_ARRAY]]
    kind = value[_TYPE]
    if kind not in known:
        raise ModelError(f"{kind} is no model or law of the library: import its class first")
    given = {name: x for name, x in value.items() if name != _TYPE}
    return known[kind](**{name: _read(each, arrays, known) for name, each in given.items()})
