"""What all tests share: short answers about motions, and the texts and data of the docs."""

import pytest

from bouncing_ball_beyond.inherited.contacts.contact import effort


@pytest.fixture
def short_motions(monkeypatch):
    """An answer about the motion on which a ball ends follows few impacts."""
    for kind in ("LINEAR", "OF_LAW"):
        monkeypatch.setattr(effort, kind, getattr(effort, kind)._replace(impacts=20))


@pytest.fixture
def short_runs(short_motions, monkeypatch):
    """An answer follows few impacts: long runs are those of contact/test_motion.py."""
    for kind in ("LINEAR", "OF_LAW"):
        monkeypatch.setattr(effort, kind, getattr(effort, kind)._replace(starts=3))
    # Balls of a law that come to rest on a stiff contact take longest.
    monkeypatch.setattr("bouncing_ball_beyond.inherited.contacts.contact.starts._IMPACTS", 3)
