"""The page of a design: what it shows is what the calculator says."""

import numpy as np
import pytest
from PIL import Image

from bouncing_ball.calculator.design import design
from bouncing_ball.calculator.page_data import page
from bouncing_ball.cli.design import answer
from bouncing_ball.cli.main import main
from bouncing_ball.figures.design_page import draw

CASE = {"mass": 1.0, "angular_frequency": 1.0, "gravity": 1.0, "acceleration": 1.0,
        "restitution": 0.65, "n": 1}  # fmt: skip


@pytest.fixture(scope="module")
def found():
    return design(**CASE, stiffness=36.0)


@pytest.fixture(scope="module")
def data(found):
    return page(found)


def test_the_chart_goes_through_the_published_threshold(data):
    at = data.needed.interp(restitution=0.65).sel(simple="restitution")
    # 82.177, on a line between points at which the curve is nearly straight.
    assert float(at) == pytest.approx(82.177, rel=0.02)
    assert data.needed.notnull().all()
    # It begins where the family does.
    first = float(data.restitution[0])
    assert first == pytest.approx((np.pi - 1) / (np.pi + 1), rel=1e-12)


def test_the_motion_is_the_orbit_in_its_units(found, data):
    one = found.orbits[0]
    assert float(data.ball.sel(model="spring-damper").max()) == pytest.approx(
        one.max_height, rel=1e-5
    )
    gap = data.gap.sel(model="spring-damper")
    assert float(-gap.min()) == pytest.approx(one.greatest_compression, rel=1e-5)
    # The ball touches at zero and leaves at the contact's end.
    inside = data.since[np.flatnonzero(gap < 0)]
    step = float(data.since[1] - data.since[0])
    assert float(inside[0]) == pytest.approx(0.0, abs=step)
    assert float(inside[-1]) == pytest.approx(one.contact_duration, abs=step)
    assert float(data.gap.sel(model="restitution").min()) >= -1e-12


def test_the_page_shows_the_case(found, data):
    figure = draw(answer(found), data, [("stiffness", "36 N/m")])
    star = next(line for line in figure.axes[0].lines if line.get_label() == "this contact")
    assert star.get_xydata().tolist() == [[0.65, found.frequency_ratio]]
    texts = " ".join(text.get_text().replace("\n", " ") for text in figure.texts)
    assert found.verdict in texts and found.reason in texts


def test_a_page_for_an_orbit_that_one_model_lacks(monkeypatch):
    lonely = design(**CASE | {"restitution": 0.85, "acceleration": 0.247}, stiffness=100.0)
    monkeypatch.setattr("bouncing_ball.calculator.page_data._CHART", 2)
    shown = page(lonely)
    assert shown.ball.sel(model="restitution").isnull().all()
    assert draw(answer(lonely), shown, []).axes


ASKED = ("design --mass 1 --angular-frequency 1 --gravity 1 --acceleration 1 --restitution 0.65 "
         "--stiffness 36 --n 1").split()  # fmt: skip


@pytest.fixture
def known(monkeypatch, data):
    """The chart once is enough."""
    monkeypatch.setattr("bouncing_ball.calculator.page_data.page", lambda found: data)


def test_the_command_writes_it_and_answers_as_without(tmp_path, capsys, known):
    main([*ASKED, "--plot", str(tmp_path / "page.png")])
    with_page = capsys.readouterr().out
    main(ASKED)
    assert capsys.readouterr().out == with_page
    with Image.open(tmp_path / "page.png") as picture:
        # A4 upright, with ink in it.
        assert picture.height / picture.width == pytest.approx(2**0.5, abs=0.01)
        assert np.mean(np.asarray(picture.convert("L")) < 128) > 0.005


@pytest.mark.parametrize("name", ["page.gif", "a file/page.pdf"])
def test_a_page_that_cannot_be_written(tmp_path, capsys, known, name):
    (tmp_path / "a file").touch()
    with pytest.raises(SystemExit) as exit_:
        main([*ASKED, "--plot", str(tmp_path / name)])
    out, err = capsys.readouterr()
    assert exit_.value.code == 2 and out == "" and err.count("\n") == 1
