"""What is made once more has the same bytes each time."""

import shutil
from pathlib import Path

import pytest

from bouncing_ball.pipeline.again import make_again

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("name", "suffixes"),
    [
        ("fig01", {".png", ".svg"}),
        ("fig11", {".png", ".svg"}),
        ("table1", {".csv", ".md", ".tex"}),
        ("explorer", {".html"}),
        ("evidence", set()),
        ("paper", set()),
    ],
)
def test_made_again(tmp_path, name, suffixes):
    results = tmp_path / "results" / "figures"
    results.mkdir(parents=True)
    for path in (ROOT / "figures").glob(f"{name}.*"):
        shutil.copyfile(path, results / path.name)
    made = []
    for again in (tmp_path / "one", tmp_path / "two"):
        again.mkdir()
        make_again(name, results.parent, again)
        made.append({path.suffix: path.read_bytes() for path in again.iterdir()})
    assert made[0] == made[1] and made[0].keys() == suffixes
