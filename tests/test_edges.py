"""Every configuration that the schema allows gives true results, or one line that names its key.

Each key is tried alone, at its bounds, reversed, with equal ends and with a single value; then the
configurations that once gave an empty picture, a false sentence or an exception. Grids are coarse.
What depends on the changed dataset is judged: its picture, its claims, its table, and the article
if it still is that of the paper.
"""

import copy
import json
import re
from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest
import yaml
from tests import independent
from tests.checkout import ROOT
from tests.reference import CONFIG, ENTRIES, reference, stage, without_gaps

from bouncing_ball.orbits import NoOrbit
from carbonelli2011 import article, figures, index, paper, tables
from carbonelli2011.claims import CLAIMS, CONTACT_OF_FIG11, judge, table1_ends
from carbonelli2011.figures import Empty
from paper_replication.configuration import mistakes
from paper_replication.datasets import computed, other_parameters, settings_of
from paper_replication.verdicts import VERDICTS, answer

SCHEMA = yaml.safe_load((ROOT / "config/schema.yaml").read_text("utf-8"))
STAGES = [name for name in CONFIG if (ROOT / f"src/carbonelli2011/stages/{name}.py").exists()]
COARSE = {"samples": 7, "points": 15, "places": 4, "impacts": 256}
"""Sizes of grids. Their upper bounds are not tried, because they take minutes."""


def coarse(value):
    """The same parameters with few points."""
    if isinstance(value, dict):
        return {key: COARSE.get(key, coarse(part)) for key, part in value.items()}
    return [coarse(part) for part in value] if isinstance(value, list) else value


CONFIGURATION = coarse(CONFIG) | {"largest_step": 0.5}


def resolved(schema: dict) -> dict:
    """A schema with the definitions to which it refers."""
    name = schema.get("$ref", "").rpartition("/")[2]
    return (resolved(SCHEMA["$defs"][name]) | schema) if name else schema


def others(schema: dict, value) -> Iterator:
    """Other values of a key, at the edges of its schema."""
    schema = resolved(schema)
    if isinstance(value, dict) and "min" in value:
        inner = schema["properties"]
        low, *_ = others(inner["min"], value["min"])
        *_, high = others(inner["max"], value["max"])
        yield value | {"min": low, "max": high}
        yield value | {"min": value["max"], "max": value["min"]}
        yield value | {"min": value["max"]}
    elif is_numbers(value):
        yield [*others(schema["items"], value[0])]
    elif isinstance(value, int | float) and not isinstance(value, bool):
        for name, step in (("minimum", 0), ("exclusiveMinimum", 1e-3)):
            if name in schema:
                yield schema[name] + step
        for name, step in (("maximum", 0), ("exclusiveMaximum", 1e-3)):
            if name in schema:
                yield schema[name] - step


def smallest(schema: dict, value):
    """The smallest grid that a schema allows."""
    return value | {"samples": 2} if isinstance(value, dict) else resolved(schema)["minimum"]


def is_numbers(value) -> bool:
    """Whether a parameter is a list of numbers."""
    return isinstance(value, list) and not isinstance(value[0], str | dict)


def single(entry: dict) -> dict:
    """The first number of each list of numbers; the others are computed like it."""
    return {key: value[:1] for key, value in entry.items() if is_numbers(value)}


def edges_of(schemas: dict, entry: dict) -> Iterator[dict]:
    """Changed parameters of an entry: its lists, its grids, and each other key by itself."""
    lists = {key: entry[key] for key in schemas if isinstance(entry[key], list)}
    yield {key: listed[:1] for key, listed in lists.items()}
    yield {key: listed[::-1] for key, listed in lists.items()}
    sizes = {*COARSE} & schemas.keys()
    ranges = {key for key in schemas if isinstance(entry[key], dict) and "samples" in entry[key]}
    yield {key: smallest(schemas[key], entry[key]) for key in sorted(sizes | ranges)}
    for key in [key for key in schemas if key not in sizes]:
        for value in others(schemas[key], entry[key]):
            yield single(entry) | {key: value}


