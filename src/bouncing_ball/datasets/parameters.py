"""The types from which parameters are made: the meaning of a number, its unit and its range.

Each study takes a subclass of :class:`Parameters` that is defined beside it. The check of the
configuration, its one-line errors, its documentation and its JSON schema are made from these
classes, so that each name, range and description is written once. The description gives the reason
for each limit. Numbers that many studies take are rows of ``parameters.csv``.
"""

import csv
import json
from pathlib import Path
from typing import Annotated, Any, Self, TypeVar

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, Strict, model_validator

_T = TypeVar("_T")


class Parameters(BaseModel):
    """The parameters of a study, with exactly these keys.

    Values are not converted: a text is not a number, and 801.0 is not a count. Numbers are finite.

    Raises
    ------
    pydantic.ValidationError
        If a value is not allowed.

    Examples
    --------
    >>> Span(min=1, max=100.0, samples=3)
    Span(min=1.0, max=100.0, samples=3)
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


def number(description: str, unit: str = "1", **limits: Any) -> Any:
    """The field of a number: its description, its unit, and limits such as ``ge`` and ``lt``."""
    return Field(description=description, json_schema_extra={"unit": unit}, **limits)


_TABLE = Path(__file__).with_suffix(".csv").read_text(encoding="utf-8").splitlines()
_ROWS = {row.pop("name"): row for row in csv.DictReader(_TABLE)}


def listed(name: str) -> Any:
    """The field of a number that many studies take, from its row of ``parameters.csv``."""
    row = _ROWS[name]
    limits = {key: json.loads(row[key]) for key in ("ge", "gt", "le", "lt") if row[key]}
    return number(row["description"], **limits)


def _distinct(values: tuple) -> tuple:
    if len(set(values)) < len(values):
        raise ValueError("must not repeat an item")
    return values


Many = Annotated[tuple[_T, ...], Strict(False), Field(min_length=1), AfterValidator(_distinct)]
"""One or more distinct values, given as a list in the configuration."""

Family = Annotated[int, listed("Family")]
Restitution = Annotated[float, listed("Restitution")]
LossyRestitution = Annotated[float, listed("LossyRestitution")]
LawRestitution = Annotated[float, listed("LawRestitution")]
Amplitude = Annotated[float, listed("Amplitude")]
AmplitudeMax = Annotated[float, listed("AmplitudeMax")]
FrequencyRatio = Annotated[float, listed("FrequencyRatio")]
Samples = Annotated[int, listed("Samples")]
Tolerance = Annotated[float, listed("Tolerance")]
Seed = Annotated[int, listed("Seed")]


class Sharded(Parameters):
    """The parameters of a study whose places may be divided among jobs."""

    shards: Annotated[int, number("jobs among which places are divided", ge=1, le=2000)] = 1


class Interval(Parameters):
    """Two ends, of which the second is above the first."""

    min: float
    max: float

    @model_validator(mode="after")
    def _increasing(self) -> Self:
        if self.min >= self.max:
            raise ValueError(f"min = {self.min:g} must be less than max = {self.max:g}")
        return self


class Span(Interval):
    """A logarithmic grid of frequency ratios."""

    min: Annotated[FrequencyRatio, Field(description="smallest frequency ratio ϖ")]
    max: Annotated[FrequencyRatio, Field(description="largest frequency ratio ϖ, above min")]
    samples: Samples

    def grid(self) -> np.ndarray:
        """The frequency ratios, shape (samples,).

        Examples
        --------
        >>> Span(min=1.0, max=100.0, samples=3).grid().tolist()
        [1.0, 10.0, 100.0]
        """
        return np.geomspace(self.min, self.max, self.samples)
