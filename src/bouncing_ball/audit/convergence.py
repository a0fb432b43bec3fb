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

from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.audit import evidence, formulas
from bouncing_ball.audit.forensics import study as forensics
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.studies import (
    error_thresholds,
    frequency_sweeps,
    release_rules,
    time_histories,
)
from bouncing_ball.studies import (
    orbit_branches as continuation,
)
from bouncing_ball.studies import (
    permanent_contact_curve as permanent_contact,
)
from bouncing_ball.studies import (
    restitution_families as restitution_orbits,
)

Parameters = Mapping[str, Any]


class Variation(StrEnum):
    """What is changed although it should not matter."""

    TOLERANCES = "tolerances"
    GRID = "grid"
    ROUNDING = "rounding"


class Stage(NamedTuple):
    """How a dataset is made: ``study(parameters, *arguments)``."""

    study: Callable[..., xr.Dataset]
    parameters: Parameters
    arguments: tuple = ()

    def run(self) -> xr.Dataset:
        """The dataset."""
        return self.study(self.parameters, *self.arguments)


_STUDIES: dict[str, Callable[..., xr.Dataset]] = {
    "fig02": restitution_orbits.restitution_history,
    "fig03": restitution_orbits.restitution_orbits,
    "fig05": frequency_sweeps.apparent_restitution,
    "fig06": frequency_sweeps.apparent_restitution,
    "fig07": time_histories.contact_history,
    "fig08": continuation.orbit_branches,
    "fig09": continuation.orbit_branches,
    "fig10": frequency_sweeps.frequency_sweep,
    "fig11": permanent_contact.permanent_contact,
    "fig12": time_histories.both_histories,
    "fig13": frequency_sweeps.frequency_sweep,
    "fig14": error_thresholds.height_error,
    "fig15": continuation.both_domains,
    "fig16": error_thresholds.permanent_contact_error,
    "table1": continuation.stability_ranges,
    "thresholds": error_thresholds.error_thresholds,
    "ext_release": release_rules.release_rules,
    "formulas": formulas.formulas,
    "forensics": forensics.forensics,
}
# Those that know neither release rule nor settings, and those that know both.
_BARE = ("fig02", "fig03", "ext_release", "formulas", "forensics")
_CONTINUED = ("fig08", "fig09", "fig15", "table1")
# A cycle is split at the release, with half of the samples on either side, so
# that a finer cycle has none of the old times. Each sample is the orbit's
# formula at its own time, and other samples change nothing about it. Other
# samples of the formulas are other parameters, and steps from sample to sample,
# of which some evidence consists, are other steps.
_NOT_NESTED = ("fig07", "fig12", "formulas", "evidence")

# Sizes that become 2N - 1.
_SIZES = ("samples", "points")
# Moved by units in the last place. The others are labels, or what is looked for.
_MOVED = ("restitution", "amplitude", "amplitude_max")
ULPS = (-2, -1, 1, 2)


def _simple_stages(config: Parameters, printed: Parameters) -> dict[str, Stage]:
    """The stages of the datasets that are made from parameters alone."""
    parameters = {
        name: part
        for section in ("figures", "tables", "extensions", "studies")
        for name, part in config.get(section, {}).items()
    }
    made = {}
    for name in (name for name in _STUDIES if name in parameters):
        own, arguments = parameters[name], () if name in _BARE else (config["release"],)
        if name in _CONTINUED:
            arguments = (config["release"], config["continuation"])
        if name == "table1":
            arguments += (printed,)
        if name == "forensics":
            own = {**own, "printed": printed}
        made[name] = Stage(_STUDIES[name], own, arguments)
    return made


def _evidence_from_scratch(
    config: Parameters, printed: Parameters, sources: Sequence[str]
) -> xr.Dataset:
    """The evidence, with all the datasets that it is read from."""
    made = _simple_stages(config, printed)
    data = {
        name: made[name].run().assign_attrs(parameter_attributes(made[name].parameters))
        for name in sources
    }
    return evidence.evidence(data, config["studies"]["evidence"])


def stages(config: Parameters, printed: Parameters, sources: Sequence[str]) -> dict[str, Stage]:
    """The stages of all datasets that the configuration has parameters for.

    Parameters
    ----------
    config : mapping
        The configuration.
    printed : mapping
        Table 1 as printed.
    sources : sequence of str
        The datasets that the evidence is read from.
    """
    made = _simple_stages(config, printed)
    if set(sources) <= set(made):
        made["evidence"] = Stage(_evidence_from_scratch, config, (printed, sources))
    return made


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
    return {
        **settings,
        **shorter,
        "newton_tolerance": settings["newton_tolerance"] / 10,
    }


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


def variations(name: str, stage: Stage, base: xr.Dataset) -> Iterator[tuple[Variation, xr.Dataset]]:
    """The datasets of a stage under each variation, on the grid of its own ``base``."""
    if name in _CONTINUED:
        release, settings, *more = stage.arguments
        yield (
            Variation.TOLERANCES,
            stage._replace(arguments=(release, tighter(settings), *more)).run(),
        )
    if name == "evidence":
        settings = tighter(stage.parameters["continuation"])
        varied = {**stage.parameters, "continuation": settings}
        yield Variation.TOLERANCES, stage._replace(parameters=varied).run()
    fine = finer_grid(stage.parameters)
    if name not in _NOT_NESTED and fine != stage.parameters:
        yield Variation.GRID, on_the_old_grid(stage._replace(parameters=fine).run(), base)
    for ulps in ULPS:
        other = other_rounding(stage.parameters, ulps)
        yield Variation.ROUNDING, stage._replace(parameters=other).run()


def sensitivity(
    name: str, stage: Stage, measure: Callable[[xr.Dataset, xr.Dataset], Mapping[str, float]]
) -> dict[str, dict[Variation, float]]:
    """Largest change of each variable of a stage, by variation.

    Parameters
    ----------
    name : str
        Of the figure or table.
    stage : Stage
    measure : callable
        The change of each variable between two datasets.
    """
    base = stage.run()
    largest: dict[str, dict[Variation, float]] = {}
    for variation, data in variations(name, stage, base):
        for variable, change in measure(base, data).items():
            row = largest.setdefault(variable, {})
            row[variation] = max(change, row.get(variation, 0.0))
    return largest
