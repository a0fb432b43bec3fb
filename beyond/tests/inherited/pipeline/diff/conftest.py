"""A small record and a copy of it that a test may change."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest
import xarray as xr
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from bouncing_ball_beyond.inherited.datasets.files import read_dataset, write_dataset
from bouncing_ball_beyond.inherited.pipeline.diff import compare as module
from bouncing_ball_beyond.inherited.pipeline.diff.compare import compare_folders
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Row, Whole

# Some accepted files of the replication, as they were at the commit bb943f6f.
RECORD = Path(__file__).with_name("record")
# A sweep with a picture, a schematic, a table, and what is made of others.
NAMES = ("fig01", "fig05", "table1", "claims")


@dataclass(frozen=True)
class Pair:
    """A record and new artifacts."""

    record: Path
    new: Path

    def compare(self, *names: str) -> Whole:
        return compare_folders(self.record, self.new, names)

    def artifact(self, name: str) -> Whole:
        (found,) = self.compare(name).parts
        return found

    def file(self, file: str) -> Whole:
        return next(part for part in self.artifact(Path(file).stem).parts if part.name == file)

    def dataset(self, name: str) -> xr.Dataset:
        return read_dataset(self.record / "figures" / f"{name}.nc")

    def write(self, name: str, data: xr.Dataset, side: str = "new") -> None:
        """Put a changed dataset among the new artifacts, or in the record."""
        write_dataset(data, getattr(self, side) / "figures" / f"{name}.nc")

    def move(self, name: str = "fig05", by: float = 1e-3, **attributes: object) -> None:
        """Move one number of a new dataset, and change its attributes."""
        data = self.dataset(name).assign_attrs(attributes)
        variable = "phase" if name == "fig05" else "computed"
        data[variable].values[(0,) * data[variable].ndim] += by
        self.write(name, data)

    def draw(self, file: str, picture: Image.Image, side: str = "new", **text: str) -> None:
        """Put a picture among the new artifacts, or in the record, with texts as metadata."""
        save_png(getattr(self, side) / file, picture, **text)

    def rewrite(self, file: str, old: str, new: str) -> None:
        """Replace the first occurrence of a text in a new file."""
        path = self.new / file
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    def row(self, file: str) -> Row:
        """The one row of a file that is not identical."""
        (row,) = [row for row in self.file(file).parts if row.outcome != "identical"]
        return row


def save_png(path: Path, picture: Image.Image, **text: str) -> None:
    """Write a PNG file with texts as metadata."""
    info = PngInfo()
    for key, value in text.items():
        info.add_text(key, value)
    picture.save(path, "PNG", pnginfo=info)


def _put(source: Path, target: Path) -> None:
    """Copy a file; of a picture a smaller version, which is read and compared ten times as fast."""
    if source.suffix != ".png":
        shutil.copyfile(source, target)
        return
    with Image.open(source) as picture:
        save_png(target, picture.reduce(3), **picture.text)


@pytest.fixture(scope="session")
def _record(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("record")
    (folder / "figures").mkdir(parents=True)
    for name in NAMES:
        for path in (RECORD / "figures").glob(f"{name}.*"):
            _put(path, folder / "figures" / path.name)
    shutil.copyfile(RECORD / "paper.md", folder / "paper.md")
    return folder


@pytest.fixture
def pair(_record, tmp_path, monkeypatch) -> Pair:
    # What is not committed in this checkout is no cause.
    monkeypatch.setattr(module, "touched_files", frozenset)
    for side in ("record", "new"):
        shutil.copytree(_record, tmp_path / side)
    return Pair(tmp_path / "record", tmp_path / "new")
