"""Budgets of the datasets: what should not matter moves no number beyond its budget.

Every study is run again three ways: with Newton's tolerance a tenth and the steps and angles
of the continuation half as large; with twice as many intervals, the old samples among the new
ones; and with r and Λ moved by a few units in the last place, which changes every rounding
after them, as another processor or another library does. A budget is the power of ten next
above ten times the largest change.
"""

import inspect
from pathlib import Path

import numpy as np
import pytest
from declared_artifacts import BUDGETS, STUDIES, compare_artifact, given_to

from bouncing_ball_beyond.inherited.datasets.variables import IGNORED
from bouncing_ball_beyond.inherited.pipeline.job import arguments, typed
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[2]
RUN = read_yaml(ROOT / "config" / "config.yaml")
# Sizes that become 2N - 1, and parameters that are moved; the others are labels or sought.
SIZES = ("samples", "points")
MOVED = ("restitution", "amplitude", "amplitude_max")
# More random orbits are another sample; motions are sampled at their events and a sweep at round ϖ,
# too.
NOT_NESTED = ("ext_orders", "explorer", "formulas", "fig07", "fig12", "fig13", "ext_instant")


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
    return given | {"continuation": settings | {"largest_step": settings["largest_step"] / 2}}


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


VARIATIONS = [tighter, finer, *map(rounded, (-2, -1, 1, 2))]
# Budgets with another source, which stands beside them, or of what no study here moves.
OTHER_SOURCES = {
    *("residual", "special_residual", "disagreement", "order", "law_remainder"),
}


@pytest.fixture(scope="module")
def results(coarse):
    """For each artifact and variable, the results under all variations."""
    found = {}
    for artifact, study in STUDIES.items():
        made = typed(study)
        # What is made of other datasets moves as they do.
        if "data" in inspect.signature(study).parameters:
            continue
        fewer = {key: number for (name, key), number in coarse.items() if name == artifact}
        given = mapped(
            arguments(study, given_to(artifact, RUN)),
            lambda key, x, fewer=fewer: fewer.get(key, x),
        )
        record = made(**given)
        for vary in VARIATIONS:
            varied = vary(given)
            if varied == given or (vary is finer and artifact in NOT_NESTED):
                continue
            again = on_the_old_grid(made(**varied), record).assign_attrs(record.attrs)
            for each in compare_artifact(artifact, record, again):
                found.setdefault((artifact, each.name), []).append(each)
    return found


@pytest.mark.long
def test_budgets_are_kept_and_no_wider_than_what_was_measured_asks_for(results, declared):
    budgets = {name: one.budget for name, one in declared.items() if one.budget is not None}
    beyond = [
        f"{artifact}: {each}"
        for (artifact, _), found in results.items()
        for each in found
        if not each.outcome.agrees
    ]
    assert len(results) > 100 and not beyond
    largest = {}
    for (artifact, name), found in results.items():
        if name in budgets and name not in BUDGETS.get(artifact, {}):
            share = max(each.share for each in found)
            largest[name] = max(share, largest.get(name, 0.0))
    # Ten times the change, and up to ten times more to the next power of ten; another
    # processor's rounding may be ten times smaller.
    wide = {
        name: share for name, share in largest.items() if budgets[name] != IGNORED and share < 1e-3
    }
    assert wide.keys() <= OTHER_SOURCES
