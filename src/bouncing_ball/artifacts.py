"""What a run makes: datasets, which record how they were made, and the files that follow from them.

A dataset records its parameters, the versions of libraries, and the files of code that made it with
their contents. Pictures, tables, claims and texts are functions of datasets.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import netCDF4
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball import datasets, drawing
from bouncing_ball.datasets import PACKAGES, Datasets
from bouncing_ball.differences import changes, record
from bouncing_ball.history import commit, contents

# Files, and the datasets that they follow from

Code = tuple[str | Path, ...]
"""Files of code, templates and numbers that a product is made by."""


@dataclass(frozen=True)
class Product:
    """Files that follow from the datasets `needs`; `make` writes them into a folder by `code`."""

    files: tuple[str, ...]
    needs: tuple[str, ...]
    make: Callable[[Datasets, Path], None]
    code: Code

    @property
    def artifact(self) -> str:
        """The name of the figure, table or text."""
        return Path(self.files[0]).stem

    @property
    def is_dataset(self) -> bool:
        """Whether it is a dataset, which follows from others."""
        return self.files[0].endswith(".nc")


def picture(
    name: str, needs: tuple[str, ...], draw: Callable[[Datasets], Figure], code: Code
) -> Product:
    """A figure as SVG and as PNG.

    The SVG comes first, because a difference of its lines tells more than one of pixels.
    """
    files = (f"figures/{name}.svg", f"figures/{name}.png")

    def make(data: Datasets, folder: Path) -> None:
        svg, png = (folder / file for file in files)
        drawing.save_picture(draw(data), png, svg, commit(code))

    return Product(files, needs, make, code)


def text(
    file: str, needs: tuple[str, ...], write: Callable[[Datasets], str], code: Code = ()
) -> Product:
    """A file of text."""

    def make(data: Datasets, folder: Path) -> None:
        (folder / file).write_text(write(data), encoding="utf-8", newline="\n")

    return Product((file,), needs, make, code)


def table(
    file: str,
    rows: Callable[[xr.Dataset], list[list[str]]],
    write: Callable[[list[list[str]]], str],
    code: Code,
) -> Product:
    """A table of the dataset with the name of its file."""
    name = Path(file).stem
    return text(f"figures/{file}", (name,), lambda data: write(rows(data[name])), code)


def needed(products: Collection[Product]) -> list[str]:
    """The datasets that some products follow from."""
    return list(dict.fromkeys(name for product in products for name in product.needs))


# Datasets, and how they were made


@dataclass(frozen=True)
class Side:
    """The folder of the results or of the reference, with the datasets that could be read, and why
    others could not.
    """

    name: str
    folder: Path
    data: dict[str, xr.Dataset]
    unread: dict[str, str]

    def dataset(self, name: str) -> Path:
        """The file of a dataset."""
        return self.folder / "figures" / f"{name}.nc"

    def other_versions(self, names: Iterable[str]) -> list[str]:
        """Versions of packages, other than those of today, with which some datasets were made."""
        today = datasets.versions()
        there = [record(self.data[name], "versions") for name in names if name in self.data]
        others = {(each, made[each]) for made in there for each in PACKAGES} - {*today.items()}
        return [f"{each} {made} (today {today[each]})" for each, made in sorted(others)]


def read_side(name: str, folder: Path, names: Iterable[str]) -> Side:
    """A side with the datasets that are there."""
    data = {}
    unread = {}
    for each in names:
        path = folder / "figures" / f"{each}.nc"
        try:
            # A pipe would be read for ever.
            if path.is_file():
                data[each] = read(path)
        except Exception as error:  # Whatever readers of damaged files raise.
            # With this error HDF5 refuses a damaged file, and one that it cannot lock.
            locks = LOCKS if "HDF error" in str(error) else ""
            unread[each] = f"{type(error).__name__}: {error}{locks}"
    return Side(name, folder, data, unread)


LOCKS = "; if the file system has no locks, set HDF5_USE_FILE_LOCKING=FALSE"


def read(path: Path) -> xr.Dataset:
    """The dataset of a file that records how it was made, and has nothing else in it.

    Raises ValueError, or whatever the reader raises, for another file.
    """
    with netCDF4.Dataset(path) as file:
        unlimited = [name for name, each in file.dimensions.items() if each.isunlimited()]
        beside = ", ".join([*file.groups, *unlimited]) or "none"
        if (file.data_model, beside) != ("NETCDF4", "none"):
            form = f"{file.data_model} with groups or unlimited dimensions: {beside}"
            raise ValueError(f"it has the format {form}")
    data = datasets.read(path)
    record(data, "parameters")
    code = record(data, "code")
    versions = record(data, "versions")
    texts = [*code.values(), *(versions.get(package) for package in PACKAGES)]
    if not code or not all(isinstance(text, str) for text in texts):
        raise ValueError(f"it does not record its code and the versions of {', '.join(PACKAGES)}")
    return data


WORDS = ("title", "caption", "table")
"""What a configuration says of a dataset beside its parameters."""


def configured(config: Mapping, name: str, recorded: Collection[str]) -> dict:
    """The parameters of a dataset in a configuration.

    Its sections are stages with their datasets, and everything else is a setting of the whole run,
    which counts where a dataset records it.
    """
    found = {key: value for key, value in config.items() if key in recorded}
    for stage in config.values():
        if isinstance(stage, Mapping) and isinstance(stage.get(name), Mapping):
            found |= {key: value for key, value in stage[name].items() if key not in WORDS}
    return datasets.plain(found)


def staleness(new: xr.Dataset, name: str, config: Mapping, top: Path) -> Iterator[str]:
    """Why a result is not that of a configuration and of today's code, in the checkout `top`."""
    recorded = record(new, "parameters")
    changed = changes(recorded, configured(config, name, recorded))
    if changed:
        yield f"stale: the configuration is another than it was made with: {'; '.join(changed)}"
    code = record(new, "code")
    today = contents([top / file for file in code if (top / file).is_file()])
    edited = [file for file in code if today.get(file) != code[file]]
    if edited:
        words = f"stale: it was made by other code than today's: {', '.join(edited)}"
        yield f"{words}; remove it, and run again"
