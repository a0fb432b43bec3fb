"""Orbits with a long contact: where they are one family with those of a short one."""

import numpy as np
import pytest

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.long_contact import joined, joining_ratio


def contact(r, ratio, release=Release.DISPLACEMENT):
    return SpringDamper.from_restitution(r, ratio, release)


@pytest.mark.parametrize(("r", "parting"), [(0.85, 2.003), (0.65, 2.107)])
def test_the_families_part_where_another_program_found_it(r, parting):
    zeta = float(damping_ratio(r))
    found = joining_ratio(zeta, Release.DISPLACEMENT, 1.9, 4.0)
    assert found == pytest.approx(parting, abs=1e-3)
    assert joined(contact(r, found + np.array([-0.01, 0.01]))).tolist() == [True, False]


def test_no_parting_where_it_is_not_looked_for():
    zeta = float(damping_ratio(0.85))
    for low, high in ((1.5, 1.9), (2.1, 4.0)):
        assert np.isnan(joining_ratio(zeta, Release.DISPLACEMENT, low, high))
    # No saddle-node, so that there is nothing to join; and one beside it that is apart.
    both = SpringDamper(np.array([1.2, 3.0]), damping_ratio(np.array([0.3, 0.85])))
    assert joined(both).tolist() == [False, False]
