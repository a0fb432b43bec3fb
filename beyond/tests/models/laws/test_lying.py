"""Balls that lie on a contact with m > 1 for many of its oscillations."""

import numpy as np
import pytest

from bouncing_ball_beyond.models.laws import march as chapter
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley, KuwabaraKono, Tsuji
from bouncing_ball_beyond.models.laws.march import MOST_PANELS, march, march_through
from bouncing_ball_beyond.models.laws.panel import Start
from bouncing_ball_beyond.models.laws.scales import rest

LAWS = [KuwabaraKono(8.4e5, 0.021), KuwabaraKono(3e4, 0.1), HuntCrossley(1e5, 3.0), Tsuji(1e6, 0.5)]


def lying(law):
    """Contacts of balls that are laid on a moving table, until it drops below them."""
    phase = np.linspace(-1.0, 1.4, 7)
    amplitude = np.full_like(phase, 1.3)
    zero = np.zeros_like(phase)
    return march(law, Start(zero, zero + 0.01, phase, amplitude, zero + 1), 2000)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_long_panels_end_where_short_panels_do(law, monkeypatch):
    found = lying(law)
    monkeypatch.setattr(chapter, "_SETTLING", np.inf)
    short = lying(law)
    assert np.isfinite(short.duration).all()
    # Ten times the error of a panel, over the times and speeds of the contact: of the order of 1.
    assert found.duration == pytest.approx(short.duration, abs=1e-11)
    assert found.rate == pytest.approx(short.rate, abs=1e-11)


def test_a_lying_ball_takes_fewer_panels(monkeypatch):
    panels = []
    original = chapter.Sweeps.panel

    def counted(self):
        panels[-1] += 1
        return original(self)

    monkeypatch.setattr(chapter.Sweeps, "panel", counted)
    for settling in (chapter._SETTLING, np.inf):
        monkeypatch.setattr(chapter, "_SETTLING", settling)
        panels.append(0)
        lying(LAWS[0])
    long, short = panels
    assert long < short / 2


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_the_states_of_a_contact_are_those_of_a_ball_for_each_time(law):
    start = Start(*(np.full(1, x) for x in (0.0, 0.01, -0.5, 1.3, 1.0)))
    time = np.linspace(0.0, float(march(law, start, 2000).duration[0]), 42)[1:-1]
    found = march_through(law, start, np.zeros(time.size, dtype=int), time, 2000)
    alone = march(law, Start(*(np.repeat(x, time.size) for x in start)), 2000, time)
    # Ten times the error of a panel, over the depth and the speed.
    assert found.penetration == pytest.approx(alone.penetration, abs=1e-11 * rest(law))
    assert found.rate == pytest.approx(alone.rate, abs=1e-11)


def test_several_contacts_have_their_own_times():
    law = LAWS[1]
    zero = np.zeros(2)
    speed = np.array([0.01, 0.5])
    start = Start(zero, speed, np.array([-0.5, 1.0]), zero + 1.3, zero + 1)
    contact = np.array([1, 0, 1, 0, 0])
    time = np.array([0.001, 0.7, 0.002, 50.0, 0.1])
    found = march_through(law, start, contact, time, 2000)
    alone = march(law, Start(*(row[contact] for row in start)), 2000, time)
    # No state is known after the release.
    assert np.isnan(found.rate).tolist() == [False, False, False, True, False]
    assert found.rate[:3] == pytest.approx(alone.rate[:3], abs=1e-11)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_a_ball_at_rest_is_followed_for_long(law):
    start = Start(*(np.full(1, x) for x in (0.0, 0.01, 0.0, 0.0, 1.0)))
    # Panels of an oscillation and a half would be twenty times as many as MOST_PANELS. The number
    # of long ones depends on rounding, which limits their length.
    found = march_through(law, start, np.zeros(1, dtype=int), np.full(1, 1e4), MOST_PANELS)
    # A panel as long as 10³ has rounding errors of 10⁻¹³ in p′, and of 10⁻¹¹ relative to its
    # scale.
    assert float(found.penetration[0]) == pytest.approx(rest(law), abs=1e-10 * rest(law))
    assert abs(float(found.rate[0])) < 1e-12
