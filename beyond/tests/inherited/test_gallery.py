"""Every script of the gallery ends in a picture, is short, and uses public names only."""

from pathlib import Path

import pytest
from gallery_checks import ends_in_a_picture, every_script, the_page_shows_all

import bouncing_ball_beyond.inherited

GALLERY = Path(__file__).parents[2] / "docs" / "inherited" / "gallery"


def test_there_are_five_and_the_page_shows_all():
    the_page_shows_all(GALLERY, 5)


@pytest.mark.slow
@every_script(GALLERY, often="drop_test")
def test_a_script_ends_in_a_picture(script, tmp_path, monkeypatch):
    ends_in_a_picture(script, (bouncing_ball_beyond.inherited,), tmp_path, monkeypatch)
