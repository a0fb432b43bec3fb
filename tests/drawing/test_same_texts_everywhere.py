"""Rounding moves no letter of the tables and of the articles.

The accepted datasets are perturbed as another processor perturbs them, and
everything that is read from them is made again: evidence, verdicts, tables, text.
"""

import numpy as np

from bouncing_ball.datasets.rounding import ROUNDING_SIZE
from bouncing_ball.pipeline.diff.budgets import ROUNDING


def perturbed(data, rng):
    """A dataset whose numbers are off by what rounding does to them.

    That is less than the least budget. A disagreement between two routes is rounding
    itself and may be anything within its budget.
    """
    other = data.copy(deep=True)
    for name, values in other.data_vars.items():
        if values.dtype.kind != "f" or name == "budget":
            continue
        finite = np.isfinite(values.values)
        size = np.abs(values.values[finite]).max(initial=0.0)
        noise = rng.uniform(-1, 1, values.shape) * ROUNDING * size
        if name == "disagreement":
            budget = other.budget.broadcast_like(values).transpose(*values.dims).values
            rounding = (values.values <= budget) & (("worst" in other) | (budget <= ROUNDING_SIZE))
            noise = np.where(rounding, rng.uniform(0, 1, values.shape) * budget - values.values, 0)
        other[name].values[finite] += noise[finite]
    return other


def moved(make, record, made):
    """The lines that differ if the datasets are perturbed."""
    rng = np.random.default_rng(0)
    noisy = {name: perturbed(data, rng) for name, data in record.items()}
    return [
        f"{name}: {old} → {new}"
        for name, text in make(noisy).items()
        for old, new in zip(made[name].splitlines(), text.splitlines(), strict=True)
        if old != new
    ]


def test_rounding_changes_no_text(record, texts, accepted):
    assert moved(texts, record, accepted) == []


def test_rounding_changes_no_text_beyond_the_paper(beyond_record, beyond_texts, beyond_accepted):
    assert moved(beyond_texts, beyond_record, beyond_accepted) == []
