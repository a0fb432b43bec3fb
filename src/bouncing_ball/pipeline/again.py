"""Pictures, tables and pages made once more from their datasets, to be compared with the files.

A dataset decides to the byte what is made from it. So a picture or a table that was
changed together with the log of its job is found before it becomes the record.
"""

from pathlib import Path

import xarray as xr

from bouncing_ball.configuration.stages import STAGES, Kind, tables
from bouncing_ball.configuration.study import load
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.record.carriers import read_provenance


def make_again(name: str, results: Path, folder: Path) -> None:
    """Make what is made of an artifact's dataset in the results, in another folder.

    Makes nothing for a name that no stage has. The metadata of pictures are
    those that the results have.
    """
    stage = STAGES.get(name)
    if stage is None:
        return
    source = results / "figures" / f"{name}.nc"
    data = read_dataset(source) if stage.study else xr.Dataset()
    if stage.kind in (Kind.FIGURE, Kind.EXTENSION):
        inputs = (data,) if stage.study else ()
        _draw(name, inputs, source.with_suffix(".png"), folder)
    if name in tables():
        from bouncing_ball.figures.tables.formats import texts

        for suffix, text in texts(*load(f"figures.tables.{name}.rows")(data)).items():
            write_text(folder / f"{name}{suffix}", text)
    if stage.kind is Kind.PAGE:
        from bouncing_ball.figures.explorer.document import to_html

        write_text(folder / f"{name}.html", to_html(data))


def _draw(name: str, inputs: tuple[xr.Dataset, ...], made: Path, folder: Path) -> None:
    # Imported here: matplotlib takes a second.
    from bouncing_ball.figures.style import save_all, style

    with style():
        figure = load(f"figures.{name}.draw")(*inputs)
        paths = [folder / f"{name}{suffix}" for suffix in (".png", ".svg")]
        save_all(figure, paths, read_provenance(made).attributes())
