"""Every script of the gallery ends in a picture, is short, and uses public names only."""

import ast
import runpy

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image
from the_docs import DOCS

import bouncing_ball_beyond
import bouncing_ball_contacts

GALLERY = DOCS / "gallery"
SCRIPTS = sorted(GALLERY.glob("*.py"))
PACKAGES = (bouncing_ball_contacts, bouncing_ball_beyond)
# All others are tried weekly.
OFTEN = {"design_with_units"}


def test_there_are_three_and_the_page_shows_all():
    assert len(SCRIPTS) == 3
    page = GALLERY.with_name("gallery.md").read_text(encoding="utf-8")
    for script in SCRIPTS:
        assert f"](gallery/{script.name})" in page
        # The page says what the script says, in the words of its docstring.
        title, _, text = ast.get_docstring(ast.parse(script.read_text("utf-8"))).partition(": ")
        assert f"## {title}\n" in page and text[1:] in " ".join(page.split())


@pytest.mark.slow
@pytest.mark.parametrize(
    "script",
    [
        pytest.param(path, id=path.stem, marks=() if path.stem in OFTEN else pytest.mark.long)
        for path in SCRIPTS
    ],
)
def test_a_script_ends_in_a_picture(script, tmp_path, monkeypatch):
    text = script.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 25
    for node in ast.walk(ast.parse(text)):
        for package in PACKAGES:
            if isinstance(node, ast.Attribute) and ast.unparse(node.value) == package.__name__:
                assert node.attr in package.__all__
        assert not (isinstance(node, ast.ImportFrom) and "bouncing_ball" in node.module)
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("agg")
    try:
        runpy.run_path(str(script))
    finally:
        plt.close("all")
    (made,) = tmp_path.iterdir()
    assert made.stem == script.stem
    (shown,) = (path for path in GALLERY.glob(f"{script.stem}.*") if path.suffix != ".py")
    with Image.open(made) as picture, Image.open(shown) as page:
        assert picture.size == page.size and picture.n_frames == page.n_frames
        # Not blank: something of another colour than the background in most rows.
        pixels = np.asarray(picture.convert("L"))
        assert np.mean(np.ptp(pixels, axis=1) > 100) > 0.5
