"""Configurations that are refused, each with one line: the key, its value and what is allowed."""

import contextlib
import io
import math
from pathlib import Path

import pytest
import yaml
from snakemake.api import SnakemakeApi
from snakemake.settings.types import ConfigSettings, OutputSettings, Quietness, ResourceSettings
from snakemake.utils import update_config

ROOT = Path(__file__).resolve().parents[1]


def read_workflow(changes: dict, *files: Path) -> None:
    """Read the Snakefile with a changed configuration, without a run."""
    with (
        SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api,
        contextlib.redirect_stdout(io.StringIO()),
    ):
        workflow = api.workflow(
            resource_settings=ResourceSettings(),
            config_settings=ConfigSettings(config=changes, configfiles=files),
            snakefile=ROOT / "Snakefile",
        )
        workflow.list_rules()


def refusal(changes: dict, *files: Path) -> str:
    """The text with which a run ends before any job."""
    with pytest.raises(SystemExit) as ended:
        read_workflow(changes, *files)
    return ended.value.code


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Snakemake writes its own files into the working directory."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", "")


def nested(place: str, value) -> dict:
    """The configuration with one value at a place like `continuation.fig08.n`."""
    *above, last = place.split(".")
    config: dict = {last: value}
    for key in reversed(above):
        config = {key: config}
    return config


def test_the_configuration_in_git_is_accepted():
    read_workflow({})


def test_the_ends_of_ranges_are_accepted():
    changes: dict = {}
    for place, value in {
        "release": "force",
        "largest_step": 0.5,
        "restitution_model.fig02.restitution": 1,
        "restitution_model.fig02.samples": 20001,
        "continuation.fig08.n": 20,
        "continuation.fig08.restitution": 0.999,
        "continuation.fig08.frequency_ratio": [0.1, 1000000],
        "error_thresholds.thresholds.quantities": ["phase"],
    }.items():
        update_config(changes, nested(place, value))
    read_workflow(changes)


