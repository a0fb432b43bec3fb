"""The contact that is chosen for a law that is not linear."""

import pytest
from asked_contacts import assessed

from bouncing_ball_beyond.inherited.contacts import Contact, Question, Table, choose_contact
from bouncing_ball_beyond.inherited.errors import NoOrbitError

pytestmark = pytest.mark.usefixtures("short_runs")

TABLE = {"frequency": "50 Hz", "acceleration": "0.8 g"}
BALL = {"mass": "20 g", "restitution": 0.8}


@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize(
    ("law", "tolerance"),
    [
        ("hunt-crossley", 0.01),
        pytest.param("tsuji", 0.05, marks=pytest.mark.long),
        pytest.param("kuwabara-kono", 0.02, marks=pytest.mark.long),
    ],
)
def test_the_error_of_the_chosen_law_is_the_tolerance(law, tolerance):
    table = Table(**TABLE)
    found = choose_contact(table, Contact(**BALL, law=law), Question(tolerance=tolerance, n=1))
    assert found.case.law.name == law and found.n == 1
    assert found.measured_restitution == pytest.approx(0.8, rel=1e-9)
    # The assessment of this contact, and of one that lasts 1 % longer, which computes it anew.
    for longer, good in ((1.0, True), (1.01, False)):
        time = longer * found.contact_time
        again = assessed(**BALL, **TABLE, law=law, contact_time=time, n=1, tolerance=tolerance)
        off = abs(again.judged.errors["max_height"])
        assert (off <= tolerance) is good is again.is_good_enough
        # The error grows about as the duration.
        assert off == pytest.approx(tolerance * longer, rel=5e-3)


def test_a_tolerance_that_no_contact_meets_is_refused(refusal):
    with refusal(NoOrbitError, "no contact up to ϖ = 1e+06 has its greatest height predicted"):
        choose_contact(Table(**TABLE), Contact(**BALL, law="tsuji"), Question(tolerance=1e-9))
