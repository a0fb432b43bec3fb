"""Every study again, with the parameters of the run, against the accepted datasets."""

import inspect
from pathlib import Path

import pytest
from declared_artifacts import ARTIFACTS, STUDIES, compare_artifact

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.configuration import arguments, typed
from bouncing_ball.pipeline.yaml_files import read_yaml

CONFIG = Path(__file__).parents[3] / "config"
RUN = read_yaml(CONFIG / "config.yaml")


# More than two seconds each: `make test` takes theirs from its run of the pipeline
# (tests/workflow/test_runs.py).
SLOW = {"ext_laws", "ext_map"}


def drifts(recorded, names):
    """The rows of the comparison that do not agree."""
    found = []
    for artifact in sorted(names):
        if artifact not in recorded:
            found.append(f"{artifact}: not accepted")
            continue
        study = STUDIES[artifact]
        given = arguments(study, ARTIFACTS[artifact].part, artifact, RUN)
        if "data" in inspect.signature(study).parameters:
            known = recorded | {"engines": read_dataset(CONFIG / "engines.nc")}
            given["data"] = {name: known[name] for name in ARTIFACTS[artifact].reads}
        record = recorded[artifact]
        again = typed(study)(**given).assign_attrs(record.attrs)
        rows = compare_artifact(artifact, record, again)
        found += [f"{artifact}: {row}" for row in rows if not row.outcome.agrees]
    return found


def test_the_studies_give_the_accepted_datasets(recorded):
    assert len(STUDIES) > 20
    assert drifts(recorded, STUDIES.keys() - SLOW) == []


@pytest.mark.long
def test_the_slow_studies_give_the_accepted_datasets(recorded):
    assert drifts(recorded, SLOW) == []
