"""Check of the configuration, with one line per mistake.

The schema says what each key may be; :func:`check_configuration` adds what a
schema cannot say: that numbers are finite, ranges are not empty, and that the
restitution orbits which a figure needs exist (Eq. 7).
"""

from collections.abc import Iterator, Mapping
from typing import Any

from bouncing_ball.configuration.conformity import check_schema, dotted
from bouncing_ball.configuration.schema import configuration_schema
from bouncing_ball.configuration.stages import STAGES
from bouncing_ball.configuration.yaml_file import ConfigurationError


def _spans(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, Mapping]]:
    if isinstance(value, Mapping):
        if {"min", "max"} <= set(value):
            yield path, value
        for key, part in value.items():
            yield from _spans(part, (*path, key))


def _check_consistency(config: Mapping[str, Any]) -> None:
    steps = config["continuation"]
    if not steps["smallest_step"] <= steps["initial_step"] <= steps["largest_step"]:
        raise ConfigurationError(
            f"continuation.initial_step = {steps['initial_step']} must lie between "
            f"smallest_step = {steps['smallest_step']} and largest_step = {steps['largest_step']}"
        )
    for path, span in _spans(config):
        if span["min"] >= span["max"]:
            raise ConfigurationError(
                f"{dotted(path)}.min = {span['min']} must be less than max = {span['max']}"
            )
    _check_atlas(config["atlas"])


def _check_atlas(atlas: Mapping[str, Any]) -> None:
    """The ϖ examined are within the range scanned; the summary's numbers are among the rest."""
    span = atlas["frequency_ratio"]
    for value in atlas["examined"]:
        if not span["min"] <= value <= span["max"]:
            raise ConfigurationError(
                f"atlas.examined = {value} must be from frequency_ratio.min = {span['min']} "
                f"to max = {span['max']}"
            )
    for key, allowed in (("tolerance", "tolerances"), ("rule_of_thumb", "examined")):
        if atlas["summary"][key] not in atlas[allowed]:
            listed = ", ".join(f"{value:g}" for value in atlas[allowed])
            raise ConfigurationError(
                f"atlas.summary.{key} = {atlas['summary'][key]} must be one of {allowed}: {listed}"
            )


def _needs(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, float, list[int], float]]:
    """Path and value of every Λ at which, or up to which, an orbit is needed, with n and r."""
    if not isinstance(value, Mapping):
        return
    families = value.get("n", [])
    families = families if isinstance(families, list) else [families]
    for index, case in enumerate(value.get("cases", [])):
        yield (*path, "cases", index, "amplitude"), case["amplitude"], families, case["restitution"]
    for label in ("amplitude", "amplitude_max"):
        found = value.get(label, [])
        listed = isinstance(found, list)
        for index, one in enumerate(found if listed else [found]):
            key = (*path, label, index) if listed else (*path, label)
            # What is shown at several Λ shows the orbits that there are.
            yield key, one, [min(families)] if listed else families, value["restitution"]
    for key, part in value.items():
        yield from _needs(part, (*path, key))


def _check_existence(config: Mapping[str, Any]) -> None:
    # Imported here: numpy is not needed to refuse a mistyped key.
    from bouncing_ball.orbits.restitution_orbit import period_doubling, saddle_node
    from bouncing_ball.orbits.stability import Bifurcation

    for path, value, families, r in _needs(config):
        key = dotted(path)
        # The branch of the highest family starts last.
        n = max(families)
        if key.startswith("tables.table1"):
            lowest = 1.1 * float(period_doubling(n, r))
            what = "period doubling, with a tenth to spare,"
        else:
            lowest, what = float(saddle_node(n, r)), Bifurcation.SADDLE_NODE
        if value < lowest:
            raise ConfigurationError(
                f"{key} = {value} must be at least {lowest:.6g}, the {what} of the "
                f"{n}-T restitution orbit at r = {r} (Eqs. 7-8)"
            )


def check_orbits(config: Mapping[str, Any]) -> None:
    """Raise unless the orbits whose motion is drawn are orbits of the ball.

    A sweep has a gap where there is no orbit; a time history needs one.

    Raises
    ------
    ConfigurationError
        One line that names the figure and says what is missing.
    """
    # Imported here: to refuse a mistyped key needs no scipy.
    from bouncing_ball.contacts.spring_damper import SpringDamper
    from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

    for stage in STAGES.values():
        if not stage.one_motion:
            continue
        part = stage.parameters(config)
        ratios = part["frequency_ratio"]
        for ratio in ratios if isinstance(ratios, list) else [ratios]:
            contact = SpringDamper.from_restitution(part["restitution"], ratio, config["release"])
            try:
                SpringDamperModel(contact).require_admissible(part["n"], part["amplitude"])
            except ValueError as error:
                raise ConfigurationError(
                    f"{stage.section}.frequency_ratio = {ratio}: {error}"
                ) from None


def check_configuration(config: Mapping[str, Any], kinds: Mapping[str, Any]) -> None:
    """Raise on the first mistake in a configuration.

    Parameters
    ----------
    config : mapping
    kinds : mapping
        The content of ``config/schema.yaml``.

    Raises
    ------
    ConfigurationError
        One line that names the key, the value and what is allowed.
    """
    check_schema(config, configuration_schema(kinds))
    _check_consistency(config)
    _check_existence(config)
