"""Balls that lie on a contact with m > 1 for many of its oscillations."""

import numpy as np
import pytest

from bouncing_ball.beyond.laws import march as chapter
from bouncing_ball.beyond.laws.hertzian import HuntCrossley, KuwabaraKono, Tsuji
from bouncing_ball.beyond.laws.march import march
from bouncing_ball.beyond.laws.panel import Start

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
