"""What is not compared with the paper is compared in no text."""

import numpy as np
import pytest

from bouncing_ball.errors import ModelError


@pytest.fixture(scope="module")
def other(record, texts):
    """All texts of a run whose Table 1 has another r, as the stage writes it, and whose ball on
    the table has the other release.
    """
    table = record["table1"].assign(printed=record["table1"].printed * np.nan)
    changed = {"table1": table.assign_attrs(restitution=0.8)}
    changed["ext_flights"] = record["ext_flights"].assign_attrs(release="force")
    return texts(record | changed)


def test_table_1_at_another_r_has_nothing_printed(other):
    body = other["table1", "to_csv"].splitlines()[1:]
    assert all(line.endswith(",,") for line in body)


def test_the_article_compares_no_entry_of_it(other, accepted):
    compared = ("ends of stability ranges in Table 1", "a bound that we chose")
    abstracts = [
        " ".join(made["article"].partition("## 1. Introduction")[0].split())
        for made in (accepted, other)
    ]
    assert all(words in abstracts[0] for words in compared)
    assert not any(words in abstracts[1] for words in compared)
    assert "table1 has other parameters than the claim requires: " in abstracts[1]
    assert "are not asked, as this rendering has other parameters" in abstracts[1]


def test_its_claims_are_not_asked(other):
    rows = [line for line in other["claims", "to_csv"].splitlines() if line.startswith('"Table 1:')]
    assert len(rows) == 18 and all(row.endswith(",–,,not asked") for row in rows)
    assert "Claims: Table 1" not in other["supplement"]


def test_the_cascade_under_the_other_release(other, accepted):
    """The limit at Λ_SD is stated for the paper's release only."""
    for words in (
        "Permanent contact therefore continues into a stable orbit",
        "cascade of flights",
    ):
        assert words in accepted["article"] and words not in other["article"]
    assert "this rendering was made with the other release" in other["article"]


def test_numbers_and_verdicts_follow_the_data(record, recorded, texts, accepted):
    moved = {name: data.copy(deep=True) for name, data in record.items()}
    moved["fig14"]["error_threshold"].values[...] = 77.77
    # One last printed digit of one entry, and one formula that is wrong.
    moved["table1"]["computed"].values[0, 0, 0] += 1e-5
    moved["formulas"]["disagreement"].values[0] = 1e-3
    # The certified intervals did not move, which stops a run; the texts can still be made.
    with pytest.raises(ModelError, match="reproduced by its certified interval, but contradicted"):
        texts(moved)
    after = texts(moved, recorded["ext_verdicts"])
    for name in ("table1", "formulas"):
        assert all(after[key] != text for key, text in accepted.items() if name in key)
    assert "77.77" in after["article"] and "77.77" not in accepted["article"]
    counted = [
        [line.rpartition(",")[2] for line in made["claims", "to_csv"].splitlines()]
        for made in (accepted, after)
    ]
    assert counted[0].count("reproduced") > counted[1].count("reproduced")
