"""The tolerance file: complete, as the convergence study says, and refused in one line."""

import csv
import math
from pathlib import Path

import pytest
import yaml

from bouncing_ball.claims.convergence import computations, variations
from bouncing_ball.compare.budgets import MEASURED
from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.compare.tolerances import Mode, Tolerance, ToleranceError
from bouncing_ball.configuration.yaml_file import ConfigurationError
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.datasets.variables import VARIABLES

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "config" / "tolerances.yaml"
RECORD = {path.stem: path for path in sorted((ROOT / "figures").glob("*.nc"))}
# Ten times the largest change seen: the study tries a handful of variations.
MARGIN = 10
# In shares of the scale; 450 units in the last place of it. A formula here
# chains fewer than a hundred operations, and the elementary functions of
# mathematics libraries differ by a unit or two in the last place each.
FLOOR = 1e-13
# In grey levels of 255: one pixel in ten thousand one level off. Antialiasing
# rounds every pixel of an edge to a level, and an edge may round the other way.
PICTURE_FLOOR = 0.01


def budget_for(change, floor=FLOOR):
    """The power of ten next above ten times the change, and not below the floor."""
    if change == 0:
        return floor
    return max(float(f"1e{math.ceil(math.log10(MARGIN * change))}"), floor)


@pytest.fixture(scope="module")
def study():
    """(artifact, variable) → largest change, as accepted."""
    with (ROOT / "config" / "convergence.csv").open(encoding="utf-8", newline="") as file:
        return {
            (row["artifact"], row["variable"]): max(
                float(row[kind]) for kind in ("tolerances", "grid", "rounding") if row[kind]
            )
            for row in csv.DictReader(file)
        }


def entries(rules):
    yield from ((("", name), rule) for name, rule in rules.variables.items())
    for artifact, part in rules.artifacts.items():
        yield from (((artifact, name), rule) for name, rule in part.items())


def test_every_budget_is_the_one_the_study_gives(rules, study):
    largest = {}
    for (artifact, variable), change in study.items():
        # An entry without artifact holds for all that have none of their own.
        own = variable in rules.artifacts.get(artifact, {})
        key = artifact if own else "", variable
        largest[key] = max(change, largest.get(key, 0.0))
    picture = max(change for (_, variable), change in study.items() if variable == "picture")
    del largest["", "picture"]
    expected = {key: budget_for(change) for key, change in largest.items()}
    stated = {key: rule.budget for key, rule in entries(rules) if rule.source.startswith(MEASURED)}
    assert stated == expected
    assert rules.pictures.budget == budget_for(picture, PICTURE_FLOOR)


@pytest.mark.parametrize("name", RECORD)
def test_every_variable_has_an_entry_and_is_in_the_study(name, rules, study, record_and_new):
    data = record_and_new[name]
    for variable in map(str, data.variables):
        rule = rules.of(name, variable)
        assert rule is not None, f"{name}: {variable} needs an entry in {FILE.name}"
        if rule.source.startswith(MEASURED):
            assert (name, variable) in study, f"{name}: {variable} is not in the study"
        for other in (rule.along, rule.abscissa, rule.scale):
            assert not isinstance(other, str) or other in {*data.variables, *data.dims}


def test_no_entry_is_idle(rules, record_and_new):
    names = {name: set(map(str, data.variables)) for name, data in record_and_new.items()}
    assert set(rules.variables) <= set().union(*names.values())
    for artifact, part in rules.artifacts.items():
        assert set(part) <= names[artifact]
    assert set(rules.variables) <= set(VARIABLES)


def test_numbers_that_are_counted_or_read_are_exact(rules, record_and_new):
    for name, data in record_and_new.items():
        for variable in map(str, data.variables):
            mode = rules.of(name, variable).mode
            if data[variable].dtype.kind in "iUO":
                assert mode in (Mode.EXACT, Mode.IGNORED), (name, variable)


def test_yes_or_no_may_change_at_one_sample(rules):
    found = [(key, rule) for key, rule in entries(rules) if rule.source.startswith("one sample")]
    assert len(found) > 5
    for (artifact, name), rule in found:
        count = read_dataset(RECORD[artifact]).sizes[rule.along]
        assert f"one sample of {count}:" in rule.source
        assert read_dataset(RECORD[artifact])[name].dtype == bool
        # More than one step of the index, less than two.
        assert 1 / (count - 1) < rule.budget < 2 / (count - 1)


