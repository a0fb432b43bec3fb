"""A small record and a copy of it that a test may change."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest
import xarray as xr
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.outcome import Whole

ROOT = Path(__file__).resolve().parents[3]
# A sweep, two branches whose pictures are of one size, a schematic, two tables.
NAMES = ("fig01", "fig05", "fig08", "fig09", "table1", "witness")


@dataclass(frozen=True)
class Pair:
    """A record and new artifacts."""

    record: Path
    new: Path

    def compare(self) -> Whole:
        return compare_folders(self.record, self.new)

    def artifact(self, name: str) -> Whole:
        (found,) = compare_folders(self.record, self.new, [name]).parts
        return found

    def part(self, file: str) -> Whole:
        return next(part for part in self.artifact(Path(file).stem).parts if part.name == file)

    def dataset(self, name: str) -> xr.Dataset:
        return read_dataset(self.record / "figures" / f"{name}.nc")

    def write(self, name: str, data: xr.Dataset) -> None:
        """Put a changed dataset among the new artifacts."""
        write_dataset(data, self.new / "figures" / f"{name}.nc")

    def variable(self, name: str, variable: str):
        """The worst row of one variable, after a check that nothing else differs."""
        rows = self.part(f"figures/{name}.nc").moved
        assert {row.name for row in rows} == {variable}
        return rows[0]

    def rewrite(self, file: str, old: str, new: str) -> None:
        """Replace the first occurrence of a text in a new file."""
        path = self.new / file
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")


def _put(source: Path, target: Path) -> None:
    """Copy a file; of a picture a smaller version, which is read and compared ten times as fast."""
    if source.suffix != ".png":
        shutil.copyfile(source, target)
        return
    with Image.open(source) as picture:
        text = PngInfo()
        for key, value in picture.text.items():
            text.add_text(key, value)
        picture.reduce(3).save(target, pnginfo=text)


@pytest.fixture(scope="session")
def _record(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("record")
    (folder / "figures" / "beyond").mkdir(parents=True)
    for name in NAMES:
        for path in (ROOT / "figures").glob(f"{name}.*"):
            _put(path, folder / "figures" / path.name)
    shutil.copyfile(ROOT / "paper.md", folder / "paper.md")
    return folder


@pytest.fixture
def pair(_record, tmp_path) -> Pair:
    for side in ("record", "new"):
        shutil.copytree(_record, tmp_path / side)
    return Pair(tmp_path / "record", tmp_path / "new")
