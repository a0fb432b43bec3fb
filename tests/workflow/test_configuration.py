"""Each mistake in the configuration gives its one line."""

import copy
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from bouncing_ball.configuration.check import (
    ConfigurationError,
    check_configuration,
    check_orbits,
)

ROOT = Path(__file__).resolve().parents[2]
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))
SCHEMA = yaml.safe_load((ROOT / "config" / "schema.yaml").read_text(encoding="utf-8"))
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
        (("studies", "evidence", "stiff_frequency_ratio"), 0, "ratio = 0 must be at least 0.1"),
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


def test_the_workflow_stops_at_once_and_touches_nothing(complete):
    before = {k: (complete.path / k).stat().st_mtime_ns for k in complete.contents()}
    complete.configure("figures", "fig08", "restitution", value=1.2)
    del before["config/config.yaml"]
    done = complete.run("--cores", "2", check=False)
    assert done.returncode == 1
    # Snakemake itself says which profile it uses; the rest is ours.
    said = [line for line in done.stderr.splitlines() if not line.startswith("Using ")]
    assert len(said) == 1
    assert said[0].startswith(
        "configuration: figures.fig08.restitution = 1.2 must be at most 0.999"
    )
    after = {k: (complete.path / k).stat().st_mtime_ns for k in before}
    assert after == before


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "config/config.yaml: duplicate key 'release' in line "),
        (("--configfile", "mine.yaml"), "mine.yaml: '1:30' in line 1 is read differently"),
    ],
)
def test_what_snakemake_reads_without_a_word(fresh, options, said):
    if options:
        (fresh.path / "mine.yaml").write_text("figures: {fig08: {points: 1:30}}\n")
    else:
        with (fresh.path / "config/config.yaml").open("a") as file:
            file.write("release: force\n")
    assert refusal(fresh, *options).startswith(said)


def test_the_package_of_another_checkout_is_refused(fresh, tmp_path):
    # Run as it would be with that checkout's environment.
    shutil.copytree(fresh.path / "src", tmp_path / "other")
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "other")}
    said = refusal(fresh, environment=environment)
    assert said.startswith(f"bouncing_ball is imported from {tmp_path / 'other'}")
    assert str(fresh.path / "src") in said


def test_a_python_whose_path_has_a_space_is_refused(fresh, tmp_path):
    venv = tmp_path / "a venv"
    (venv / "bin").mkdir(parents=True)
    (venv / "bin" / "python").symlink_to(Path(sys.executable).resolve())
    shutil.copyfile(Path(sys.prefix, "pyvenv.cfg"), venv / "pyvenv.cfg")
    (venv / "lib").symlink_to(Path(sys.prefix, "lib"))
    said = refusal(fresh, python=venv / "bin" / "python")
    assert said.startswith(f"{venv}/bin/python: a path of Python with a space")


def test_make_refuses_a_path_with_a_space(tmp_path):
    folder = tmp_path / "a checkout"
    folder.mkdir()
    shutil.copyfile(ROOT / "Makefile", folder / "Makefile")
    for options, status in (((), 2), (("VENV=/venv",), 0)):
        done = subprocess.run(
            ["make", "--dry-run", "clean", *options],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == status
        assert ("the path of this checkout has a space" in done.stderr) == (status == 2)


def refusal(tree, *options, python=sys.executable, environment=None):
    """The line with which a run ends before anything is run."""
    done = subprocess.run(
        [python, "-m", "snakemake", "--cores", "1", *options],
        cwd=tree.path,
        env=environment or tree.environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    # Snakemake itself says which profile and files it uses; the rest is ours.
    own = ("Using ", "Config file ")
    (said,) = [line for line in done.stderr.splitlines() if not line.startswith(own)]
    return said
