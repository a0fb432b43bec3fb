"""Every study again, with the parameters of the run, against the accepted datasets."""

import inspect
from pathlib import Path

import pytest

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.configuration import arguments, load, read_yaml, typed
from bouncing_ball.pipeline.diff.datasets import compare_datasets

CONFIG = Path(__file__).parents[3] / "config"
RUN = read_yaml(CONFIG / "config.yaml")


# More than two seconds each: `make test` takes theirs from its run of the pipeline
# (tests/workflow/test_runs.py).
SLOW = {
    "ext_basins",
    "ext_diagram",
    "ext_laws",
    "ext_locked",
    "ext_locking",
}


def drifts(table, stages, recorded, artifacts):
    """The rows of the comparison that do not agree."""
    found = []
    for artifact in sorted(artifacts):
        if artifact not in recorded:
            found.append(f"{artifact}: not accepted")
            continue
        study = stages[artifact]
        given = arguments(study, artifact, RUN)
        if "data" in inspect.signature(load(study)).parameters:
            known = recorded | {"engines": read_dataset(CONFIG / "engines.nc")}
            given["data"] = {name: known[name] for name in table[artifact]["reads"]}
        record = recorded[artifact]
        again = typed(load(study))(**given).assign_attrs(record.attrs)
        rows = compare_datasets(artifact, record, again)
        found += [f"{artifact}: {row}" for row in rows if not row.outcome.agrees]
    return found


def test_the_studies_give_the_accepted_datasets(table, stages, recorded):
    assert (
        len(stages) > 20
        and drifts(table, stages, recorded, stages.keys() - SLOW - {"ext_means", "ext_lives"}) == []
    )


@pytest.mark.long
def test_the_slow_studies_give_the_accepted_datasets(table, stages, recorded):
    assert drifts(table, stages, recorded, SLOW) == []
