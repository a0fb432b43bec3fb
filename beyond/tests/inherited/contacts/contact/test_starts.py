"""The shares of starts in words: of a linear contact, and with the intervals of few starts."""

from dataclasses import replace
from statistics import NormalDist
from types import SimpleNamespace

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.starts import (
    SharesOfStarts,
    ends_of_starts,
    interval,
)
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.basins import MotionName
from bouncing_ball_beyond.motions.motions import Kind

ORBIT = MotionName(Kind.ORBIT, 1, 1)
CHAOTIC = MotionName(Kind.CHAOTIC, 0, 0)
Z = NormalDist().inv_cdf(0.975)


@pytest.mark.parametrize(("count", "number"), [(0, 36), (1, 36), (18, 36), (36, 36), (3, 7)])
def test_an_interval_ends_where_the_share_seen_is_two_deviations_away(count, number):
    """Wilson's ends p satisfy |k/N - p| = z √(p (1 - p)/N)."""
    low, high = interval(count, number)
    seen = count / number
    assert low <= seen + 1e-12 and seen <= high + 1e-12
    for end in (low, high):
        away = abs(seen - end)
        assert away == pytest.approx(Z * np.sqrt(max(end * (1 - end), 0) / number), abs=1e-9)


def test_few_starts_have_intervals_and_many_have_none():
    of_few = SharesOfStarts({ORBIT: 0.5, CHAOTIC: 0.5}, (0.0, -1.0), 36).sentence
    assert of_few == (
        "Of 36 balls with other starts, 50 % (34 to 66 %) end on the 1-T orbit, "
        "50 % (34 to 66 %) in chaotic motion; the ranges are intervals of 95 % for so few balls."
    )
    of_many = SharesOfStarts({ORBIT: 9 / 144, CHAOTIC: 135 / 144}, (0.0, -1.0), 144).sentence
    assert (
        "94 % end in chaotic motion, 6.2 % on the 1-T orbit." in of_many
        and "interval" not in of_many
    )


def test_a_law_is_followed_itself():
    """Balls rest on the law, and bounce on the linear contact beside it, which loses less."""
    law = Tsuji(500.0, tsuji_damping(0.3))
    other = SpringDamper.from_restitution(0.95, 10.0)
    case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 0.3, 1.0), law, other)
    found = ends_of_starts(case)
    assert found.balls == 36 and found.by_text == {"permanent contact": 1.0}
    of_linear = ends_of_starts(replace(case, law=other, equivalent=other))
    assert of_linear.balls == 144 and of_linear.by_text.get("permanent contact", 0.0) < 0.9


def test_the_first_motion_is_the_commonest_one_of_the_commonest_kind(monkeypatch):
    motions = [
        MotionName(Kind.LOCKED, 4, 3),
        MotionName(Kind.SUBHARMONIC, 2, 2),
        MotionName(Kind.SUBHARMONIC, 3, 3),
    ]
    which = np.array([[0, 0, 1, 2, 0], [1, 2, 2, 1, 2]])
    share = np.bincount(which.ravel()) / which.size
    found = SimpleNamespace(
        which=which, share=share, motions=motions, phase=np.arange(5.0), speed=np.ones(2)
    )
    monkeypatch.setattr(
        "bouncing_ball_beyond.inherited.contacts.contact.starts.basins", lambda *_, **__: found
    )
    spring = SpringDamper(10.0, 0.2)
    case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 0.2, 1.0), spring, spring)
    ends = ends_of_starts(case)
    # Of ten balls four end on the last motion, and seven on subharmonic ones.
    assert ends.first[0] == 3.0 and ends.sentence.startswith("Of 10 balls with other starts, 70 %")
