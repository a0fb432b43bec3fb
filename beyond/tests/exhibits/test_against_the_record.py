"""Every study again, with the parameters of the configuration, against the accepted datasets."""

from pathlib import Path

import pytest
from declared_artifacts import given_to

from bouncing_ball_beyond.exhibits.budgets import BUDGETS
from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights
from bouncing_ball_beyond.exhibits.contact_laws import law_errors
from bouncing_ball_beyond.exhibits.corrected_model import meeting_flights, orders
from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits
from bouncing_ball_beyond.exhibits.release_rules import free_impacts, release_rules
from bouncing_ball_beyond.exhibits.stiffness_map import stiffness_map
from bouncing_ball_beyond.inherited.datasets.variables import budgeted
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import compare_datasets
from bouncing_ball_beyond.inherited.pipeline.job import arguments, typed
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

HOUSE = Path(__file__).parents[2]
RUN = read_yaml(HOUSE / "config" / "config.yaml")
STUDIES = {
    "explorer": reference_orbits,
    "ext_flights": cascade_of_flights,
    "ext_impact": free_impacts,
    "ext_instant": meeting_flights,
    "ext_laws": law_errors,
    "ext_map": stiffness_map,
    "ext_orders": orders,
    "ext_release": release_rules,
}
# More than two seconds each.
SLOW = ("ext_laws", "ext_map")


def test_every_accepted_dataset_is_that_of_a_study_with_parameters():
    accepted = {path.stem for path in (HOUSE / "figures").glob("*.nc")}
    assert accepted == STUDIES.keys() == RUN["beyond"].keys()


@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=pytest.mark.long if x in SLOW else ()) for x in STUDIES]
)
def test_a_study_gives_the_accepted_dataset(recorded, name):
    study = STUDIES[name]
    record = recorded[name]
    found = budgeted(
        typed(study)(**arguments(study, given_to(name, RUN, "beyond"))), BUDGETS.get(name, {})
    )
    again = found.assign_attrs(record.attrs)
    rows = compare_datasets(record, again)
    assert [str(row) for row in rows if not row.outcome.agrees] == []
