"""Budgets of the datasets: what should not matter moves no number beyond its budget.

Every study is run again three ways: with Newton's tolerance a tenth and the steps and angles
of the continuation half as large; with twice as many intervals, the old samples among the new
ones; and with r and Λ moved by a few units in the last place, which changes every rounding
after them, as another processor or another library does. A budget is the power of ten next
above ten times the largest change.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.configuration.study import arguments, load, typed
from bouncing_ball.configuration.yaml_file import read_yaml

ROOT = Path(__file__).resolve().parents[2]
RUN = read_yaml(ROOT / "config" / "config.yaml")
# Sizes that become 2N - 1, and parameters that are moved; the others are labels or sought.
SIZES, MOVED = ("samples", "points"), ("restitution", "amplitude", "amplitude_max")
# More random orbits are other orbits, and a curve of these is not sampled as its half is.
NOT_NESTED = ("ext_orders", "explorer", "formulas")


def mapped(value, change, key=""):
    """Nested parameters, each number or text passed through ``change(key, value)``."""
    if isinstance(value, dict):
        return {name: mapped(part, change, name) for name, part in value.items()}
    if isinstance(value, list):
        return [mapped(part, change, key) for part in value]
    return change(key, value)


def tighter(given):
    if "continuation" not in given:
        return given
    settings = given["continuation"]
    half = {key: settings[key] / 2 for key in ("initial_step", "largest_step", "max_angle")}
    tight = {**settings, **half, "newton_tolerance": settings["newton_tolerance"] / 10}
    return given | {"continuation": tight}


def finer(given):
    return mapped(given, lambda key, value: 2 * value - 1 if key in SIZES else value)


def rounded(ulps):
    def change(key, value):
        # The undamped contact, r = 1, is another case than its neighbours and stays.
        if key not in MOVED or value == 1:
            return value
        for _ in range(abs(ulps)):
            value = float(np.nextafter(value, np.inf if ulps > 0 else -np.inf))
        return value

    return lambda given: mapped(given, change)


def on_the_old_grid(fine, coarse):
    """Every other sample of each dimension with 2N - 1 in place of N."""
    refined = [name for name, size in coarse.sizes.items() if fine.sizes[name] == 2 * size - 1 > 1]
    thinned = fine.isel({name: slice(None, None, 2) for name in refined})
    counted = [name for name in refined if fine[name].dtype.kind == "i"]
    return thinned.assign_coords({name: coarse[name] for name in counted})


@cache
def base(study, artifact):
    return typed(load(study))(**arguments(study, artifact, RUN))


VARIATIONS = {"tolerances": tighter, "grid": finer} | {
    f"{ulps} units in the last place": rounded(ulps) for ulps in (-2, -1, 1, 2)
}


@pytest.mark.long
@pytest.mark.parametrize("variation", VARIATIONS)
def test_what_should_not_matter_stays_within_the_budgets(stages, variation):
    beyond, compared = [], 0
    for artifact, study in stages.items():
        # Without parameters of its own a dataset is made of the others.
        if not any(artifact in RUN[part] for part in ("figures", "tables", "extensions")):
            continue
        given = arguments(study, artifact, RUN)
        varied = VARIATIONS[variation](given)
        if varied == given or (variation == "grid" and artifact in NOT_NESTED):
            continue
        record = base(study, artifact)
        again = on_the_old_grid(typed(load(study))(**varied), record).assign_attrs(record.attrs)
        found = compare_datasets(artifact, record, again)
        compared += len(found)
        beyond += [f"{artifact}: {each}" for each in found if not each.outcome.agrees]
    assert compared > 50 and not beyond
