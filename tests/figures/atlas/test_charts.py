"""The accepted summary, the charts that are drawn from it, and the orbits that it names."""

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.cli.main import main
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import parameter_attributes, read_dataset
from bouncing_ball.figures.atlas.charts import charts
from bouncing_ball.figures.atlas.tables import worst
from bouncing_ball.figures.style import style
from bouncing_ball.figures.tables.formats import to_markdown

ROOT = Path(__file__).resolve().parents[3]
SUMMARY, CHARTS = ROOT / "config" / "atlas.nc", ROOT / "docs" / "atlas"


@pytest.fixture(scope="module")
def data():
    return read_dataset(SUMMARY)


def test_the_summary_is_that_of_the_configuration(data):
    section = parameter_attributes(read_yaml(ROOT / "config" / "config.yaml")["atlas"])
    for name, value in section.items():
        assert np.array_equal(data.attrs[name], value), name
    assert int(data.orbits) >= 10**8


def test_the_table_is_that_of_the_summary(data):
    assert (CHARTS / "worst.md").read_text(encoding="utf-8") == to_markdown(*worst(data))


def printed(capsys, command: str) -> dict:
    main(shlex.split(command)[1:])
    return json.loads(capsys.readouterr().out)


def test_each_of_the_worst_orbits_is_reproduced_by_the_command_of_the_page(data, capsys):
    header, body = worst(data)
    assert len(body) == 2 * data.sizes["quantity"]
    for line in body:
        row = dict(zip(header, line, strict=True))
        family = f"bouncing-ball orbit --json --n {row['n']} --amplitude {row['Λ']}"
        contact = f"--measured-restitution {row['r']} --release {row['release']}"
        exact = printed(capsys, f"{family} {contact} --frequency-ratio 100")
        simple = printed(capsys, f"{family} --restitution {row['r']}")
        quantity = row["quantity"].replace(" ", "_")
        error = abs(exact[quantity] / simple[quantity] - 1)
        assert f"{100 * error:.3g} %" == row["error"], row


def test_the_charts_are_drawn(data):
    # What is drawn is looked at by people; that the numbers are there is seen here.
    with style():
        drawn = dict(charts(data))
    assert set(drawn) == {path.stem for path in CHARTS.glob("*.png")}
    mesh = drawn["phase"].axes[3].collections[0]
    needed = data.needed.sel(release="force", model="corrected", n=1, quantity="phase")
    shown = np.ma.filled(mesh.get_array(), np.nan).reshape(needed.T.shape)
    assert np.array_equal(shown, needed.T.clip(3, 1e6), equal_nan=True)
    titles = [axes.get_title() for axes in drawn["page"].axes]
    assert len([title for title in titles if title]) == 7
