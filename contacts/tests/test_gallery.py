"""Every script of the gallery ends in a picture, is short, and uses public names only."""

import pytest
from gallery_checks import ends_in_a_picture, every_script, the_page_shows_all
from the_docs import DOCS

import bouncing_ball_beyond
import bouncing_ball_contacts

GALLERY = DOCS / "gallery"


def test_there_are_three_and_the_page_shows_all():
    the_page_shows_all(GALLERY, 3)


@pytest.mark.slow
@every_script(GALLERY, often="design_with_units")
def test_a_script_ends_in_a_picture(script, tmp_path, monkeypatch):
    ends_in_a_picture(script, (bouncing_ball_contacts, bouncing_ball_beyond), tmp_path, monkeypatch)
