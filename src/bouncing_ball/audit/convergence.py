"""How much the published numbers depend on what should not matter.

Every stage is run again three ways:

* *tolerances*: Newton's tolerance a tenth, the steps and angles of the
  continuation half as large;
* *grid*: twice as many intervals, the old abscissae among the new ones;
* *rounding*: r, Λ and the ends of the windows moved by a few units in the last
  place, which changes every rounding after them. This is what another
  processor or another library does to the numbers.

The largest change of each variable is what the budgets of the comparison with
the accepted record are made from.
"""

from collections.abc import Callable, Iterator, Mapping
from enum import StrEnum
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.configuration.stages import STAGES, Stage, studied
from bouncing_ball.configuration.study import load
from bouncing_ball.datasets.netcdf import parameter_attributes

Parameters = Mapping[str, Any]


class Variation(StrEnum):
    """What is changed although it should not matter."""

    TOLERANCES = "tolerances"
    GRID = "grid"
    ROUNDING = "rounding"


class Computation(NamedTuple):
    """How a dataset is made: ``study(parameters, *settings)``, and as its stage says
    whether a finer grid holds the old one."""

    study: Callable[..., xr.Dataset]
    parameters: Parameters
    settings: Parameters
    nested: bool = True

    def run(self) -> xr.Dataset:
        """The dataset."""
        return self.study(self.parameters, *self.settings.values())


# Sizes that become 2N - 1.
_SIZES = ("samples", "points")
# Moved by units in the last place. The others are labels, or what is looked for.
_MOVED = ("restitution", "amplitude", "amplitude_max")
ULPS = (-2, -1, 1, 2)


def _from_scratch(stage: Stage, config: Parameters, **given: Any) -> xr.Dataset:
    """The dataset of a stage, with all the datasets that it reads."""
    run = {**config, **given}
    data = {}
    for name in stage.reads:
        made = _computation(STAGES[name], run)
        data[name] = made.run().assign_attrs(parameter_attributes(made.parameters))
    return load(stage.study)(data, stage.parameters(run), *stage.settings(run).values())


def _computation(stage: Stage, run: Parameters) -> Computation:
    if stage.reads:
        given = {"printed": run["printed"]}
        config = {key: value for key, value in run.items() if key not in ("printed", "ledger")}
        return Computation(partial(_from_scratch, stage, **given), config, {}, stage.nested)
    settings = stage.settings(run)
    return Computation(load(stage.study), stage.parameters(run), settings, stage.nested)


def computations(run: Parameters) -> dict[str, Computation]:
    """How each dataset is made that has parameters of its own.

    A stage that reads other datasets varies with the whole configuration.

    Parameters
    ----------
    run : mapping
        The configuration, and with it ``printed``, Table 1 as printed.
    """
    own = (stage for stage in studied() if stage.section.endswith(f".{stage.name}"))
    return {stage.name: _computation(stage, run) for stage in own}


def _mapped(value: Any, change: Callable[[str, Any], Any], key: str = "") -> Any:
    """Nested parameters, each number or text passed through ``change(key, value)``."""
    if isinstance(value, Mapping):
        return {name: _mapped(part, change, name) for name, part in value.items()}
    if isinstance(value, list):
        return [_mapped(part, change, key) for part in value]
    return change(key, value)


def moved(value: float, ulps: int) -> float:
    """A number, so many units in the last place away.

    Examples
    --------
    >>> moved(1.5, 2) == 1.5 + 2 * 2.0**-52
    True
    """
    for _ in range(abs(ulps)):
        value = float(np.nextafter(value, np.inf if ulps > 0 else -np.inf))
    return value


def finer_grid(parameters: Parameters) -> Parameters:
    """Parameters with 2N - 1 samples in place of N.

    Examples
    --------
    >>> finer_grid({"n": 1, "frequency_ratio": {"min": 1.0, "max": 9.0, "samples": 301}})
    {'n': 1, 'frequency_ratio': {'min': 1.0, 'max': 9.0, 'samples': 601}}
    """
    return _mapped(parameters, lambda key, value: 2 * value - 1 if key in _SIZES else value)


def other_rounding(parameters: Parameters, ulps: int) -> Parameters:
    """Parameters with r, Λ and the windows moved by units in the last place.

    The undamped contact, r = 1, is another case than its neighbours and stays.

    Examples
    --------
    >>> other = other_rounding({"n": 1, "restitution": 1.0, "amplitude": 1.5}, 1)
    >>> other["restitution"], other["amplitude"] == 1.5 + 2.0**-52
    (1.0, True)
    """

    def change(key: str, value: Any) -> Any:
        if key not in _MOVED or (key == "restitution" and value == 1):
            return value
        return moved(value, ulps)

    return _mapped(parameters, change)


def tighter(settings: Parameters) -> Parameters:
    """Settings of the continuation: Newton's tolerance a tenth, steps and angles half."""
    shorter = {key: settings[key] / 2 for key in ("initial_step", "largest_step", "max_angle")}
    return {**settings, **shorter, "newton_tolerance": settings["newton_tolerance"] / 10}


def on_the_old_grid(fine: xr.Dataset, coarse: xr.Dataset) -> xr.Dataset:
    """Every other sample of each dimension with 2N - 1 in place of N.

    The index of such a dimension is that of the coarse dataset.

    Examples
    --------
    >>> coarse = xr.Dataset({"x": ("point", [0.0, 2.0])}, coords={"point": [0, 1]})
    >>> fine = xr.Dataset({"x": ("point", [0.0, 1.0, 2.0])}, coords={"point": [0, 1, 2]})
    >>> on_the_old_grid(fine, coarse).identical(coarse)
    True
    """
    refined = [name for name, size in coarse.sizes.items() if fine.sizes[name] == 2 * size - 1 > 1]
    thinned = fine.isel({name: slice(None, None, 2) for name in refined})
    counted = [name for name in refined if fine[name].dtype.kind == "i"]
    return thinned.assign_coords({name: coarse[name] for name in counted})


def variations(made: Computation, base: xr.Dataset) -> Iterator[tuple[Variation, xr.Dataset]]:
    """The datasets of a stage under each variation, on the grid of its own ``base``."""
    # Among the settings of a stage, or in the whole configuration.
    if "continuation" in made.settings:
        tight = {**made.settings, "continuation": tighter(made.settings["continuation"])}
        yield Variation.TOLERANCES, made._replace(settings=tight).run()
    elif "continuation" in made.parameters:
        tight = {**made.parameters, "continuation": tighter(made.parameters["continuation"])}
        yield Variation.TOLERANCES, made._replace(parameters=tight).run()
    fine = finer_grid(made.parameters)
    if made.nested and fine != made.parameters:
        yield Variation.GRID, on_the_old_grid(made._replace(parameters=fine).run(), base)
    for ulps in ULPS:
        other = other_rounding(made.parameters, ulps)
        yield Variation.ROUNDING, made._replace(parameters=other).run()


def sensitivity(
    made: Computation, measure: Callable[[xr.Dataset, xr.Dataset], Mapping[str, float]]
) -> dict[str, dict[Variation, float]]:
    """Largest change of each variable of a stage, by variation.

    Parameters
    ----------
    made : Computation
    measure : callable
        The change of each variable between two datasets.
    """
    base = made.run()
    largest: dict[str, dict[Variation, float]] = {}
    for variation, data in variations(made, base):
        for variable, change in measure(base, data).items():
            row = largest.setdefault(variable, {})
            row[variation] = max(change, row.get(variation, 0.0))
    return largest
