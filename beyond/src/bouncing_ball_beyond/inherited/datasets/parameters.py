"""The types from which parameters are made: the meaning of a number, its unit and its range.

Each study takes a subclass of :class:`Parameters` that is defined beside it. The check of the
configuration, its one-line errors, its documentation and its JSON schema are made from these
classes, so that each name, range and description is written once. The description gives the reason
for each limit. Types of numbers that many studies take are below.
"""

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


def _distinct(values: tuple) -> tuple:
    if len(set(values)) < len(values):
        raise ValueError("must not repeat an item")
    return values


Many = Annotated[tuple[_T, ...], Strict(False), Field(min_length=1), AfterValidator(_distinct)]
"""One or more distinct values, given as a list in the configuration."""

Several = Annotated[Many[_T], Field(min_length=2)]
"""Two or more distinct values."""

Family = Annotated[
    int,
    number(
        "index n of the family, whose orbits have the period 2πn; beyond 20 different "
        "routes to an orbit differ by rounding",
        ge=1,
        le=20,
    ),
]
Restitution = Annotated[
    float,
    number(
        "restitution coefficient r, which determines the damping (Eq. 16); below 0.05 the "
        "ball hardly leaves the contact",
        ge=0.05,
        le=1,
    ),
]
LossyRestitution = Annotated[
    float,
    number(
        "restitution coefficient r; at r = 1 no orbit attracts, and below 0.05 the ball "
        "hardly leaves the contact",
        ge=0.05,
        le=0.999,
    ),
]
Amplitude = Annotated[
    float,
    number(
        "amplitude Λ of the table's acceleration over gravity; at 1000 all orbits of the "
        "families n ≤ 20 are unstable",
        gt=0,
        le=1000,
    ),
]
AmplitudeMax = Annotated[
    float,
    number(
        "upper end of the Λ axis; at 100 all restitution orbits of the families n ≤ 20 "
        "are unstable",
        gt=0,
        le=100,
    ),
]
FrequencyRatio = Annotated[
    float,
    number(
        "frequency ratio ϖ of contact and table; below 0.1 the ball at rest sinks in by "
        "100 g/Ω², and beyond 10⁶ the contact disappears in the rounding errors of the "
        "cycle",
        ge=0.1,
        le=1000000.0,
    ),
]
Samples = Annotated[
    int,
    number(
        "number of samples; a line needs two, and more than 20001 are not visible in a figure",
        ge=2,
        le=20001,
    ),
]
Tolerance = Annotated[float, number("largest relative error", gt=0, lt=1)]
Seed = Annotated[int, number("seed of the random numbers", ge=0)]


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
