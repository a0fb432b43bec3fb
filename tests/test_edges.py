"""Every configuration that the schema allows gives a true page, or one line that names its key.

Each key is tried alone, at its bounds, reversed, with equal ends and with a single value; then the
configurations that once gave an empty picture, a false sentence or an exception. Grids are coarse.
"""

import copy
import inspect
import json
import re
import warnings
from collections.abc import Iterator

import numpy as np
import pytest
import yaml
from matplotlib.text import Text
from tests.reference import CONFIG, ENTRIES, ROOT, reference, stage

from bouncing_ball import article, figures, pages, paper, tables
from bouncing_ball.claims import CLAIMS, judge, table1_ends
from bouncing_ball.configuration import mistakes
from bouncing_ball.continuation import NoOrbit
from bouncing_ball.figures import Empty

SCHEMA = yaml.safe_load((ROOT / "config/schema.yaml").read_text("utf-8"))
STAGES = [name for name, each in CONFIG.items() if isinstance(each, dict)]
COARSE = {"samples": 9, "points": 21, "places": 5, "impacts": 256}
"""Sizes of grids; their upper bounds are not tried, because they take minutes."""
UNTRUE = re.compile(
    r"\bnan\b|\bNone\b(?! of)|\binf\b|–––|\w+Error\b|NoOrbit|not asked \(|is not asked|= –"
    r"|\b(?:about|above|and|at|below|between|by|for|is|of|than|to) –"
)
"""What no text may have: a number or a verdict that is missing, or the name of an exception."""


def coarse(value):
    """The same parameters with few points."""
    if isinstance(value, dict):
        return {key: COARSE.get(key, coarse(each)) for key, each in value.items()}
    return [coarse(each) for each in value] if isinstance(value, list) else value


CONFIGURATION = coarse(CONFIG)


def resolved(schema: dict) -> dict:
    """A schema with the definitions to which it refers."""
    name = schema.get("$ref", "").rpartition("/")[2]
    return (resolved(SCHEMA["$defs"][name]) | schema) if name else schema


def others(schema: dict, value, key: str = "") -> Iterator:
    """Other values of a key, at the edges of its schema."""
    schema = resolved(schema)
    if isinstance(value, dict) and "min" in value:
        inner = schema["properties"]
        for end in ("min", "max"):
            for bound in others(inner[end], value[end]):
                yield value | {end: bound}
        yield value | {"min": value["max"], "max": value["min"]}
        yield value | {"min": value["max"]}
        yield value | {"samples": 2}
    elif isinstance(value, list):
        yield value[:1]
        yield value[::-1]
        items = resolved(schema["items"])
        if "type" in items and items["type"] != "object":
            for bound in others(items, value[0]):
                yield [bound]
    elif isinstance(value, int | float) and not isinstance(value, bool):
        whole = schema["type"] == "integer"
        for name, step in (("minimum", 0), ("exclusiveMinimum", 1e-3)):
            if name in schema:
                yield schema[name] + step
        if key not in COARSE:
            for name, step in (("maximum", 0), ("exclusiveMaximum", 1e-3)):
                if name in schema:
                    yield schema[name] - step
            if not whole:
                yield value / 7


def edges() -> Iterator[tuple[str, str, dict]]:
    """Stage, name and the changed parameters of each case."""
    for section in STAGES:
        for name, entry in CONFIGURATION[section].items():
            # A new figure may have any parameters.
            known = SCHEMA["properties"][section]["properties"].get(name, {})
            properties = resolved(known) if name != "title" else {}
            for key, schema in properties.get("properties", {}).items():
                for value in others(schema, entry[key], key) if key in entry else ():
                    if value != entry[key]:
                        yield section, name, {key: value}


CASES = [
    ("restitution_model", "fig02", {"amplitude": 0.2}),
    ("restitution_model", "fig03", {"amplitude_max": 0.2}),
    ("restitution_model", "three_balls", {"amplitude": [1.2, 1.6]}),
    ("apparent_restitution", "fig05", {"cases": [{"restitution": 0.1, "amplitude": 2.6}]}),
    ("apparent_restitution", "fig06", {"n": 5}),
    (
        "apparent_restitution",
        "fig06",
        {"n": 5, "cases": [{"restitution": 0.65, "amplitude": 3.5}]},
    ),
    ("apparent_restitution", "fig06", {"frequency_ratio": {"min": 0.25, "max": 1.9, "samples": 9}}),
    (
        "apparent_restitution",
        "fig13",
        {"frequency_ratio": {"min": 41.0, "max": 62.0, "samples": 9}},
    ),
    ("permanent_contact", "fig16", {"restitution": 0.94, "tolerance": 0.5}),
    ("apparent_restitution", "fig10", {"restitution": 0.1, "amplitude": [5.0, 6.0]}),
    ("continuation", "table1", {"frequency_ratio": [50.0, 30.0]}),
    ("continuation", "table1", {"frequency_ratio": [1e4, 50.0, 10.0, 2.0]}),
    (
        "continuation",
        "table1",
        {"restitution": 0.1, "n": [2], "frequency_ratio": [0.7]},
    ),
    ("continuation", "lowest_doubling", {"restitution": 0.1, "n": [2, 20]}),
    ("error_thresholds", "thresholds", {"n": 5, "amplitude": 3.5, "tolerances": [0.9, 0.5, 0.1]}),
    (
        "error_thresholds",
        "thresholds",
        {"n": 3, "restitution": 0.1, "amplitude": 8.0, "tolerances": [0.5]},
    ),
    ("error_thresholds", "fig14", {"n": 5, "amplitude": 3.5}),
    ("validity", "validity_map", {"restitution": {"min": 0.95, "max": 0.05, "samples": 31}}),
    ("validity", "validity_map", {"advised": 3.0}),
    ("validity", "validity_map", {"n": [2]}),
    ("validity", "validity_map", {"frequency_ratio": {"min": 316.0, "max": 1760.0, "samples": 9}}),
    ("validity", "validity_map", {"curves": [{"n": 2, "restitution": 0.36, "amplitude": 9.0}]}),
    ("time_histories", "fig07", {"restitution": 0.1, "amplitude": 2.6, "frequency_ratio": 0.5}),
    ("time_histories", "fig12", {"restitution": 0.999, "n": 5, "amplitude": 0.02}),
    ("time_histories", "fig12", {"frequency_ratio": [0.3, 20.0]}),
]