# A place, a value that is refused there, and what the line says after the place.
REFUSED = [
    ("release", "sticky", "'sticky' is not one of ['displacement', 'force']"),
    ("largest_step", 0.01, "0.01 is less than the minimum of 0.02"),
    ("largest_step", 0.6, "0.6 is greater than the maximum of 0.5"),
    ("continuation.fig08.n", 0, "0 is less than the minimum of 1"),
    ("continuation.fig08.n", 21, "21 is greater than the maximum of 20"),
    ("continuation.fig08.n", 1.0, "1.0 is not of type 'integer'"),
    ("continuation.fig08.n", True, "True is not of type 'integer'"),
    ("continuation.fig08.n", None, "None is not of type 'integer'"),
    ("restitution_model.fig03.n", [], "[] should be non-empty"),
    ("restitution_model.fig03.n", [1, 2, 1], "[1, 2, 1] has non-unique elements"),
    ("restitution_model.fig03.n", 1, "1 is not of type 'array'"),
    ("restitution_model.fig02.restitution", 0.04, "0.04 is less than the minimum of 0.05"),
    ("restitution_model.fig02.restitution", 1.01, "1.01 is greater than the maximum of 1"),
    ("continuation.fig15.restitution", 1, "1 is greater than the maximum of 0.999"),
    ("continuation.table1.restitution", 0.01, "0.01 is less than the minimum of 0.05"),
    ("time_histories.fig07.amplitude", 0, "0 is less than or equal to the minimum of 0"),
    ("time_histories.fig07.amplitude", 1001.0, "1001.0 is greater than the maximum of 1000"),
    ("time_histories.fig07.amplitude", math.nan, "nan is not of type 'number'"),
    ("time_histories.fig07.amplitude", math.inf, "inf is not of type 'number'"),
    ("time_histories.fig07.amplitude", "1e3", "'1e3' is not of type 'number'"),
    ("apparent_restitution.fig10.amplitude", [1.0, 1.0], "[1.0, 1.0] has non-unique elements"),
    ("apparent_restitution.fig10.amplitude", [], "[] should be non-empty"),
    ("continuation.fig09.amplitude_max", 0, "0 is less than or equal to the minimum of 0"),
    ("continuation.fig09.amplitude_max", 101, "101 is greater than the maximum of 100"),
    ("time_histories.fig07.frequency_ratio", 0.05, "0.05 is less than the minimum of 0.1"),
    ("time_histories.fig07.frequency_ratio", 2e6, "2000000.0 is greater than the maximum"),
    ("time_histories.fig12.frequency_ratio", [], "[] should be non-empty"),
    ("time_histories.fig12.frequency_ratio", [2, 2.0], "[2, 2.0] has non-unique elements"),
    ("time_histories.fig12.samples", 1, "1 is less than the minimum of 2"),
    ("time_histories.fig12.samples", 20002, "20002 is greater than the maximum of 20001"),
    ("permanent_contact.fig11.frequency_ratio.samples", 1, "1 is less than the minimum of 2"),
    ("permanent_contact.fig11.frequency_ratio.min", 0, "0 is less than the minimum of 0.1"),
    ("permanent_contact.fig11.frequency_ratio", 3, "3 is not of type 'object'"),
    ("continuation.fig08.points", 10, "10 is less than the minimum of 11"),
    ("continuation.fig08.points", 30000, "30000 is greater than the maximum of 20001"),
    ("restitution_model.fig02.periods", 0, "0 is less than the minimum of 1"),
    ("restitution_model.fig02.periods", 21, "21 is greater than the maximum of 20"),
    ("restitution_model.three_balls.phase", -11, "-11 is less than the minimum of -10"),
    ("restitution_model.three_balls.phase", 11, "11 is greater than the maximum of 10"),
    ("restitution_model.three_balls.impact_speed", 0, "0 is less than or equal to the minimum"),
    ("restitution_model.three_balls.impact_speed", 1001, "1001 is greater than the maximum"),
    ("restitution_model.three_balls.impacts", 255, "255 is less than the minimum of 256"),
    ("restitution_model.three_balls.impacts", 100001, "100001 is greater than the maximum"),
    ("error_thresholds.fig14.tolerance", 0, "0 is less than or equal to the minimum of 0"),
    ("error_thresholds.fig14.tolerance", 1, "1 is greater than or equal to the maximum of 1"),
    ("error_thresholds.thresholds.tolerances", [], "[] should be non-empty"),
    ("error_thresholds.thresholds.tolerances", [0.1, 0.1], "[0.1, 0.1] has non-unique elements"),
    ("error_thresholds.thresholds.quantities", [], "[] should be non-empty"),
    ("error_thresholds.thresholds.quantities", ["phase"] * 2, "['phase', 'phase'] has non-unique"),
    ("apparent_restitution.fig05.cases", [], "[] should be non-empty"),
    ("apparent_restitution.fig05", None, "None is not of type 'object'"),
    ("continuation.lowest_doubling", [], "[] is not of type 'object'"),
]


def rounds() -> list[list[tuple]]:
    """The cases in groups, in each of which no figure occurs twice."""
    found: list[dict] = []
    for case in REFUSED:
        figure = ".".join(case[0].split(".")[:2])
        free = next((group for group in found if figure not in group), None)
        if free is None:
            found.append(free := {})
        free[figure] = case
    return [[*group.values()] for group in found]


@pytest.mark.parametrize("cases", rounds())
def test_each_wrong_value_is_refused_with_its_key_and_what_is_allowed(cases):
    changes: dict = {}
    for place, value, _ in cases:
        update_config(changes, nested(place, value))
    lines = refusal(changes).splitlines()
    assert len(lines) == len(cases)
    for place, _, said in cases:
        assert [line for line in lines if line.startswith(f"configuration: {place}: {said}")]


CASE = {"restitution": 0.65, "amplitude": 1.0}
INSIDE = [
    (
        nested("error_thresholds.thresholds.quantities", ["phase", "heigth"]),
        "error_thresholds.thresholds.quantities[1]: 'heigth' is not one of ['max_height', ",
    ),
    (
        nested("apparent_restitution.fig06.cases", [CASE, CASE | {"restitution": 0}]),
        "apparent_restitution.fig06.cases[1].restitution: 0 is less than the minimum of 0.05",
    ),
    (
        nested("apparent_restitution.fig06.cases", [{"restitution": 0.65}]),
        "apparent_restitution.fig06.cases[0]: 'amplitude' is a required property",
    ),
    (
        nested("apparent_restitution.fig06.cases", [CASE, CASE]),
        "apparent_restitution.fig06.cases: [{",
    ),
]


