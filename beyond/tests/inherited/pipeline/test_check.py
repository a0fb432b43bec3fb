"""Each mistake in the configuration gives its one line."""

import copy
import json
from pathlib import Path

import pytest
from bouncing_ball_beyond.inherited.paper.configuration import Configuration

from bouncing_ball_beyond.inherited.pipeline.configuration_check import (
    check_configuration,
    check_parameters,
)
from bouncing_ball_beyond.inherited.pipeline.configuration_docs import (
    configuration_page,
    configuration_schema,
)
from bouncing_ball_beyond.inherited.pipeline.yaml_files import ConfigurationError, read_yaml

FOLDER = Path(__file__).resolve().parents[2] / "config"
CONFIG = read_yaml(FOLDER / "config.yaml")
REMOVED = object()

pytestmark = pytest.mark.usefixtures("searched_once")


@pytest.fixture(scope="module")
def model():
    return Configuration


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


def test_the_shipped_configuration_is_accepted(model):
    check_parameters(model, CONFIG)


FIG05 = ("paper", "fig05")
FIG08 = ("paper", "fig08")
SPAN = (*FIG05, "frequency_ratio")


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        # A type, a key, a limit.
        ((*FIG08, "n"), 1.0, "paper.fig08.n = 1.0 must be a whole number (index n of the"),
        ((*FIG08, "n"), True, "paper.fig08.n = True must be a whole number"),
        ((*FIG08, "n"), 0, "paper.fig08.n = 0 must be at least 1"),
        ((*FIG08, "n"), 21, "paper.fig08.n = 21 must be at most 20"),
        ((*FIG08, "restitution"), REMOVED, "missing key paper.fig08.restitution: restitution"),
        ((*FIG08, "resitution"), 1, "paper.fig08.resitution = 1, did you mean restitution?"),
        (("papers",), {}, "unknown key papers = {}, did you mean paper? Allowed here: "),
        (FIG08, 3, "paper.fig08 = 3 must be a mapping of the keys n, restitution, "),
        (("paper", "fig2"), 1, "unknown key paper.fig2 = 1, did you mean fig"),
        (("paper",), 3, "paper = 3 must be a mapping"),
        (("paper",), REMOVED, "missing section paper"),
        # An artifact of another house.
        (("paper", "ext_map"), {}, "unknown key paper.ext_map = {}"),
        (("paper", "fig11"), 3, "frequency_ratio (The threshold of permanent contact of one"),
        ((*FIG08, "frequency_ratio", 1), 0.09, "frequency_ratio[1] = 0.09 must be at least 0.1"),
        ((*FIG08, "frequency_ratio", 0), "1e4", "'1e4' must be a number (powers of ten are"),
        ((*FIG08, "frequency_ratio"), [], "fig08.frequency_ratio = [] must have at least 1"),
        ((*FIG08, "frequency_ratio"), [2, 2], "fig08.frequency_ratio = [2, 2] must not repeat"),
        ((*FIG08, "frequency_ratio"), 2.0, "fig08.frequency_ratio = 2.0 must be a list"),
        (("paper", "fig14", "tolerance"), 1, "fig14.tolerance = 1 must be less than 1"),
        (("paper", "fig14", "tolerance"), 0.0, "fig14.tolerance = 0.0 must be greater than 0"),
        ((*FIG05, "cases", 2, "amplitude"), float("nan"), "amplitude = nan must be a finite"),
        ((*FIG05, "cases"), CONFIG["paper"]["fig05"]["cases"][:1] * 2, "must not repeat an item"),
        (("release",), "tension", "release = 'tension' must be 'displacement' or 'force'"),
        (("paper", "thresholds", "quantities"), ["height"], "'height' must be 'max_height', "),
        # What fits together.
        ((*SPAN, "max"), 1.0, "fig05.frequency_ratio: min = 1 must be less than max = 1"),
        (("continuation", "largest_step"), 0.01, "continuation.largest_step = 0.01 must be at lea"),
        # What the physics forbids.
        ((*FIG05, "cases", 3, "amplitude"), 2.57, "must be at least 2.57039, the saddle-node of"),
        ((*FIG05, "cases", 3, "amplitude"), 2.5704, ""),
        (("paper", "fig12", "amplitude"), 0.6663, "= 0.6663 must be at least 0.666398, the sadd"),
        (("paper", "fig10", "amplitude", 2), 0.5, "must be at least 0.509447, the saddle-node"),
        ((*FIG08, "amplitude_max"), 0.25, "= 0.25 must be at least 0.254724, the saddle-node"),
        # Of several families the highest decides how far branches must reach.
        (("paper", "fig03", "amplitude_max"), 1.27, "= 1.27 must be at least 1.27362, the sadd"),
        (("paper", "table1", "amplitude_max"), 0.76, "at least 0.764171, the saddle-node"),
    ],
)
def test_a_mistake_is_named_in_one_line(model, keys, value, message):
    config = changed(keys, value)
    try:
        check_parameters(model, config)
        said = ""
    except ConfigurationError as error:
        said = str(error)
    assert message in said and "\n" not in said and "\\n" not in said
    assert bool(message) == bool(said), said


def test_all_mistakes_are_in_one_answer(model):
    config = copy.deepcopy(CONFIG)
    config["paper"]["fig08"]["n"] = 0
    config["paper"]["fig05"]["frequency_ratio"]["min"] = -1.0
    config["paper"]["fig14"]["toleranc"] = config["paper"]["fig14"].pop("tolerance")
    del config["paper"]["table1"]["restitution"]
    del config["continuation"]
    with pytest.raises(ConfigurationError) as error:
        check_parameters(model, config)
    lines = error.value.mistakes
    assert len(lines) == 5 and all(line.isprintable() for line in lines)
    for said in (
        "unknown key paper.fig14.toleranc = 0.01, did you mean tolerance?",
        "paper.fig08.n = 0 must be at least 1",
        "paper.fig05.frequency_ratio.min = -1.0 must be at least",
        "missing key paper.table1.restitution",
        "missing section continuation",
    ):
        assert sum(line.startswith(said) for line in lines) == 1


def test_keys_that_are_missing_at_one_place_have_one_line(model):
    config = copy.deepcopy(CONFIG)
    config["paper"] = {name: config["paper"][name] for name in ("fig05", "fig06")}
    with pytest.raises(ConfigurationError) as error:
        check_parameters(model, config)
    (line,) = error.value.mistakes
    assert line.startswith("missing keys in paper: fig02, fig03, ")


def test_mistakes_in_files_and_in_their_values_are_in_one_answer(model, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("release: force\nrelease: force\n", encoding="utf-8")
    config = copy.deepcopy(CONFIG)
    config["paper"]["fig08"]["n"] = 0
    with pytest.raises(ConfigurationError) as error:
        check_configuration([path], config, model)
    first, second = error.value.mistakes
    assert first == f"{path}: duplicate key 'release' in line 2"
    assert second.startswith("configuration: paper.fig08.n = 0 must be at least 1")


def test_a_refusal_is_printable(model, one_line):
    with pytest.raises(ConfigurationError) as error:
        check_parameters(model, CONFIG | {"n\x1b[31m\n\u202e": 1})
    assert str(error.value).isprintable()
    one_line(error, r"n\x1b[31m\n\u202e")


def test_the_page_is_that_of_the_types(model):
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert page == configuration_page(model, CONFIG), "run `make config-docs`"


def test_the_schema_for_editors_has_the_sections_of_the_configuration(model):
    schema = json.loads(configuration_schema(model))
    assert schema["properties"].keys() == CONFIG.keys()
