"""What the atlas covers, as the configuration gives it."""

from typing import Annotated, Self

from pydantic import Field, Strict, model_validator

from bouncing_ball.contacts.release import Release
from bouncing_ball.parameters import (
    Family,
    FrequencyRatio,
    Many,
    Parameters,
    Restitution,
    Span,
    Tolerance,
    number,
)

Ranges = Annotated[int, number("number of equal ranges, finer than any map at 2000", ge=1, le=2000)]
Nodes = Annotated[
    int, number("even nodes in each range, whose row is held in memory", ge=1, le=10000)
]


class RestitutionTiles(Parameters):
    """Ranges of r; those beyond a release rule's reach are left out."""

    min: Restitution
    max: Restitution
    tiles: Ranges
    samples: Nodes

    @model_validator(mode="after")
    def _increasing(self) -> Self:
        if self.min >= self.max:
            raise ValueError(f"min = {self.min:g} must be less than max = {self.max:g}")
        return self


class PositionTiles(Parameters):
    """Ranges of the position in the stable range."""

    tiles: Ranges
    samples: Nodes


class StiffSpan(Span):
    """A logarithmic grid of frequency ratios whose contacts are short."""

    min: Annotated[
        float,
        number("smallest ϖ; a contact softer than 3 lasts a good part of the period", ge=3, le=1e6),
    ]


class Summary(Parameters):
    """What charts and tables show."""

    tolerance: Tolerance
    rule_of_thumb: Annotated[
        FrequencyRatio,
        Field(description="the ϖ from which the paper takes the restitution model to be right"),
    ]


class AtlasParameters(Parameters):
    """The atlas of thresholds, ``snakemake --cores 2 atlas``."""

    n: Many[Family]
    release: Many[Annotated[Release, Strict(False)]]
    restitution: RestitutionTiles
    position: PositionTiles
    frequency_ratio: StiffSpan
    tolerances: Many[Tolerance]
    examined: Annotated[
        Many[FrequencyRatio],
        Field(description="frequency ratios ϖ at which the errors themselves are described"),
    ]
    shards: Annotated[int, number("number of jobs, at most one for each row", ge=1, le=20000)]
    summary: Summary

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        low, high = self.frequency_ratio.min, self.frequency_ratio.max
        for value in self.examined:
            if not low <= value <= high:
                raise ValueError(
                    f"examined = {value:g} must be from frequency_ratio.min = {low:g} to "
                    f"max = {high:g}"
                )
        among = (("tolerance", self.tolerances, "tolerances"),)
        for key, allowed, name in (*among, ("rule_of_thumb", self.examined, "examined")):
            value = getattr(self.summary, key)
            if value not in allowed:
                listed = ", ".join(f"{each:g}" for each in allowed)
                raise ValueError(f"summary.{key} = {value:g} must be one of {name}: {listed}")
        return self