def computed_entries() -> list[tuple[str, str]]:
    """Section and name of the first entry of each function of the stages."""
    first = {}
    for section in STAGES:
        for name, function in stage(section).STAGE.items():
            first.setdefault(function, (section, name))
    return list(first.values())


def edges() -> Iterator[tuple[str, str, dict]]:
    """Stage, name and the changed parameters of each case."""
    for section, name in computed_entries():
        entry = CONFIGURATION[section][name]
        # A new figure may have any parameters.
        # Nor need a new stage say what it contains.
        known = SCHEMA["properties"][section].get("properties", {}).get(name, {})
        properties = resolved(known).get("properties", {})
        schemas = {key: schema for key, schema in properties.items() if key in entry}
        tried = [entry, entry | single(entry)]
        for changes in edges_of(schemas, entry):
            if entry | changes not in tried:
                tried.append(entry | changes)
                yield section, name, changes


CASES = [
    ("restitution_model", "fig02", {"amplitude": 0.2}),
    ("restitution_model", "fig03", {"amplitude_max": 0.2}),
    ("restitution_model", "three_balls", {"amplitude": [1.2, 1.6]}),
    ("apparent_restitution", "fig05", {"cases": [{"restitution": 0.1, "amplitude": 2.6}]}),
    (
        "apparent_restitution",
        "fig05",
        {
            "cases": [
                {"restitution": 0.65, "amplitude": amplitude} for amplitude in (1.0, 1.0000001)
            ]
        },
    ),
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
    ("permanent_contact", "fig16", {"tolerance": 0.7301}),
    ("apparent_restitution", "fig10", {"restitution": 0.1, "amplitude": [5.0, 6.0]}),
    (
        "continuation",
        "fig08",
        {"restitution": 0.05, "amplitude_max": 100.0, "points": 61, "frequency_ratio": [1e4]},
    ),
    ("continuation", "table1", {"frequency_ratio": [50.0, 30.0]}),
    ("continuation", "table1", {"n": [1], "restitution": 0.65, "frequency_ratio": [10.0]}),
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
    (
        "error_thresholds",
        "thresholds",
        {
            "restitution": 0.3,
            "amplitude": 1.8,
            "frequency_ratio": {"min": 0.1, "max": 0.6, "samples": 9},
        },
    ),
    ("error_thresholds", "fig14", {"n": 5, "amplitude": 3.5}),
    ("validity", "validity_map", {"restitution": {"min": 0.95, "max": 0.05, "samples": 31}}),
    ("validity", "validity_map", {"n": [1], "advised": 5.0}),
    (
        "validity",
        "validity_map",
        {
            "n": [1],
            "restitution": {"min": 0.85, "max": 0.95, "samples": 9},
            "frequency_ratio": {"min": 316.0, "max": 1760.0, "samples": 9},
        },
    ),
    ("validity", "validity_map", {"n": [2], "tolerance": 0.005}),
    ("time_histories", "fig07", {"restitution": 0.1, "amplitude": 2.6, "frequency_ratio": 0.5}),
    ("time_histories", "fig12", {"restitution": 0.999, "n": 5, "amplitude": 0.02}),
    ("time_histories", "fig12", {"frequency_ratio": [0.3, 20.0]}),
    (
        "time_histories",
        "impact_instant",
        {
            "cases": [
                {"restitution": 1.0, "amplitude": 0.0123, "frequency_ratio": 0.5},
                {"restitution": 0.65, "amplitude": 0.3, "frequency_ratio": 20.0},
                {"restitution": 0.05, "amplitude": 3.0, "frequency_ratio": 1e6},
            ],
            "samples": 2,
        },
    ),
    (
        "time_histories",
        "fig12",
        {"restitution": 0.3, "amplitude": 1.8, "frequency_ratio": [0.5, 20.0]},
    ),
]


def changed(section: str, name: str, changes: dict) -> dict:
    """The configuration with coarse grids and with some parameters of an entry changed."""
    config = copy.deepcopy(CONFIGURATION)
    config[section][name] |= changes
    return config


def made(section: str, name: str, config: dict):
    """The dataset of an entry, as the job of its stage saves it."""
    function = stage(section).STAGE[name]
    given = {key: config[key] for key in settings_of(function)}
    about = ("title", "caption", "table")
    given |= {key: value for key, value in config[section][name].items() if key not in about}
    data = computed(function, given)
    saved = {key: reference()[name].attrs[key] for key in ("title", "code")}
    return data.assign_attrs(saved)


