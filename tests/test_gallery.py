"""Every script of the gallery ends in a picture, is short, and uses public names only."""

import ast
import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

import bouncing_ball

GALLERY = Path(__file__).parents[1] / "docs" / "gallery"
SCRIPTS = sorted(GALLERY.glob("*.py"))
# All others are tried weekly.
OFTEN = {"drop_test"}


def test_there_are_five_and_the_page_shows_all():
    assert len(SCRIPTS) == 5
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
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "bouncing_ball":
            assert node.attr in bouncing_ball.__all__
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
