"""Each mistake in the configuration gives its one line."""

import copy
from pathlib import Path

import pytest

from bouncing_ball.configuration.check import ConfigurationError, check_configuration, check_orbits
from bouncing_ball.configuration.yaml_file import read_yaml

CONFIG, SCHEMA = (
    read_yaml(Path(__file__).resolve().parents[2] / "config" / name)
    for name in ("config.yaml", "schema.yaml")
)
REMOVED = object()


def changed(keys, value):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in keys[:-1]:
        section = section[key]
    if value is REMOVED:
        del section[keys[-1]]
    else:
        section[keys[-1]] = value
    return config


def test_the_shipped_configuration_is_accepted():
    check_configuration(CONFIG, SCHEMA)


def test_a_kind_that_is_not_described(one_line):
    kinds = {key: value for key, value in SCHEMA["$defs"].items() if key != "periods"}
    with pytest.raises(ConfigurationError) as error:
        check_configuration(CONFIG, {**SCHEMA, "$defs": kinds})
    one_line(error, "fig02: its parameter periods has the kind periods, which config/schema.yaml")


FIG08, FIG05 = ("figures", "fig08"), ("figures", "fig05")


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        ((*FIG08, "restitution"), 1.2, "figures.fig08.restitution = 1.2 must be at most 0.999"),
        ((*FIG08, "restitution"), 0, "figures.fig08.restitution = 0 must be at least 0.05"),
        ((*FIG08, "n"), 0, "figures.fig08.n = 0 must be at least 1"),
        ((*FIG08, "n"), 1.5, "figures.fig08.n = 1.5 must be a whole number"),
        ((*FIG08, "n"), 1.0, "figures.fig08.n = 1.0 must be a whole number"),
        ((*FIG08, "n"), True, "figures.fig08.n = True must be a whole number"),
        ((*FIG08, "n"), REMOVED, "missing key figures.fig08.n"),
        ((*FIG08, "m"), 1, "unknown key figures.fig08.m = 1; allowed here: n, restitution"),
        ((*FIG08, "frequency_ratio"), [], "figures.fig08.frequency_ratio = [] must have at least"),
        (
            (*FIG08, "frequency_ratio", 1),
            -10,
            "fig08.frequency_ratio[1] = -10 must be at least 0.1",
        ),
        ((*FIG08, "frequency_ratio", 1), 0, "fig08.frequency_ratio[1] = 0 must be at least 0.1"),
        ((*FIG08, "frequency_ratio"), [2, 2], "fig08.frequency_ratio = [2, 2] must not repeat"),
        (
            (*FIG05, "cases"),
            [{"restitution": 0.65, "amplitude": 1.0}] * 2,
            "'restitution':... must not repeat an item (list of (restitution, amplitude)",
        ),
        ((*FIG08, "frequency_ratio", 0), "1e4", "'1e4' must be a number (powers of ten are"),
        ((*FIG05, "cases", 0, "restitution"), 1.2, "restitution = 1.2 must be at most 1"),
        ((*FIG08, "points"), 3, "figures.fig08.points = 3 must be at least 11"),
        (FIG08, 3, "figures.fig08 = 3 must be a mapping"),
        (FIG08, REMOVED, "missing key figures.fig08"),
        (("figure",), {}, "unknown key figure = {}; allowed here: release"),
        (("release",), "tension", "release = 'tension' must be one of displacement, force"),
        (("figures", "fig14", "tolerance"), 1, "fig14.tolerance = 1 must be less than 1"),
        ((*FIG05, "cases"), [], "figures.fig05.cases = [] must have at least 1 item"),
        ((*FIG05, "cases", 2, "amplitude"), float("nan"), "amplitude = nan must be a finite"),
        ((*FIG05, "cases", 2, "amplitude"), float("inf"), "amplitude = inf must be a finite"),
        ((*FIG05, "cases", 3, "amplitude"), 1.0, "= 1.0 must be at least 2.57039, the saddle-node"),
        ((*FIG05, "frequency_ratio", "max"), 0.5, ".min = 1.0 must be less than max = 0.5"),
        (("figures", "fig12", "amplitude"), 0.5, "= 0.5 must be at least 0.666398, the saddle"),
        (("figures", "fig08", "amplitude_max"), 0.2, "= 0.2 must be at least 0.254724, the sad"),
        (("tables", "table1", "amplitude_max"), 1.3, "at least 1.39016, the period doubling"),
        (("tables", "table1", "restitution"), 1.0, "restitution = 1.0 must be at most 0.999"),
        (("tables", "table1", "printed"), [], "unknown key tables.table1.printed = []; allowed"),
        (("tables", "table1", "n"), [], "tables.table1.n = [] must have at least 1 item"),
        (("studies", "formulas", "samples"), 7, "studies.formulas.samples = 7 must be at least 8"),
        (("tables", "thresholds", "quantities"), ["height"], "'height' must be one of max_height"),
        (("figures", "fig11", "restitution"), 0.04, "= 0.04 must be greater than 0.0433"),
        (("continuation", "initial_step"), 0.5, "must lie between smallest_step"),
    ],
)
def test_a_mistake_is_named_in_one_line(keys, value, message):
    with pytest.raises(ConfigurationError) as caught:
        check_configuration(changed(keys, value), SCHEMA)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("figure", "parameters", "said"),
    [
        ("fig07", {"frequency_ratio": 0.3}, "no 1-T orbit at Λ = 1 for ϖ = 0.3"),
        ("fig12", {"frequency_ratio": [5.0, 0.3]}, "figures.fig12.frequency_ratio = 0.3: no 1-T"),
        (
            "fig07",
            {"n": 2, "restitution": 0.3, "amplitude": 50.0, "frequency_ratio": 0.8},
            "is inadmissible: another impact",
        ),
    ],
)
def test_a_time_history_without_an_orbit_is_refused(figure, parameters, said):
    config = copy.deepcopy(CONFIG)
    config["figures"][figure] |= parameters
    check_configuration(config, SCHEMA)
    with pytest.raises(ConfigurationError) as caught:
        check_orbits(config)
    assert said in str(caught.value) and "\n" not in str(caught.value)
    check_orbits(CONFIG)
