"""The study of the choices: how it judges, and what its result has."""

import numpy as np
import pytest
from tests.reference import reference, with_parameters

from carbonelli2011 import choices as study
from carbonelli2011.claims import CLAIMS


def test_the_parameters_of_a_figure_change_no_verdict():
    """With fewer points, as datasets of other choices have."""
    compute = study.ALONG_RATIO["fig10"]
    for _, same in study.other_axes(reference()["fig10"], compute, [1.0], [1000.0]):
        changed = study.verdicts(reference() | {"fig10": same}, {"fig10"})
        assert changed == study.verdicts(reference(), {"fig10"})


def test_an_axis_ends_where_it_is_chosen_to_end():
    compute = study.PERMANENT_CONTACT["fig11"]
    axes = dict(study.other_axes(reference()["fig11"], compute, [0.1, 2], [10, 100]))
    names = ["0.1 to 100", "2 to 100", "0.5 to 10", "0.5 to 100"]
    assert [*axes] == [f"ϖ from {name}" for name in names]
    # The first points of 20 in a decade from 0.5 and from 2 on.
    first = [0.1, 10 ** (7 / 20), 10 ** (-6 / 20), 10 ** (-6 / 20)]
    ends = [data.frequency_ratio.values[[0, -1]] for data in axes.values()]
    assert np.array(ends) == pytest.approx(np.transpose([first, [100, 100, 10, 100]]))


def test_a_claim_is_judged_if_a_dataset_of_the_choice_decides_it():
    judged = study.verdicts(reference(), {"fig12"})
    assert [name for name, _ in judged] == [
        claim.name for claim in CLAIMS if "fig12" in claim.datasets
    ]


def test_another_exponent_of_the_largest_frequency_ratio_judges_the_same_printed_ends():
    table = {
        (1e3 if ratio == 1e4 else ratio, n): ends for (ratio, n), ends in study.TABLE_1.items()
    }
    moved = reference()["table1"].assign_coords(
        frequency_ratio=[
            1e3 if ratio == 1e4 else ratio for ratio in reference()["table1"].frequency_ratio.values
        ]
    )
    here = study.verdicts(reference(), {"table1"})
    there = study.verdicts(reference() | {"table1": moved}, {"table1"}, table)
    assert [verdict for _, verdict in there] == [verdict for _, verdict in here]
    assert [name for name, _ in there] == [name.replace("10000", "1000") for name, _ in here]


def test_what_the_supplement_says_of_the_choices_is_in_the_result():
    result = reference()["choices"]
    pairs = list(zip(result.choice.values, result.changes.values, strict=True))
    assert not any("dip at 1.2" in changes for _, changes in pairs)
    grazing = [choice for choice, changes in pairs if "one impact per period" in changes]
    assert grazing == ["axis of Fig. 3", "axis of Fig. 8"]
    beyond = [name for name, changes in pairs if "→ beyond the axis" in changes]
    assert {*beyond} == {"axis of Fig. 6", "axis of Fig. 16"}


def test_a_run_with_other_parameters_has_no_choices():
    other = with_parameters(reference()["fig12"], n=2)
    verdicts = study.changed_verdicts(reference() | {"fig12": other})
    assert {*verdicts} == {"choice", "instead", "changes"} and verdicts.sizes["alternative"] == 0
