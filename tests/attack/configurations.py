"""Configurations, plausible and extreme by turns: each runs to its end, or is refused before.

Drawn from the schema itself, so that a key added there is attacked too. A
*plausible* configuration is the paper's with each number moved by some factor,
an *extreme* one has every number anywhere in its range, its ends included. One
stage is run at a time, on its own section; after it all that reads its dataset:
cross-check, evidence, claims, figure, tables, article and tally.
"""

import itertools
import math
import time
import warnings
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.audit.cross_check import cross_check
from bouncing_ball.audit.evidence import evidence
from bouncing_ball.claims.assessment import assess
from bouncing_ball.claims.ledger_file import read_ledger
from bouncing_ball.claims.tally import tally
from bouncing_ball.configuration.check import check_configuration, check_orbits
from bouncing_ball.configuration.conformity import resolved
from bouncing_ball.configuration.schema import configuration_schema
from bouncing_ball.configuration.stages import STAGES, Kind, studied, tables
from bouncing_ball.configuration.study import load
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.datasets.emptiness import statement
from bouncing_ball.datasets.netcdf import parameter_attributes, read_dataset
from bouncing_ball.figures.article.render import render_article
from bouncing_ball.figures.atlas.tables import shares
from bouncing_ball.figures.given import from_dataset
from bouncing_ball.figures.tables.error_law import law_table
from bouncing_ball.figures.tables.formats import to_csv, to_latex, to_markdown
from bouncing_ball.orbits import restitution_orbit

ROOT = Path(__file__).resolve().parents[2]
SECTIONS = ("figures", "tables", "extensions", "studies")
# Sizes are a matter of memory and time, and those have bounds of their own.
_SIZES = {"samples": 41, "points": 61, "periods": 3}
# Longest time of a processor for one stage and all that reads it.
_PATIENCE = 60.0


class Case(NamedTuple):
    """A configuration, and the stage whose section of it was drawn."""

    stage: str
    kind: str
    config: dict[str, Any]


@cache
def _project() -> tuple[dict[str, Any], dict[str, Any], Any]:
    """Configuration, kinds of parameters and ledger of claims."""
    folder = ROOT / "config"
    return (
        read_yaml(folder / "config.yaml"),
        read_yaml(folder / "schema.yaml"),
        read_ledger(folder),
    )


@cache
def _schema() -> dict[str, Any]:
    return configuration_schema(_project()[1])


def _extreme(schema: Mapping[str, Any], rng: np.random.Generator) -> float:
    """A number anywhere in its range, by magnitude, or an end of it."""
    low = max(schema.get("minimum", 0), schema.get("exclusiveMinimum", 0))
    high = min(schema.get("maximum", math.inf), schema.get("exclusiveMaximum", math.inf))
    small = low if low > 0 else 10.0 ** rng.uniform(-12, -1)
    large = high if high < math.inf else 10.0 ** rng.uniform(1, 12)
    ends = [x for x in (low, high) if 0 < x < math.inf]
    if ends and rng.random() < 0.3:
        return float(rng.choice(ends))
    value = float(np.exp(rng.uniform(math.log(small), math.log(large))))
    if high <= 1 and rng.random() < 0.5:
        value = high - value  # close to the upper end as well
    return value


def _number(schema, value, rng, kind, name):
    if name in _SIZES:
        return int(rng.integers(schema.get("minimum", 1), _SIZES[name] + 1))
    whole = schema["type"] == "integer"
    if kind == "plausible" and (name == "restitution" or "exclusiveMaximum" in schema):
        # A share, moved by its odds, so that it stays one.
        odds = value / max(1 - value, 1e-3) * math.exp(rng.normal(0, 0.8))
        value = odds / (1 + odds)
    elif kind == "plausible":
        value = value * math.exp(rng.normal(0, 0.5))
    else:
        value = _extreme(schema, rng)
    low, high = schema.get("minimum", -math.inf), schema.get("maximum", math.inf)
    low = max(low, np.nextafter(schema.get("exclusiveMinimum", -math.inf), math.inf))
    high = min(high, np.nextafter(schema.get("exclusiveMaximum", math.inf), -math.inf))
    value = min(max(value, low), high)
    return round(value) if whole else float(value)


