"""The shipped ledger is accepted, and each mistake in it is one line that names the claim."""

import copy
import shutil
from pathlib import Path

import pytest

from bouncing_ball.claims.ledger_file import parse_ledger, read_ledger
from bouncing_ball.configuration.conformity import ConfigurationError, check_schema
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.errors import ModelError

ROOT = Path(__file__).resolve().parents[2]
MAPPING, SCHEMA = (
    read_yaml(ROOT / "config" / name) for name in ("claims.yaml", "claims.schema.yaml")
)
LEDGER = parse_ledger(MAPPING)


def test_the_shipped_ledger_is_accepted():
    assert read_ledger(ROOT / "config") == LEDGER


def entry(mapping, name):
    return next(claim for claim in mapping["claims"] if claim["id"] == name)


def changed(change):
    mapping = copy.deepcopy(MAPPING)
    change(mapping)
    return mapping


def on(name, **values):
    return lambda mapping: entry(mapping, name).update(values)


def without(name, key):
    return lambda mapping: entry(mapping, name).pop(key)


SOURCE = {"dataset": "fig14", "variable": "error_threshold"}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (on("sticking", claim=1), "unknown key claims['sticking'].claim = 1; allowed here: id, "),
        (
            lambda m: entry(m, "sticking")["decided_by"].update(place={}),
            "unknown key claims['sticking'].decided_by.place = {}; allowed here: dataset, ",
        ),
        (lambda m: m.update(notes=""), "unknown key notes = ''; allowed here: close_units, "),
        (without("sticking", "statement"), "missing key claims['sticking'].statement"),
        (without("sticking", "kind"), "missing key claims['sticking'].kind"),
        (without("sticking", "id"), "].id"),
        (without("height threshold", "printed"), "missing key claims['height threshold'].printed"),
        (
            on("height threshold", printed=82),
            "claims['height threshold'].printed = 82 must be a text (a number as printed",
        ),
        (
            on("height threshold", printed="about 82"),
            "claims['height threshold'].printed = 'about 82' must be a number as printed",
        ),
        (
            lambda m: entry(m, "departure from nπ").update(decided_by=SOURCE),
            "claims['departure from nπ'] must have one of decided_by, readings; it has "
            "decided_by and readings",
        ),
        (
            without("height threshold", "decided_by"),
            "claims['height threshold'] must have one of decided_by, readings; it has none",
        ),
        (
            lambda m: entry(m, "departure from nπ")["readings"].__delitem__(slice(1, None)),
            "claims['departure from nπ'].readings = ",
        ),
        (
            on("sticking", condition={}),
            "claims['sticking'].condition must have one of at_most, at_least, below, above; "
            "it has none",
        ),
        (
            on("stiff row", condition={"text": "they agree"}),
            "claims['stiff row'].condition must have one of at_most, at_least, below, above; "
            "it has none",
        ),
        (
            on("stiff row", condition={"at_most": "1"}),
            "missing key claims['stiff row'].condition.text",
        ),
        (
            on("sticking", condition={"at_most": "1", "below": "2"}),
            "claims['sticking'].condition must have one of at_most, at_least, below, above; "
            "it has at_most and below",
        ),
        (
            on("sticking", condition={"at_most": 1}),
            "claims['sticking'].condition.at_most = 1 must be a number as a text, or {variable}",
        ),
        (
            lambda m: entry(m, "static table")["readings"][1].pop("condition"),
            "missing key claims['static table'].readings[1].condition",
        ),
        (on("sticking", kind="guess"), "claims['sticking'].kind = 'guess' must be one of number,"),
        (on("sticking", legibility="bad"), "legibility = 'bad' must be one of clear, damaged,"),
        (on("sticking", statement=""), "claims['sticking'].statement = '' must not be empty"),
        (on("sticking", item="a" * 5000), "... must have at most 1000 characters (a text"),
        (
            lambda m: entry(m, "stiff row")["decided_by"].update(reduce="mean"),
            "claims['stiff row'].decided_by.reduce = 'mean' must be one of max, min, sum",
        ),
        (
            lambda m: entry(m, "Table 1")["printed"][0][1].__setitem__(0, 0.509),
            "printed at frequency_ratio = 10000.0, n = 2, bound = saddle-node is 0.509, not a",
        ),
        (
            lambda m: entry(m, "Table 1")["printed"].pop(),
            "table 'Table 1': printed is not a list of 3, one for each frequency_ratio",
        ),
        (
            on("period doubling", explanation="Holmes"),
            "claim 'period doubling': unknown explanation 'Holmes'; known: ",
        ),
        (on("sticking", id="damping"), "claim 'damping' is defined twice in the ledger"),
        (
            lambda m: m["explanations"][1].update(id=m["explanations"][0]["id"]),
            "is defined twice in the ledger",
        ),
        (
            lambda m: m["explanations"][0].update(checks=[]),
            "explanations['linear at fixed duration'].checks = [] must have at least 1 item",
        ),
        (
            lambda m: m["explanations"][0]["checks"][0].update(condition={}),
            "explanations['linear at fixed duration'].checks[0].condition must have one of ",
        ),
        (lambda m: m.update(close_units=0.1), "close_units = 0.1 must be at least 0.5"),
        (lambda m: m["parameters"].update(fig03=1), "parameters.fig03 = 1 must be a mapping"),
        (
            lambda m: m["parameters"]["fig14"].update(n={"least": 1}),
            "unknown key parameters.fig14.n.least = 1; allowed here: at_least, at_most, includes",
        ),
    ],
)
def test_a_mistake_is_one_line_that_names_the_claim(change, message, one_line):
    mapping = changed(change)
    with pytest.raises(ModelError) as error:
        # As the ledger's file is read.
        check_schema(mapping, SCHEMA)
        parse_ledger(mapping)
    one_line(error, message)
    assert len(str(error.value)) < 500


