"""Make the data, the pictures and the tables of the docs, and the parts of pages from them.

``python docs/make_data.py`` makes all of this again, in half a minute. It takes no engine: what
engines measured is in engines.nc, bounces.nc, bounce_settings.nc and bounce_drivers.nc in data/,
which ``make test-engines`` writes. Call this script after it.
"""

from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr
from bouncing_ball.datasets.files import (
    CONVENTIONS,
    parameter_attributes,
    read_dataset,
    write_dataset,
    write_text,
)
from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import style
from bouncing_ball.drawing.tables import TextTable, to_csv, to_markdown
from bouncing_ball.pipeline.article import FORMATS, by_sentence
from bouncing_ball.pipeline.front import with_parts
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.documents import bounces, engine_steps, measured_impacts
from bouncing_ball_contacts.documents.bounces_figures import bounces as draw_bounces
from bouncing_ball_contacts.documents.bounces_figures import (
    bounces_table,
    drivers,
    in_javascript,
    rapier_974,
    settings_table,
)
from bouncing_ball_contacts.documents.bounces_figures import settings as draw_settings
from bouncing_ball_contacts.documents.engine_steps_figures import engines, engines_table
from bouncing_ball_contacts.documents.measured_impacts_figures import (
    measured_impacts as draw_measured,
)
from bouncing_ball_contacts.documents.measured_impacts_figures import measured_table, shaker_table
from jinja2 import Environment, FileSystemLoader, StrictUndefined

DOCS = Path(__file__).resolve().parent
DATA = DOCS / "data"

# One of the orbits that physics engines ran, and its error over the steps in a contact.
ENGINE_STEPS: dict[str, Any] = {
    "n": 1,
    "restitution": 0.65,
    "release": Release.FORCE,  # the release that all engines have
    "steps": [48, 192, 768, 3072, 12288, 65536],
    "balls": 20,
    "transient": 8,
    "impacts": 32,
    "seed": 41,
}
# Measured impacts against every law.
MEASURED: dict[str, Any] = {
    "experiments": [
        "croquet",
        "golf_ball",
        "bouncy_ball",
        "metallic_glass",
        "plastic_ball",
        "blue_marble",
        "metal_marble",
        "membrane_heavy",
        "membrane_light",
        "thin_drop",
        "viscous_drop",
        "superball",
    ],
    "samples": 41,
}
# The balls of the experiments on shakers.
SHAKER: dict[str, Any] = {
    "experiments": [
        "croquet",
        "superball",
        "membrane_heavy",
        "membrane_light",
        "thin_drop",
        "viscous_drop",
        "golf_ball",
        "plastic_ball",
        "bouncy_ball",
        "metallic_glass",
    ],
    "n": [1, 2],  # the constant r is that at the impact speed of the first family
    "frequencies": [10.0, 20.0, 50.0, 100.0],  # Hz
    "position": 0.5,
}


class Study(NamedTuple):
    """A dataset that is computed here, from parameters by their names."""

    title: str
    compute: Callable[..., xr.Dataset]
    parameters: dict[str, Any]


class Shown(NamedTuple):
    """What shows a dataset beside it: a table, and mostly a picture."""

    title: str
    table: Callable[[xr.Dataset], TextTable]
    draw: Callable[[xr.Dataset], Any] | None = None


def _engine_steps(**parameters: Any) -> xr.Dataset:
    runs = read_dataset(DATA / "engines.nc")
    return engine_steps.conformance(runs, engine_steps.EngineOrbit(**parameters))


def _measured(**parameters: Any) -> xr.Dataset:
    return measured_impacts.measured_impacts(measured_impacts.MeasuredImpacts(**parameters))


def _shaker(**parameters: Any) -> xr.Dataset:
    return measured_impacts.on_shakers(measured_impacts.Shaker(**parameters))


