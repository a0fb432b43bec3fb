"""What the scripts of a house's workflow make, read without a run of Snakemake."""

import ast
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.datasets.variables import budgeted
from bouncing_ball.paper.exhibits.budgets import BUDGETS
from bouncing_ball.pipeline.diff.datasets import compare_datasets
from bouncing_ball.pipeline.diff.outcome import Row
from bouncing_ball.pipeline.provenance import read_provenance

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


def studies(scripts: Path = SCRIPTS) -> dict[str, Callable[..., xr.Dataset]]:
    """The study of each dataset."""
    return {
        keyword.arg: imported(script)[keyword.value.id]
        for script in sorted(scripts.glob("*.py"))
        if (call := called(script, "make_datasets"))
        for keyword in call.keywords
    }


def shown(name: str, scripts: Path = SCRIPTS) -> dict[str, Callable[..., Any]]:
    """The function with which each script calls ``draw`` or ``write_table``, by the artifact."""
    return {
        script.stem.partition("_")[2]: imported(script)[call.args[1].id]
        for script in sorted(scripts.glob("*.py"))
        if (call := called(script, name))
    }


def by_key(run: dict[str, Any], section: str = "paper") -> dict[str, Any]:
    """The parameters of each artifact and the settings of a configuration, as a job has them."""
    return {**run, **run[section]}


STUDIES = studies()
DRAWINGS = shown("draw")
TABLES = shown("write_table")


def made_by(artifact: str, scripts: Path = SCRIPTS) -> str:
    """The name of the script that makes the dataset of an artifact."""
    calls = {script.stem: called(script, "make_datasets") for script in scripts.glob("*.py")}
    return next(
        name for name, call in calls.items() if call and artifact in {x.arg for x in call.keywords}
    )


def read_by(artifact: str) -> list[str]:
    """The names of the datasets from which an accepted dataset was made."""
    made = read_provenance(SCRIPTS.parents[1] / "figures" / f"{artifact}.nc")
    return [Path(path).stem for path in made["inputs"] if path.endswith(".nc")]


def compare_artifact(name: str, record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """The comparison of two datasets of an artifact with its budgets, which a run declares."""
    own = BUDGETS.get(name, {})
    return compare_datasets(budgeted(record.copy(), own), budgeted(new.copy(), own))
