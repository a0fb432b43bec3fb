"""Rounding moves no letter of the tables and of the article.

The accepted datasets are perturbed as another processor perturbs them, and
everything that is read from them is made again: evidence, verdicts, tables, text.
"""

import csv
from collections import defaultdict
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.audit.claims.assessment import assess
from bouncing_ball.audit.claims.ledger import parse_ledger
from bouncing_ball.audit.claims.ledger_file import read_ledger
from bouncing_ball.audit.evidence import evidence
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.datasets.rounding import ROUNDING_SIZE
from bouncing_ball.render.article.render import render_article
from bouncing_ball.render.tables.formats import to_csv, to_latex, to_markdown

ROOT = Path(__file__).resolve().parents[2]
TEMPLATES = ROOT / "workflow" / "report" / "paper"
TABLES = ("table1", "thresholds", "witness", "forensics", "formulas", "claims")
DERIVED = ("evidence", "claims")


def largest_changes():
    """What other rounding does to each variable, from the convergence study."""
    with (ROOT / "config" / "convergence.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["rounding"]]
    changes = defaultdict(dict)
    for row in rows:
        changes[row["artifact"]][row["variable"]] = float(row["rounding"])
    return changes


@pytest.fixture(scope="module")
def record():
    paths = sorted((ROOT / "figures").glob("*.nc"))
    return {path.stem: read_dataset(path) for path in paths if path.stem not in DERIVED}


def perturbed(data, changes, rng):
    """A dataset whose numbers are off by what rounding does to them.

    The study measures changes against the largest magnitude. A disagreement
    between two routes is rounding itself and may be anything within its budget.
    """
    other = data.copy(deep=True)
    for name, values in other.data_vars.items():
        if values.dtype.kind != "f" or name == "budget":
            continue
        finite = np.isfinite(values.values)
        size = np.abs(values.values[finite]).max(initial=0.0)
        noise = rng.uniform(-1, 1, values.shape) * max(changes.get(name, 0.0), 1e-15) * size
        if name == "disagreement":
            budget = other.budget.broadcast_like(values).transpose(*values.dims).values
            rounding = (values.values <= budget) & (("worst" in other) | (budget <= ROUNDING_SIZE))
            noise = np.where(rounding, rng.uniform(0, 1, values.shape) * budget - values.values, 0)
        other[name].values[finite] += noise[finite]
    return other


def texts(data):
    """All tables in all formats, and the article."""
    parameters = read_yaml(ROOT / "config" / "config.yaml")["studies"]["evidence"]
    found = evidence(data, parameters).assign_attrs(parameters)
    data = {**data, "evidence": found}
    data["claims"] = assess(parse_ledger(read_ledger(ROOT / "config")), data)
    made = {}
    for name in TABLES:
        rows = import_module(f"bouncing_ball.render.tables.{name}").rows(data[name])
        for form in (to_csv, to_latex, to_markdown):
            made[name, form.__name__] = form(*rows)
    references = read_yaml(TEMPLATES / "references.yaml")
    tables = {name: made[name, "to_markdown"] for name in TABLES}
    made["article"] = render_article(TEMPLATES, data, tables, references)
    return made


@pytest.fixture(scope="module")
def accepted(record):
    return texts(record)


@pytest.mark.parametrize("seed", range(3))
def test_rounding_changes_no_text(record, accepted, seed):
    changes, rng = largest_changes(), np.random.default_rng(seed)
    noisy = {name: perturbed(data, changes[name], rng) for name, data in record.items()}
    moved = [
        f"{name}: {old} → {new}"
        for name, text in texts(noisy).items()
        for old, new in zip(accepted[name].splitlines(), text.splitlines(), strict=True)
        if old != new
    ]
    assert not moved


def test_what_matters_changes_the_texts(record, accepted):
    # One last printed digit of one entry, and one formula that is wrong.
    other = {name: data.copy(deep=True) for name, data in record.items()}
    other["table1"]["computed"].values[0, 0, 0] += 1e-5
    other["formulas"]["disagreement"].values[0] = 1e-3
    made = texts(other)
    assert all(made[name] != accepted[name] for name in made if "table1" in name)
    assert all(made[name] != accepted[name] for name in made if "formulas" in name)
    assert made["article"] != accepted["article"]
