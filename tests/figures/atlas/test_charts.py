"""The accepted summary, the charts that are drawn from it, and the orbits that it names."""

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.cli.main import main
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import parameter_attributes, read_dataset
from bouncing_ball.figures.atlas import limits, maps, page
from bouncing_ball.figures.atlas.tables import shares, worst
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


def test_there_is_a_chart_for_each_quantity(data):
    names = {path.stem for path in CHARTS.glob("*.png")}
    assert names == {*data["quantity"].values, "limits", "page"}


def test_the_tables_are_those_of_the_summary(data):
    for name, table in (("shares", shares), ("worst", worst)):
        text = (CHARTS / f"{name}.md").read_text(encoding="utf-8")
        assert text == to_markdown(*table(data))


def printed(capsys, command: str) -> dict:
    main(shlex.split(command)[1:])
    return json.loads(capsys.readouterr().out)


def test_each_of_the_worst_orbits_is_reproduced_by_its_command(data, capsys):
    header, body = worst(data)
    assert len(body) == 2 * 2 * data.sizes["quantity"]
    for line in body:
        row = dict(zip(header, line, strict=True))
        command = row["command"].strip("`") + " --json"
        exact = printed(capsys, command)
        other = f"{command} --model {row['model']}"
        if row["model"] == "restitution":
            other = command.replace("--measured-restitution", "--restitution")
            other = other.replace(" --frequency-ratio 100", "").replace(" --release force", "")
        simple, quantity = printed(capsys, other), row["quantity"].replace(" ", "_")
        error = abs(exact[quantity] / simple[quantity] - 1)
        assert f"{100 * error:.3g} %" == row["error"], row


def test_the_charts_are_drawn(data):
    # What is drawn is looked at by people; that the marks are there is seen here.
    with style():
        chart = maps.draw(data, "max_height")
        mesh = chart.axes[1].collections[0]
        assert mesh.get_array().shape == (data.sizes["restitution"], data.sizes["position"])
        needed = data.needed.sel(release="displacement", model="restitution", n=1)
        fails = needed.sel(quantity="max_height") > 100
        share = data.failing_share.sel(release="displacement", model="restitution", n=1)
        most = share.sel(quantity="max_height") > 0.5
        assert 0 < int(most.sum()) < int(fails.sum())
        hatched, crossed = (len(x.get_paths()) for x in chart.axes[1].collections[1:3])
        assert (hatched, crossed) == (int((fails & ~most).sum()), int(most.sum()))
        assert len(limits.draw(data).axes) == 6
        titles = [axes.get_title() for axes in page.draw(data).axes]
        assert len([title for title in titles if title]) == 7