EVERY = [*CLAIMS, *table1_ends()]


def words_of(figure) -> str:
    """Titles, names of axes, notes and legends of a figure."""
    texts = [text for legend in figure.legends for text in legend.get_texts()]
    for axes in figure.axes:
        texts += [axes.title, axes.xaxis.label, axes.yaxis.label, *axes.texts]
    return " ".join(text.get_text() for text in texts)


def assert_picture_is_true(name: str, data, of_paper: bool) -> None:
    """Each panel has finite data or a text, and no printed number stands in another's figure.

    An axis with numbers has two at least, and a line of the legend is drawn.
    """
    figure = figures.draw(name, data)
    for axes in figure.axes:
        points = [np.isfinite(np.asarray(line.get_ydata(), float)).any() for line in axes.lines]
        assert any(points) or axes.texts or axes.patches, name
        named = [not line.get_label().startswith("_") for line in axes.lines]
        for line, has_points, has_name in zip(axes.lines, points, named, strict=True):
            assert has_points or not has_name or "(no orbit)" in line.get_label()
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            ticks = axis.get_majorticklocs()
            assert not ticks.size or np.count_nonzero((low <= ticks) & (ticks <= high)) >= 2, name
    words = words_of(figure)
    assert not re.search(r"\bnan\b|\binf\b|\bNone\b", words)
    assert of_paper or not re.search("printed|advised", words)


def assert_numbers_are_true(name: str, data) -> None:
    """Shares are shares, ends of ranges are in their order, and so are thresholds."""
    for share in ("failing_share", "failing_mean", "doubled_share", "doubled_mean"):
        if share in data:
            assert ((data[share] >= 0) & (data[share] <= 1) | data[share].isnull()).all(), share
    if "failing_share" in data:
        # No orbit is counted twice.
        both = data.failing_share + data.doubled_share
        assert ((both <= 1 + 1e-9) | both.isnull()).all()
    for ends in ("computed", "restitution_range", "printed"):
        if ends in data:
            assert not (data[ends].isel(bound=0) > data[ends].isel(bound=1)).any(), ends
    given = json.loads(data.attrs["parameters"])
    if name == "fig16" and given["release"] == "displacement":
        # Eq. 33 on a fine grid.
        reached = data.error_threshold.fillna(data.frequency_ratio[0]).item()
        ratio = np.geomspace(reached, data.frequency_ratio[-1].item(), 20001)
        zeta = independent.restitution_to_damping(given["restitution"])
        error = np.abs(np.sqrt(1 + (4 * zeta**2 - 2) / ratio**2 + 1 / ratio**4) - 1)
        if data.threshold_status.item() != "exceeded":
            assert error.max() <= given["tolerance"] * (1 + 1e-9)
    if name == "thresholds":
        lines = data.error_threshold.sortby("tolerance")
        assert not (lines.diff("tolerance") > 0).any()
        for row in tables.thresholds(data):
            assert not any("no orbit" in cell and tables.NOT_FOLLOWED in cell for cell in row)
    if name == "table1":
        same = {key: given[key] for key in ("restitution", "release")}
        if same != {key: paper.PARAMETERS["table1"][key] for key in same}:
            assert data.printed.isnull().all()
            assert {row[4] + row[6] for row in tables.table1(data)[1:]} == {""}


@cache
def named_in(text: str) -> set[str]:
    """The datasets that a text names."""
    return {name for origin in article.origins_of(text, reference()) for name in origin.datasets}


