"""What the scripts of a house's workflow make, read without a run of Snakemake."""

import ast
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball_beyond.exhibits.budgets import BUDGETS
from bouncing_ball_beyond.inherited.datasets.variables import budgeted
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import compare_datasets
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Row
from bouncing_ball_beyond.inherited.pipeline.provenance import read_provenance

SCRIPTS = Path(__file__).resolve().parents[1] / "workflow" / "scripts"


def called(script: Path, name: str) -> ast.Call | None:
    """The call of a function in a script, if there is one."""
    calls = [x for x in ast.walk(ast.parse(script.read_text("utf-8"))) if isinstance(x, ast.Call)]
    return next((x for x in calls if isinstance(x.func, ast.Name) and x.func.id == name), None)


def imported(script: Path) -> dict[str, Callable[..., Any]]:
    """The functions that a script imports from packages of the houses, by their names."""
    nodes = ast.walk(ast.parse(script.read_text("utf-8")))
    return {
        alias.name: getattr(import_module(node.module), alias.name)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("bouncing_ball")
        for alias in node.names
    }


def shown(name: str, scripts: Path = SCRIPTS) -> dict[str, Callable[..., Any]]:
    """The functions with which scripts call ``make_dataset``, ``draw`` or ``write_table``, by the
    names of their artifacts.
    """
    return {
        script.stem.partition("_")[2]: imported(script)[call.args[1].id]
        for script in sorted(scripts.glob("*.py"))
        if (call := called(script, name))
    }


def given_to(artifact: str, run: dict[str, Any], section: str = "beyond") -> dict[str, Any]:
    """What the job of an artifact is given: its parameters, and the settings of a configuration."""
    return {**run, "parameters": run[section].get(artifact)}


STUDIES = shown("make_dataset")
DRAWINGS = shown("draw")
TABLES = shown("write_table")


def read_by(artifact: str) -> list[str]:
    """The names of the datasets from which an accepted dataset was made."""
    made = read_provenance(SCRIPTS.parents[1] / "figures" / f"{artifact}.nc")
    return [Path(path).stem for path in made["inputs"] if path.endswith(".nc")]


def compare_artifact(name: str, record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """The comparison of two datasets of an artifact with its budgets, which a run declares."""
    own = BUDGETS.get(name, {})
    return compare_datasets(budgeted(record.copy(), own), budgeted(new.copy(), own))
