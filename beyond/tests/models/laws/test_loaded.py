"""A user's law whose force depends on the load, with no more than it must have."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from loaded_laws import Sharing

from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw, under
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact


@dataclass(frozen=True, repr=False)
class Least(LoadedLaw, ContactLaw):
    """A spring and a damper, and a constant share d of the load."""

    stiffness: float
    damping: float
    share: float

    name: ClassVar[str] = "least"

    def force(self, penetration, rate):
        """K p + C p′ + d a."""
        return self.stiffness * penetration + self.damping * rate + self.share * self.load


LAW = Least(9.0, 1.2, 0.6)
KNOWN = Sharing(3.0, 0.2, 0.6)


def test_a_law_with_no_more_than_it_must_have_has_the_same_contacts():
    # Some contacts end at the surface and some where the force vanishes.
    speed = np.linspace(0.02, 4.0, 40)
    phase = np.linspace(-3.0, 3.0, 40)
    found, known = (contacts(law, speed, phase, 1.3) for law in (LAW, KNOWN))
    assert 0 < np.count_nonzero(known.penetration == 0) < 40
    np.testing.assert_allclose(found.duration, known.duration, rtol=1e-12)
    np.testing.assert_allclose(found.rate, known.rate, rtol=1e-11)
    assert rest(LAW) == pytest.approx(rest(KNOWN), rel=1e-12)
    assert permanent_contact(LAW) == pytest.approx(permanent_contact(KNOWN), rel=1e-10)


def test_a_law_without_kinks_is_continued_by_itself():
    assert LAW.continued(np.zeros(2), np.ones(2)) is LAW


def test_a_law_under_a_load_keeps_its_parameters():
    for law in (LAW, KNOWN):
        loaded = under(law, 2.0)
        assert loaded == law and loaded.force(1.0, 0.0) == pytest.approx(9.0 + 0.6 * 2.0)
        assert law.force(1.0, 0.0) == pytest.approx(9.0)


def test_laws_of_a_row_keep_their_loads():
    row = Least(np.array([9.0, 16.0, 25.0]), 1.2, 0.6).under(np.array([1.0, 2.0, 3.0]))
    assert row.take([2, 0]).force(1.0, 0.0).tolist() == [25.0 + 0.6 * 3.0, 9.0 + 0.6]
    assert LAW.under(2.0).take([0]).force(1.0, 0.0) == LAW.under(2.0).force(1.0, 0.0)