def assert_texts_are_true(changed: dict) -> None:
    """A claim is judged if its datasets have the paper's parameters, and the article of the paper
    is written, with all its numbers, if all have. The other datasets are those of the reference.
    """
    datasets = {**reference(), **changed}
    others = {
        name
        for name, data in changed.items()
        if other_parameters(name, data, paper.PARAMETERS.get(name, {}))
    }
    unasked = set()
    for claim in EVERY:
        if changed.keys() & claim.datasets.keys():
            judgement = answer(claim, datasets)
            assert judgement["verdict"] in VERDICTS and "nan" not in str(judgement.get("condition"))
            # Algebra on Fig. 11 needs its release only.
            if others & claim.datasets.keys() and claim.datasets != CONTACT_OF_FIG11:
                assert judgement["verdict"] == "not asked"
            if judgement["verdict"] == "not asked":
                unasked.add(judgement["reason"])
    if unasked or paper.changed_parameters(datasets):
        return
    with without_gaps():
        for name in ("paper", "supplement"):
            if changed.keys() & named_in(name):
                assert "another run" not in article.text(name, datasets)


@pytest.mark.parametrize(("section", "name", "changes"), [*edges(), *CASES], ids=str)
def test_a_configuration_at_an_edge_gives_true_results_or_one_line(section, name, changes):
    config = changed(section, name, changes)
    lines = list(mistakes({section: config[section]}, SCHEMA | {"required": []}))
    if lines:
        assert all(line.startswith(f"{section}.{name}.") for line in lines)
        return
    try:
        data = made(section, name, config)
        if name in figures.PLOTS:
            other = other_parameters(name, data, paper.PARAMETERS.get(name, {}))
            assert_picture_is_true(name, data, not other)
    except (NoOrbit, Empty) as error:
        # A message without a remedy is caught.
        assert re.search(r"give|must|need|above", str(error)) and "\n" not in str(error)
        return
    assert_numbers_are_true(name, data)
    assert_texts_are_true({name: data})


def test_the_smallest_of_the_largest_steps_is_still_the_run_of_the_paper():
    data = made("continuation", "fig15", CONFIGURATION | {"largest_step": 0.02})
    assert_picture_is_true("fig15", data, True)
    assert_texts_are_true({"fig15": data})
    assert paper.changed_parameters({**reference(), "fig15": data}) == []


def test_the_branches_of_r_of_1_are_flat_and_bifurcations_beyond_the_axis_are_not_named():
    """Their phase is -π/2 or π/2 at all amplitudes, so it does not order the orbits."""
    config = changed("restitution_model", "fig03", {"restitution": 1, "amplitude_max": 0.4})
    figure = figures.draw("fig03", made("restitution_model", "fig03", config))
    heights = np.concatenate([line.get_ydata() for line in figure.axes[0].lines])
    assert {*heights[np.isfinite(heights)]} == {-0.5, 0.0, 0.5}
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert entries == ["stable", "unstable", "saddle-node"]


def test_a_restitution_that_no_contact_of_the_release_has_is_one_line_or_has_no_number():
    for section, name in computed_entries():
        known = settings_of(stage(section).STAGE[name])
        if "release" in known and "restitution" in CONFIGURATION[section].get(name, {}):
            config = changed(section, name, {"restitution": 0.1}) | {"release": "force"}
            if name in ("table1", "lowest_doubling"):
                data = made(section, name, config)
                of_contact = data.get("computed", data.get("period_doubling_amplitude"))
                assert of_contact.isnull().all()
            elif name != "validity_map":
                with pytest.raises(NoOrbit, match=r"r must be above e⁻² = 0\.1353"):
                    made(section, name, config)


def test_another_release_gives_true_pages():
    """A number that is missing on the page, or a claim that raises, is caught."""
    forced = {}
    for section, name in computed_entries():
        known = settings_of(stage(section).STAGE[name])
        if name in reference() and "release" in known:
            config = changed(section, name, single(CONFIGURATION[section][name]))
            forced[name] = made(section, name, config | {"release": "force"})
            if name in figures.PLOTS:
                assert_picture_is_true(name, forced[name], False)
            assert_numbers_are_true(name, forced[name])
    assert len(forced) > 10
    assert_texts_are_true(forced)
    datasets = reference() | forced
    datasets["claims"] = judge(datasets).assign_attrs(reference()["claims"].attrs)
    page = re.sub(r"(?s)<style>.*?</style>", "", index.list_of_figures("html", datasets, ENTRIES))
    assert not re.search(r"\bnan\b|\binf\b|\bNone\b|\w+Error\b", page)
    assert article.text("paper", datasets).startswith("# Article of another run")
