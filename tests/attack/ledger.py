"""Ledgers and datasets with wrong, missing and hostile entries, for claims, figures and tables.

A mutated ledger is read and judges the accepted datasets, or is refused in one
line; a mutated dataset is drawn, set or judged, or is refused in one line.
"""

import copy
import itertools
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.claims.assessment import assess
from bouncing_ball.claims.ledger_file import parse_ledger, read_ledger
from bouncing_ball.configuration.conformity import check_schema
from bouncing_ball.configuration.stages import STAGES, Kind, names
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.given import from_dataset
from bouncing_ball.figures.style import style
from bouncing_ball.figures.tables.formats import to_csv, to_latex, to_markdown

ROOT = Path(__file__).resolve().parents[2]
# One case within this; a field of a hundred thousand million blanks takes the memory.
SOON = 20.0
HOSTILE: tuple[Any, ...] = (
    *(None, True, "", " ", "\x1b[31mred", "a\nb", "é" * 2000, 0, -1, 10**40, 1e308),
    *(float("nan"), float("inf"), [], [[]], {}, {"variable": "zzz"}, ["0.5"], "1e999999999"),
    *("{n:99999999999}", "{n.__class__}", "{0}", "{n!r:>9999999999}", "{bound:d}", "{", "}", "%n"),
)


def places(node: Any, path: tuple = ()) -> list[tuple]:
    """Paths to all entries below a node."""
    items = (
        node.items() if isinstance(node, dict) else enumerate(node) if type(node) is list else ()
    )
    return [place for key, part in items for place in [(*path, key), *places(part, (*path, key))]]


def mutated(mapping: dict, rng: np.random.Generator) -> tuple[dict, str]:
    """A ledger with one to three entries replaced, removed, copied or renamed."""
    other, done = copy.deepcopy(mapping), []
    for _ in range(int(rng.integers(1, 4))):
        paths = places(other)
        path = paths[int(rng.integers(len(paths)))]
        node = other
        for key in path[:-1]:
            node = node[key]
        key, how = path[-1], str(rng.choice(["replace", "replace", "remove", "copy", "move"]))
        if how == "replace":
            node[key] = copy.deepcopy(HOSTILE[int(rng.integers(len(HOSTILE)))])
        elif how == "remove":
            del node[key]
        elif how == "copy" and isinstance(node, list):
            node.append(copy.deepcopy(node[key]))
        else:
            source: Any = other
            for step in paths[int(rng.integers(len(paths)))]:
                source = source[step]
            node[key] = copy.deepcopy(source)
        done.append(f"{how} {'.'.join(map(str, path))}")
    return other, ", ".join(done)


def damaged(data: xr.Dataset, rng: np.random.Generator) -> tuple[xr.Dataset, str]:
    """A dataset with one variable, coordinate, attribute or dimension that is wrong."""
    name = str(rng.choice(list(map(str, data.variables))))
    how = str(
        rng.choice(["drop", "empty", "infinite", "huge", "text", "number", "cut", "attribute"])
    )
    values = data[name]
    if how == "drop":
        return data.drop_vars(name), f"without {name}"
    if how == "cut" and data.sizes:
        dim = str(rng.choice(list(map(str, data.sizes))))
        size = int(rng.integers(0, min(3, data.sizes[dim]) + 1))
        return data.isel({dim: slice(0, size)}), f"{size} of {dim}"
    if how == "attribute" and data.attrs:
        key = str(rng.choice(list(data.attrs)))
        wrong = [None, "zzz", float("nan"), np.array([]), -1][int(rng.integers(5))]
        attributes = {k: v for k, v in data.attrs.items() if k != key}
        if wrong is not None:
            attributes[key] = wrong
        return data.copy().assign_attrs({}).pipe(_with_attributes, attributes), f"{key}: {wrong}"
    filled = {"empty": np.nan, "infinite": np.inf, "huge": 1e308, "text": "zzz", "number": 0.0}
    content = np.full(values.shape, filled.get(how, 0.0))
    if values.dtype.kind == "f" and rng.random() < 0.3 and how != "text":
        content = np.where(rng.random(values.shape) < 0.5, content, values.values)
    return data.assign({name: (values.dims, content)}), f"{name} {how}"


def _with_attributes(data: xr.Dataset, attributes: dict) -> xr.Dataset:
    data.attrs = attributes
    return data


def rendered(name: str, data: xr.Dataset) -> None:
    """The figure or the table, as its job makes it."""
    path = f"results/figures/{name}.nc"
    if STAGES[name].kind is Kind.TABLE:
        rows = import_module(f"bouncing_ball.figures.tables.{name}").rows
        for form in (to_csv, to_markdown, to_latex):
            form(*from_dataset(rows, data, path))
        return
    with style():
        draw = import_module(f"bouncing_ball.figures.{name}").draw
        from_dataset(draw, data, path)


def fault(case: Callable[[], object]) -> str:
    """What is wrong with how a case ended; nothing if it is right."""
    start = time.monotonic()
    said = ""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"), redirect_stderr(StringIO()):
            warnings.simplefilter("ignore")
            case()
    except ModelError as error:
        text = str(error)
        if not text or not text.isprintable() or len(text) > 2000:
            said = f"refused in {len(text)} characters, {text[:80]!a}"
    except Exception as error:
        said = f"{type(error).__name__}: {str(error)[:120]!a}"
    took = time.monotonic() - start
    return said or (f"{took:.0f} s" if took > SOON else "")


def judged(mapping: dict, schema: dict, data: dict[str, xr.Dataset]) -> None:
    check_schema(mapping, schema)
    assess(parse_ledger(mapping), data)


def attack(seed: int) -> Iterator[list[str]]:
    """Mutated ledgers and damaged datasets in turn."""
    rng = np.random.default_rng(seed)
    mapping = read_yaml(ROOT / "config" / "claims.yaml")
    schema = read_yaml(ROOT / "config" / "claims.schema.yaml")
    ledger = read_ledger(ROOT / "config")
    data = {path.stem: read_dataset(path) for path in (ROOT / "figures").glob("*.nc")}
    drawn = [
        name
        for name in names(Kind.FIGURE, Kind.EXTENSION, Kind.TABLE)
        if STAGES[name].study and name in data
    ]
    for number in itertools.count(1):
        if number % 3 == 1:
            other, what = mutated(mapping, rng)
            said = fault(lambda other=other: judged(other, schema, data))
        elif number % 3 == 2:
            name = str(rng.choice(drawn))
            other, what = damaged(data[name], rng)
            what = f"{name}: {what}"
            said = fault(lambda name=name, other=other: rendered(name, other))
        else:
            name = str(rng.choice(ledger.datasets))
            other, what = damaged(data[name], rng)
            what = f"claims by {name}: {what}"
            said = fault(lambda name=name, other=other: assess(ledger, data | {name: other}))
        yield [f"seed {seed}, case {number}: {what!a}: {said}" if said else ""]
