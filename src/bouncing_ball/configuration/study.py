"""The studies that the rules name, and the arguments that each takes from a run.

The signature of a study declares its arguments, for example ``study(parameters, release,
continuation)``. ``parameters`` is a section of the configuration, such as ``figures.fig08``;
``data`` holds the datasets that the rule names; ``part`` and ``found`` are those of
:mod:`bouncing_ball.datasets.shards`; and each further argument is the setting of the run with that
name.
"""

import inspect
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from pydantic import ConfigDict, validate_call

from bouncing_ball.configuration.yaml_file import ConfigurationError

_OF_JOB = ("data", "part", "found")
SECTIONS = ("figures", "tables", "extensions", "studies")
"""Sections of the configuration in which each key is an artifact."""


def load(study: str) -> Callable[..., Any]:
    """The function with this dotted name in the package.

    Raises
    ------
    ConfigurationError
        If there is no such module or function.

    Examples
    --------
    >>> load("contacts.damping.damping_ratio")(1.0).item()
    0.0
    """
    module, _, function = study.rpartition(".")
    try:
        return getattr(import_module(f"bouncing_ball.{module}"), function)
    except (ModuleNotFoundError, AttributeError) as error:
        raise ConfigurationError(f"{study}: {error}") from None


def typed(study: Callable[..., Any]) -> Callable[..., Any]:
    """The study as a function of parameters in the form that the configuration has.

    It raises :class:`pydantic.ValidationError` if a parameter is not allowed.

    Examples
    --------
    >>> sweep = load("studies.frequency_sweeps.apparent_restitution")
    >>> case = {"restitution": 0.5, "amplitude": 1.5}
    >>> span = {"min": 10.0, "max": 1000.0, "samples": 3}
    >>> parameters = {"n": 1, "cases": [case], "frequency_ratio": span}
    >>> typed(sweep)(parameters, "displacement").frequency_ratio.values.tolist()
    [10.0, 100.0, 1000.0]
    """
    return validate_call(config=ConfigDict(arbitrary_types_allowed=True))(study)


def taken(study: str) -> dict[str, Any]:
    """The arguments that a study takes from the configuration, with their types.

    Raises
    ------
    ConfigurationError
        If there is no such study.

    Examples
    --------
    >>> list(taken("studies.orbit_branches.orbit_branches"))
    ['parameters', 'release', 'continuation']
    """
    signature = inspect.signature(load(study)).parameters.items()
    return {name: each.annotation for name, each in signature if name not in _OF_JOB}


def section(artifact: str, run: Mapping[str, Any]) -> str:
    """Name of the section of the configuration that holds the parameters of an artifact.

    Raises
    ------
    ConfigurationError
        If no section has this key.

    Examples
    --------
    >>> section("fig02", {"figures": {"fig02": {"n": 1}}})
    'figures'
    """
    for name in SECTIONS:
        if artifact in (run.get(name) or {}):
            return name
    raise ConfigurationError(
        f"{artifact} has no parameters: add a key {artifact} to one of {', '.join(SECTIONS)}"
    )


def arguments(study: str, artifact: str, run: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a study for an artifact, in the form that the configuration has.

    Raises
    ------
    ConfigurationError
        If there is no such study, or no section with this artifact.

    Examples
    --------
    >>> run = {"release": "force", "figures": {"fig05": {"n": 1}}}
    >>> arguments("studies.frequency_sweeps.apparent_restitution", "fig05", run)
    {'parameters': {'n': 1}, 'release': 'force'}
    """
    return {
        name: run[section(artifact, run)][artifact] if name == "parameters" else run[name]
        for name in taken(study)
    }