def changed(section: str, name: str, changes: dict) -> dict:
    """The configuration with coarse grids and with some parameters of an entry changed."""
    config = copy.deepcopy(CONFIGURATION)
    config[section][name] |= changes
    return config


def computed(section: str, name: str, config: dict):
    """The dataset of an entry, as the job of its stage saves it."""
    function = stage(section).STAGE[name]
    known = inspect.signature(function).parameters
    settings = {key: config[key] for key in ("release", "largest_step") if key in known}
    entry = {key: each for key, each in config[section][name].items() if key != "title"}
    given = {key: each for key, each in entry.items() if key not in ("caption", "table")}
    with warnings.catch_warnings(action="error"):
        data = function(dict(given), **settings)
    return data.assign_attrs(
        title=ENTRIES[name]["title"], parameters=json.dumps(given | settings, sort_keys=True)
    )


def assert_is_drawn(name: str, data) -> None:
    """Each panel has finite data or a text, and nothing that cannot be drawn."""
    figure = figures.draw(name, data)
    for axes in figure.axes:
        points = [np.isfinite(np.asarray(line.get_ydata(), float)).any() for line in axes.lines]
        assert any(points) or axes.texts or axes.patches, name
        texts = [text.get_text() for text in axes.findobj(Text)]
        assert not [text for text in texts if UNTRUE.search(text)]
    for legend in figure.legends:
        for text in legend.get_texts():
            assert not UNTRUE.search(text.get_text())


def assert_is_true(changed: dict) -> None:
    """Texts have no gap, and no verdict on what this run was not asked.

    The datasets that are not changed are those of the reference.
    """
    datasets = {**reference(), **changed}
    datasets["claims"] = judge(datasets).assign_attrs(reference()["claims"].attrs)
    judged = datasets["claims"].set_index(claim="claim").verdict
    for name, data in changed.items():
        if paper.other_parameters(name, data, paper.PARAMETERS.get(name, {})):
            for claim in [*CLAIMS, *table1_ends()]:
                if name in claim.datasets:
                    assert judged.sel(claim=claim.name) == "not asked"
    texts = {
        "paper": article.filled_in("paper", datasets),
        "supplement": article.filled_in("supplement", datasets),
        "index": pages.filled_in("html", datasets, ENTRIES),
        "claims": tables.claims_markdown(datasets["claims"]),
    }
    for name in tables.TABLES.keys() & changed.keys():
        texts[name] = tables.markdown(tables.TABLES[name](changed[name]))
    for title, text in texts.items():
        body = re.sub(r"(?s)<style>.*?</style>", "", text)
        found = [line for line in body.splitlines() if UNTRUE.search(line)]
        assert not found, (title, found)


def assert_edge(section: str, name: str, changes: dict) -> None:
    """One line that names the key, or a dataset with a true picture and true texts."""
    config = changed(section, name, changes)
    lines = list(mistakes(config, SCHEMA))
    if lines:
        assert all(line.startswith(f"{section}.{name}.") for line in lines)
        return
    try:
        data = computed(section, name, config)
        if name in figures.PLOTS:
            assert_is_drawn(name, data)
    except (NoOrbit, Empty) as error:
        assert re.search(r"give|must|need|above", str(error)) and "\n" not in str(error)
        return
    assert_is_true({name: data})


@pytest.mark.parametrize(("section", "name", "changes"), [*edges(), *CASES], ids=str)
def test_a_configuration_at_an_edge_gives_a_true_page_or_one_line(section, name, changes):
    assert_edge(section, name, changes)


@pytest.mark.parametrize(
    ("key", "value"), [("release", "force"), ("largest_step", 0.02), ("largest_step", 0.5)]
)
def test_a_setting_of_all_stages_gives_true_pages(key, value):
    config = CONFIGURATION | {key: value}
    found = {}
    for section in STAGES:
        for name in CONFIGURATION[section].keys() & reference().keys():
            if key in inspect.signature(stage(section).STAGE[name]).parameters:
                found[name] = computed(section, name, config)
                if name in figures.PLOTS:
                    assert_is_drawn(name, found[name])
    assert len(found) >= 3
    assert_is_true(found)