STUDIES = {
    "engine_steps": Study(engine_steps.TITLE, _engine_steps, ENGINE_STEPS),
    "measured": Study(measured_impacts.TITLE, _measured, MEASURED),
    "shaker": Study(measured_impacts.SHAKER_TITLE, _shaker, SHAKER),
}
"""The datasets that are computed here, by their names in data/."""

SHOWN = {
    "engine_steps": Shown(engine_steps.TITLE, engines_table, engines),
    "measured": Shown(measured_impacts.TITLE, measured_table, draw_measured),
    "shaker": Shown(measured_impacts.SHAKER_TITLE, shaker_table),
    "bounces": Shown(bounces.TITLE, bounces_table, draw_bounces),
    "bounce_settings": Shown(bounces.SETTINGS_TITLE, settings_table, draw_settings),
}
"""The datasets that have a table and a picture, also those that engines measured."""


def computed(name: str, **changed: Any) -> xr.Dataset:
    """The dataset of a study, with its parameters as attributes, of which some may be changed."""
    study = STUDIES[name]
    parameters = study.parameters | changed
    data = study.compute(**parameters)
    given = parameter_attributes(parameters)
    given |= {key: str(value) for key, value in given.items() if isinstance(value, Release)}
    made = {"title": study.title, "history": "computed by contacts/docs/make_data.py"}
    return data.assign_attrs({"Conventions": CONVENTIONS} | made | given)


def tables(name: str, data: xr.Dataset) -> dict[str, str]:
    """The texts of the table of a dataset by their suffixes."""
    header, rows = SHOWN[name].table(data)
    return {".csv": to_csv(header, rows), ".md": to_markdown(header, rows)}


def drawn(name: str, data: xr.Dataset) -> Any:
    """The figure of a dataset that has one."""
    draw = SHOWN[name].draw
    assert draw is not None
    with style():
        return draw(data)


def pages() -> dict[str, str]:
    """The pages with their parts, which have the numbers of the data, by the names of the pages."""
    names = ("engine_steps", "measured", "shaker")
    data = {name: read_dataset(DATA / f"{name}.nc") for name in names}
    folder = DOCS / "bounces"
    parts = {
        "engines.md": {"time_steps": _rendered("time_steps", data)},
        "measured.md": {
            "verdicts": _rendered("verdicts", data),
            "shaker": _rendered("shaker", data),
        },
        "bounces.md": {
            "drivers": drivers(read_dataset(DATA / "bounce_drivers.nc")),
            "rapier_974": rapier_974(_lines(folder / "rapier_974.csv")),
            "javascript": in_javascript(_lines(folder / "javascript.csv")),
        },
    }
    return {
        page: with_parts((DOCS / page).read_text(encoding="utf-8"), texts)
        for page, texts in parts.items()
    }


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines()


def _rendered(name: str, data: dict[str, xr.Dataset]) -> str:
    """The text of a template, with a line for each sentence."""
    environment = Environment(
        loader=FileSystemLoader(DOCS / "templates"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.globals.update(FORMATS, data=data)
    return by_sentence(environment.get_template(f"{name}.md.j2").render())


def main() -> None:
    """Make everything."""
    for name in STUDIES:
        write_dataset(computed(name), DATA / f"{name}.nc")
        print(f"data/{name}.nc")
    for name, shown in SHOWN.items():
        data = read_dataset(DATA / f"{name}.nc")
        for suffix, text in tables(name, data).items():
            write_text(DATA / f"{name}{suffix}", text)
        if shown.draw is not None:
            figure = drawn(name, data)
            # Another matplotlib may draw other pixels.
            made = {"Title": shown.title, "matplotlib": version("matplotlib")}
            for suffix in (".png", ".svg"):
                save(figure, DATA / f"{name}{suffix}", made)
        print(f"data/{name}: pictures and tables")
    for page, text in pages().items():
        write_text(DOCS / page, text)
        print(page)


if __name__ == "__main__":
    main()