# Stages that take less than two seconds for all their variations.
@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["fig02", "fig03", "fig07", "fig10", "fig11", "fig12", "fig15", "fig16"]
)
def test_every_variation_is_within_budget(name, rules):
    config = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))
    stage = computations(config | {"printed": {}})[name]
    base = stage.run()
    seen = 0
    for kind, data in variations(stage, base):
        for result in compare_datasets(name, base, data, rules):
            # The study moves r itself, a parameter, which is exact.
            if result.name != "restitution":
                assert result.outcome.agrees, (kind, result)
                seen += 1
    assert seen > len(base.variables)


def test_the_rule():
    assert budget_for(1.01e-5) == 1e-3
    assert budget_for(0.99e-5) == 1e-4
    assert budget_for(1e-20) == FLOOR
    assert budget_for(0.0, 0.01) == 0.01


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"mode": Mode.POINTWISE}, "mode pointwise needs budget"),
        ({"mode": Mode.CURVE, "budget": 1.0, "along": "t"}, "mode curve needs abscissa"),
        ({"mode": Mode.IGNORED, "scale": 1.0}, "mode ignored has no scale"),
        ({"mode": Mode.POINTWISE, "budget": 1.0, "along": "t"}, "mode pointwise has no along"),
    ],
)
def test_tolerances_that_make_no_sense(options, said, one_line):
    with pytest.raises(ToleranceError) as error:
        Tolerance(source="a test", **options)
    one_line(error, said)


MINIMAL = {
    "variables": {"phase": {"mode": "pointwise", "budget": 1e-9, "source": "a test"}},
    "pictures": {"budget": 1.0, "source": "a test"},
}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"variables": {"phase": {"mode": "close", "source": "x"}}}, "variables.phase.mode"),
        ({"variables": {"phase": {"mode": "exact"}}}, "missing key variables.phase.source"),
        ({"variables": {"phase": {"mode": "exact", "source": " "}}}, "source = ' ' must be where"),
        ({"pictures": {"budget": float("inf"), "source": "x"}}, "budget = inf must be a finite"),
        (
            {"variables": {"phase": MINIMAL["variables"]["phase"] | {"scale": 0.0}}},
            "variables.phase.scale = 0.0 must be greater than 0",
        ),
        ({"variables": {"phase": {"mode": "pointwise", "source": "x"}}}, "variables.phase: mode"),
        (
            {"variables": {"phase": {"mode": "exact", "source": "x", "budgte": 1}}},
            "unknown key variables.phase.budgte",
        ),
        ({"pictures": {"budget": -1.0, "source": "x"}}, "pictures.budget"),
        ({"artifacts": {"fig08": {"phase": 1}}}, "artifacts.fig08.phase"),
        ({"ignored_attributes": ["title"]}, "ignored_attributes"),
        ({"variables": 3}, "variables"),
        ({"variable": {}}, "unknown key variable"),
    ],
)
def test_a_mistake_in_the_file_is_one_line(change, said, tmp_path, one_line):
    path = tmp_path / "tolerances.yaml"
    path.write_text(yaml.safe_dump(MINIMAL), encoding="utf-8")
    assert read_tolerances(path).of("any", "phase").budget == 1e-9
    path.write_text(yaml.safe_dump(MINIMAL | change), encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_tolerances(path)
    one_line(error, said, path.name)


@pytest.mark.parametrize("content", [b"variables: [", b"\xff\xfe", b"", b"- a list"])
def test_a_file_that_is_no_tolerance_file(content, tmp_path, one_line):
    path = tmp_path / "tolerances.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigurationError) as error:
        read_tolerances(path)
    one_line(error, path.name)
    with pytest.raises(ConfigurationError) as error:
        read_tolerances(tmp_path / "none.yaml")
    one_line(error, "none.yaml: No such file")


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (
            {"variables": {"phaze": {"mode": "exact", "source": "x"}}},
            "no dataset has a variable phaze",
        ),
        (
            {
                "variables": {
                    "phase": {
                        **{"mode": "curve", "budget": 1.0, "source": "x"},
                        **{"along": "pont", "abscissa": "amplitude"},
                    }
                }
            },
            "variables.phase: no dataset has a variable pont",
        ),
    ],
)
def test_a_misspelt_name_is_refused(entry, said, tmp_path, one_line):
    path = tmp_path / "tolerances.yaml"
    path.write_text(yaml.safe_dump(MINIMAL | entry), encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_tolerances(path)
    one_line(error, said, path.name)