def _drawn(schema, value, root, rng, kind, name=""):
    """A value that the schema allows, in place of that of the configuration."""
    schema = resolved(schema, root)
    if "enum" in schema:
        return str(rng.choice(schema["enum"]))
    match schema["type"]:
        case "object":
            return {
                key: _drawn(schema["properties"][key], part, root, rng, kind, key)
                for key, part in value.items()
            }
        case "array":
            size = int(rng.integers(schema.get("minItems", 1) or 1, 4))
            size = min(size, schema.get("maxItems", size))
            parts = [
                _drawn(schema["items"], value[k % len(value)], root, rng, kind, name)
                for k in range(size)
            ]
            if not schema.get("uniqueItems"):
                return parts
            return [part for k, part in enumerate(parts) if part not in parts[:k]]
        case "number" | "integer":
            return _number(schema, value, rng, kind, name)
    return value


def _made_to_exist(part: dict[str, Any], stage: str, rng: np.random.Generator) -> None:
    """Ranges in order, and amplitudes at which there is an orbit."""
    for value in part.values():
        if isinstance(value, dict) and {"min", "max"} <= set(value):
            value["min"], value["max"] = sorted((value["min"], value["max"]))
    if "n" not in part:
        return
    n = max(part["n"]) if isinstance(part["n"], list) else part["n"]

    def enough(lam, r):
        lowest = float(restitution_orbit.saddle_node(n, r))
        if stage == "table1":
            lowest = 1.1 * float(restitution_orbit.period_doubling(n, r))
        return max(lam, lowest * (1 + 10.0 ** rng.uniform(-10, 1)))

    for case in part.get("cases", [part]):
        for key in ("amplitude", "amplitude_max"):
            if isinstance(case.get(key), list):
                case[key] = [enough(lam, case["restitution"]) for lam in case[key]]
            elif key in case:
                case[key] = enough(case[key], case["restitution"])


def drawn(rng: np.random.Generator, kind: str) -> Case:
    """The project's configuration with the section of one stage drawn anew."""
    config, schema = _project()[0], _schema()
    pairs = [(section, name) for section in SECTIONS for name in config[section]]
    pairs = [pair for pair in pairs if pair[1] != "evidence"]
    section, name = pairs[rng.integers(len(pairs))]
    rules = schema["properties"][section]["properties"][name]
    part = _drawn(rules, config[section][name], schema, rng, kind)
    _made_to_exist(part, name, rng)
    if "thresholds" in part:
        _made_to_exist(part["thresholds"], name, rng)
    result = {**config, section: {**config[section], name: part}}
    result["release"] = str(rng.choice(["displacement", "force"]))
    if rng.random() < 0.25:
        steps = _drawn(
            schema["properties"]["continuation"], config["continuation"], schema, rng, kind
        )
        sizes = sorted(steps[key] for key in ("smallest_step", "initial_step"))
        steps["smallest_step"], steps["initial_step"] = sizes
        result["continuation"] = steps
    return Case(name, kind, result)


def _dataset(name: str, config: Mapping[str, Any]) -> xr.Dataset:
    """The dataset of a stage, with its parameters as a run writes them."""
    ledger = _project()[2]
    stage, run = STAGES[name], {**config, "printed": ledger.table("Table 1")}
    settings = stage.settings(run)
    data = load(stage.study)(stage.parameters(run), *settings.values())
    parameters = parameter_attributes({**stage.parameters(run), **settings})
    return data.assign_attrs({**(data.attrs or parameters), **statement(data)})