def test_a_file_that_is_not_yaml(tmp_path, one_line):
    (tmp_path / "claims.schema.yaml").write_text("{}", encoding="utf-8")
    (tmp_path / "claims.yaml").write_text("claims:\n  - id: [1\nb: 2\n", encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_ledger(tmp_path)
    one_line(error, "not YAML in line 3")


def test_numbers_are_finite(one_line):
    with pytest.raises(ConfigurationError) as error:
        check_schema(changed(lambda m: m.update(close_units=float("nan"))), SCHEMA)
    one_line(error, "close_units = nan must be a finite number")


def test_datasets_that_the_pipeline_does_not_make(one_line, tmp_path):
    made = {*LEDGER.datasets, "fig02"}
    assert read_ledger(ROOT / "config", made) == LEDGER
    with pytest.raises(ConfigurationError) as error:
        read_ledger(ROOT / "config", made - {"fig16"})
    one_line(error, "unknown dataset fig16; known: ")
    for name in ("claims.yaml", "claims.schema.yaml"):
        shutil.copy(ROOT / "config" / name, tmp_path)
    path = tmp_path / "claims.yaml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("\n  fig03: {", "\n  fig99.x: {", 1), encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_ledger(tmp_path, made)
    one_line(error, "unknown dataset fig99; known: ")


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("variable: computed_softening", "variable: softness"),
        ("bound: saddle-node", "softness: saddle-node"),
    ],
)
def test_variables_that_no_dataset_has(one_line, tmp_path, right, wrong):
    shutil.copy(ROOT / "config" / "claims.schema.yaml", tmp_path)
    text = (ROOT / "config" / "claims.yaml").read_text(encoding="utf-8")
    assert right in text
    (tmp_path / "claims.yaml").write_text(text.replace(right, wrong, 1), encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_ledger(tmp_path)
    one_line(error, ": unknown variable softness; src/bouncing_ball/datasets/variables.py")
