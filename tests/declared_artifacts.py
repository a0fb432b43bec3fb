"""The artifacts that the rules list, read without a run of Snakemake."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import xarray as xr
from adapter import function

from bouncing_ball.datasets.variables import budgeted
from bouncing_ball.paper.exhibits.budgets import BUDGETS
from bouncing_ball.pipeline.artifacts import Artifact
from bouncing_ball.pipeline.diff.datasets import compare_datasets
from bouncing_ball.pipeline.diff.outcome import Row

RULES = Path(__file__).resolve().parents[1] / "workflow" / "rules"


def calls_of_stage(text: str) -> Iterator[str]:
    """Each call ``stage(…)`` in the text of rules."""
    for call in re.finditer(r"\bstage\(", text):
        for end in re.finditer(r"\)", text[call.start() :]):
            found = text[call.start() : call.start() + end.end()]
            try:
                ast.parse(found)
            except SyntaxError:
                continue
            yield found
            break


def declared(rules: Path, section: str) -> dict[str, Artifact]:
    """All artifacts by name that the rules of a house list."""
    artifacts = {}

    def stage(module, figures=None, **given):
        for name, each in given.items():
            shown = figures or f"{module}_figures"
            artifacts[name] = Artifact(
                name=name, section=section, module=module, figures=shown, **each
            )

    for call in calls_of_stage(rules.read_text(encoding="utf-8")):
        eval(call, {"stage": stage})
    return artifacts


ARTIFACTS = declared(RULES / "paper.smk", "paper")
STUDIES = {
    each.name: function(each.module, each.study) for each in ARTIFACTS.values() if each.study
}
"""The study of each artifact that has one."""


def compare_artifact(name: str, record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """The comparison of two datasets of an artifact with its budgets, which a run declares."""
    own = BUDGETS.get(name, {})
    return compare_datasets(budgeted(record.copy(), own), budgeted(new.copy(), own))