def _evidence(data: Mapping[str, xr.Dataset], config: Mapping[str, Any]) -> xr.Dataset:
    own = config["studies"]["evidence"]
    return evidence(data, own).assign_attrs(parameter_attributes(own))


@cache
def _others() -> dict[str, xr.Dataset]:
    """The datasets of all stages with the project's parameters: accepted, or new and computed."""
    config = _project()[0]
    data = {path.stem: read_dataset(path) for path in (ROOT / "figures").glob("*.nc")}
    alone = [stage.name for stage in studied() if not stage.reads and stage.section != "ledger"]
    data |= {name: _dataset(name, config) for name in alone if name not in data}
    return data | {"evidence": _evidence(data, config)}


def run(case: Case) -> None:
    """The stage of a case and all that reads its dataset.

    Raises
    ------
    ConfigurationError
        If the configuration is refused, before anything runs.
    """
    config, (_, kinds, ledger) = case.config, _project()
    check_configuration(config, kinds)
    check_orbits(config)
    try:
        data = _dataset(case.stage, config)
        others = {**_others(), case.stage: data}
        if case.stage in STAGES["witness"].reads:
            row = cross_check({case.stage: data}, config["continuation"])
            rest = others["witness"].drop_sel(artifact=case.stage, errors="ignore")
            others["witness"] = xr.concat([rest, row], "artifact", data_vars="minimal")
        others["evidence"] = _evidence(others, config)
        others["claims"] = assess(ledger, others)
        if STAGES[case.stage].kind in (Kind.FIGURE, Kind.EXTENSION):
            _draw(case.stage, data)
        _write(others, {case.stage, "witness", "claims"})
    except ConfigurationError as error:
        raise RuntimeError(f"refused late: {error}") from error


def _draw(name: str, data: xr.Dataset) -> None:
    from bouncing_ball.figures.style import style

    with style():
        draw = import_module(f"bouncing_ball.figures.{name}").draw
        figure = from_dataset(draw, data, name)
        figure.set_dpi(20)
        figure.canvas.draw()


def _write(data: Mapping[str, xr.Dataset], changed: set[str]) -> None:
    """The tables that have changed, the article and the tally."""
    written = {name: (ROOT / "figures" / f"{name}.md").read_text("utf-8") for name in tables()}
    for name in changed & written.keys():
        rows = import_module(f"bouncing_ball.figures.tables.{name}").rows
        header, body = from_dataset(rows, data[name], name)
        to_csv(header, body), to_latex(header, body)
        written[name] = to_markdown(header, body)
    written["error_law"] = law_table((ROOT / "config" / "error_law.csv").read_text("utf-8"))
    atlas = read_dataset(ROOT / "config" / "atlas.nc")
    written["atlas"] = to_markdown(*shares(atlas))
    folder = ROOT / "workflow" / "report" / "paper"
    references = read_yaml(folder / "references.yaml")
    render_article(folder, {**data, "atlas": atlas}, written, references)
    tally(data["claims"], len(STAGES))


def case(seed: int, number: int) -> Case:
    """A case by its own seed: plausible and extreme configurations by turns."""
    kind = ("plausible", "extreme")[number % 2]
    return drawn(np.random.default_rng([seed, number]), kind)


def _outcome(case: Case) -> str:
    """Empty if the case holds, else what went wrong."""
    start = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run(case)
    except ConfigurationError as error:
        if "\n" in str(error):
            return f"refused in more than one line: {error}"
    except Exception as error:  # whatever it is, it came too late
        return f"{type(error).__name__}: {' '.join(str(error).split())}"
    took = time.process_time() - start
    return f"took {took:.0f} s" if took > _PATIENCE else ""


def attack(seed: int) -> Iterator[list[str]]:
    """Configurations, one after the other."""
    _others()
    for number in itertools.count():
        one = case(seed, number)
        wrong = _outcome(one)
        yield [f"case [{seed}, {number}], {one.kind} {one.stage}: {wrong}" if wrong else ""]
