"""The study of the choices: its result in the repository is what it finds."""

import csv
import importlib
import sys
from pathlib import Path

import pytest
from tests.reference import reference

from bouncing_ball.claims import CLAIMS
from bouncing_ball.datasets import printed_table

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def study():
    """The study as a module; it imports the scripts of the stages."""
    folders = [str(ROOT / "workflow" / name) for name in ("studies", "scripts")]
    sys.path[:0] = folders
    try:
        yield importlib.import_module("choices")
    finally:
        for folder in folders:
            sys.path.remove(folder)


def test_the_result_in_the_repository_is_that_of_the_study(study):
    found = study.changed_verdicts(reference(), printed_table(study.PRINTED))
    with open(study.RESULT, encoding="utf-8", newline="") as file:
        assert list(csv.DictReader(file)) == found


def test_the_parameters_of_the_figures_change_no_verdict(study):
    """With fewer points, as those of other choices have."""
    printed = printed_table(study.PRINTED)
    for name in ("fig05", "fig06", "fig10"):
        axes = study.other_axes(reference()[name], study.ALONG_RATIO[name], [1.0], [1000.0])
        for _, same in axes:
            changed = study.verdicts({**reference(), name: same}, printed, {name})
            assert changed == study.verdicts(reference(), printed, {name})


def test_a_claim_is_judged_if_a_dataset_of_the_choice_decides_it(study):
    judged = study.verdicts(reference(), printed_table(study.PRINTED), {"fig12"})
    assert [name for name, _ in judged] == [
        claim.name for claim in CLAIMS if "fig12" in claim.datasets
    ]


def test_what_the_supplement_says_of_the_choices_is_in_the_result(study):
    rows = list(csv.DictReader(study.RESULT.read_text("utf-8").splitlines()))
    assert not any("dip at 1.2" in row["changes"] for row in rows)
    grazing = [row["choice"] for row in rows if "one impact per period" in row["changes"]]
    assert grazing == ["axis of Fig. 3", "axis of Fig. 8"]