@pytest.mark.parametrize("changes, said", INSIDE)
def test_a_mistake_inside_a_list_names_the_entry(changes, said):
    line = refusal(changes)
    assert line.startswith(f"configuration: {said}") and "\n" not in line


@pytest.mark.parametrize(
    "place, nearest",
    [
        ("relase", "release"),
        ("continuaton", "continuation"),
        ("continuation.fig8", "fig08"),
        ("continuation.fig08.restituton", "restitution"),
        ("permanent_contact.fig11.frequency_ratio.sample", "samples"),
    ],
)
def test_a_misspelt_key_is_named_with_the_nearest_right_one(place, nearest):
    line = refusal(nested(place, 1))
    assert line == f"configuration: unknown key {place}, allowed: {nearest}"


def test_a_key_like_no_other_is_named_with_all_that_are_allowed():
    line = refusal(nested("permanent_contact.fig11.frequency_ratio.xyz", 1))
    assert line.endswith("frequency_ratio.xyz, allowed: min, max, samples")


@pytest.mark.parametrize(
    "changes, said",
    [
        (
            nested("permanent_contact.fig11.frequency_ratio", {"min": 2.0, "max": 2.0}),
            "permanent_contact.fig11.frequency_ratio.min = 2.0: must be less than max = 2.0",
        ),
        (
            nested("time_histories.fig07.amplitude", 0.25),
            "time_histories.fig07.amplitude = 0.25: must be at least 0.254724, the saddle-node of "
            "the 1-T orbit at r = 0.85 (Eq. 7)",
        ),
        # The highest family has to exist.
        (
            nested("continuation.table1.amplitude_max", 0.7),
            "continuation.table1.amplitude_max = 0.7: must be at least 0.764171, the saddle-node "
            "of the 3-T orbit at r = 0.85 (Eq. 7)",
        ),
        # At r = 0.1 the saddle-node is at 9π/11.
        (
            nested("apparent_restitution.fig05.cases", [CASE | {"restitution": 0.1}]),
            "apparent_restitution.fig05.cases[0].amplitude = 1.0: must be at least 2.57039, the "
            "saddle-node of the 1-T orbit at r = 0.1 (Eq. 7)",
        ),
        (
            nested("apparent_restitution.fig10.amplitude", [1.0, 0.5]),
            "apparent_restitution.fig10.amplitude = 0.5: must be at least 0.509447, the "
            "saddle-node of the 2-T orbit at r = 0.85 (Eq. 7)",
        ),
    ],
)
def test_what_a_schema_cannot_know_is_refused_too(changes, said):
    assert refusal(changes) == f"configuration: {said}"


def test_every_mistake_has_a_line():
    lines = refusal({"release": "x", "largest_step": 1}).splitlines()
    assert [line.split(":")[1].strip() for line in lines] == ["release", "largest_step"]


def test_a_key_that_a_file_names_twice_is_refused(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("release: force\npermanent_contact:\n  fig11: {}\n  fig11: {}\n", "utf-8")
    line = refusal({}, file)
    assert line == f"configuration: {file}: permanent_contact.fig11 occurs twice, in line 4 again"


def test_parameters_are_described_and_bounded():
    """Every number of the schema has both bounds, and a mistake ends with a reason."""
    schema = yaml.safe_load((ROOT / "config/schema.yaml").read_text("utf-8"))

    def check(node):
        if isinstance(node, dict):
            if node.get("type") in ("integer", "number"):
                assert "description" in node
                assert {"minimum", "exclusiveMinimum"} & node.keys()
                assert {"maximum", "exclusiveMaximum"} & node.keys()
            if node.get("type") == "object":
                assert node["additionalProperties"] is False
                assert node["required"] == list(node["properties"])
            for each in node.values():
                check(each)

    check(schema)
