"""What is asked of the gallery of each house: a page, and short scripts that end in a picture."""

import ast
import runpy
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

# Packages that the scripts import by a short name.
SHORT = {"bouncing_ball_beyond.inherited": "bouncing_ball"}


def scripts_of(gallery: Path) -> list[Path]:
    return sorted(gallery.glob("*.py"))


def every_script(gallery: Path, often: str) -> pytest.MarkDecorator:
    """Tries the script ``often`` each time, and all others weekly."""
    cases = [
        pytest.param(path, id=path.stem, marks=() if path.stem == often else pytest.mark.long)
        for path in scripts_of(gallery)
    ]
    return pytest.mark.parametrize("script", cases)


def the_page_shows_all(gallery: Path, number: int) -> None:
    scripts = scripts_of(gallery)
    assert len(scripts) == number
    page = gallery.with_name("gallery.md").read_text(encoding="utf-8")
    for script in scripts:
        assert f"](gallery/{script.name})" in page
        # The page says what the script says, in the words of its docstring.
        title, _, text = ast.get_docstring(ast.parse(script.read_text("utf-8"))).partition(": ")
        assert f"## {title}\n" in page and text[1:] in " ".join(page.split())


def ends_in_a_picture(
    script: Path, packages: Iterable[ModuleType], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The script is run in a folder, and uses public names of the packages only."""
    text = script.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 25
    for node in ast.walk(ast.parse(text)):
        for package in packages:
            names = (package.__name__, SHORT.get(package.__name__))
            if isinstance(node, ast.Attribute) and ast.unparse(node.value) in names:
                assert node.attr in package.__all__
        assert not (isinstance(node, ast.ImportFrom) and "bouncing_ball" in node.module)
    monkeypatch.chdir(folder)
    plt.switch_backend("agg")
    try:
        runpy.run_path(str(script))
    finally:
        plt.close("all")
    (made,) = folder.iterdir()
    assert made.stem == script.stem
    (shown,) = (path for path in script.parent.glob(f"{script.stem}.*") if path.suffix != ".py")
    with Image.open(made) as picture, Image.open(shown) as page:
        assert picture.size == page.size and picture.n_frames == page.n_frames
        # Not blank: something of another colour than the background in most rows.
        pixels = np.asarray(picture.convert("L"))
        assert np.mean(np.ptp(pixels, axis=1) > 100) > 0.5
