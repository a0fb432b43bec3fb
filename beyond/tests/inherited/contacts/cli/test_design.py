"""``bouncing-ball design``: keys, texts, exit statuses, and the page to print."""

import json

import numpy as np
import pytest
from asked_contacts import assessed
from PIL import Image

from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.contacts.contact.page_data import chart_and_motion
from bouncing_ball_beyond.inherited.contacts.contact.page_figures import draw
from bouncing_ball_beyond.inherited.contacts.contact.rows import document
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES

# Where the verdict is not what is tested, the runs that it rests on are short.
QUICK = pytest.mark.usefixtures("short_runs")

CASE = ("design", "--mass", "20 g", "--frequency", "50 Hz", "--acceleration", "0.8 g",
        "--restitution", "0.85")  # fmt: skip
STIFF = (*CASE, "--stiffness", "1e7 N/m")
UNIT = {"mass": 1.0, "frequency": "1 rad/s", "gravity": 1.0, "acceleration": 1.0,
        "restitution": 0.65, "n": 1}  # fmt: skip


@pytest.fixture(scope="module")
def found():
    # The paper's error of 1 %, over the value of the restitution model, is this over the contact's.
    return assessed(**UNIT, stiffness=36.0, tolerance=1 / 99)


@pytest.fixture(scope="module")
def data(found):
    return chart_and_motion(found)


@QUICK
def test_json_is_the_answer_of_the_call(ask):
    found = assessed(
        mass="20 g", frequency="50 Hz", acceleration="0.8 g", restitution=0.85, stiffness="1e7 N/m"
    )
    answer = ask(*STIFF)
    question = answer.pop("question")
    assert answer == json.loads(json.dumps(document(found)))
    assert (question["mass"], question["stiffness"], question["law"]) == (0.02, 1e7, None)
    # The saddle-node of an elastic ball is at Λ = 0, and an infinite error is null.
    case = "design --mass 1 --frequency 1 --acceleration 5 --restitution 1 --stiffness 1e5 --n 1"
    assert ask(*case.split())["orbits"][0]["errors"]["saddle_node"] is None


def test_the_text_begins_with_the_verdict(said):
    text = said(*STIFF, "--all")
    lines = text.splitlines()
    assert lines[0].startswith("The 1-T orbit is stable")
    assert lines[1].startswith("The restitution model") and lines[2].startswith("Reason: ")
    words = ("contact time", "peak force", "force over weight", "largest time step", "3-T orbit")
    assert all(word in text for word in words)
    # It does not depend on n.
    assert text.count("threshold of permanent contact") == 1
    assert lines[-1].split()[-6:] == ["+0.02", "%"] * 3


@QUICK
def test_without_a_family_each_has_one_line(said):
    short = said(*STIFF).splitlines()
    assert [line.split()[:2] for line in short[-4:-1]] == [[f"{n}-T", "yes"] for n in (1, 2, 3)]
    assert "--n 1 prints all" in short[-1] and "--all for all" in short[-1]
    assert len(short) < 35
    one = said(*STIFF, "--n", "2")
    assert "2-T orbit" in one and "period doubling at Λ" in one and "3-T" not in one


@QUICK
def test_what_was_given_is_said_again_with_its_units(said):
    given = "Given: mass 20 g, frequency 50 Hz, acceleration 7.84532 m/s^2, stiffness 10 MN/m"
    assert said(*STIFF).splitlines()[3] == f"{given}, restitution 0.85."
    command = ("design", "--mass", "20 kg", "--stiffness", "1e5", "--damping", "8 N s/m")
    heavy = said(*command)
    assert heavy.startswith("Given: mass 20 kg, stiffness 100 kN/m, damping 8 N s/m.")


@QUICK
def test_a_command_that_is_misspelt_is_found(refused):
    _, line = refused("desing", "--mass", "1")
    assert line.endswith("; did you mean design?")


@QUICK
def test_choosing(said):
    out = said(*CASE, "--quantity", "phase", "--tolerance", "0.1 %")
    assert out.splitlines()[1].startswith("A simulation needs a contact of at least ")
    words = "the restitution model then predicts the phase of impact of the 1-T orbit within 0.1 %"
    assert words in out


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (
            ("--acceleration", "0.8", "--n", "1"),
            1,
            "times gravity, and the 1-T orbit needs 0.2526; perhaps 0.8 g was meant",
        ),
        (("--plot", "/dev/null/page.png"), 2, "/dev/null/page.png cannot be written"),
    ],
)
@QUICK
def test_mistakes_are_one_line(refused, monkeypatch, data, arguments, status, says):
    monkeypatch.setattr(
        "bouncing_ball_beyond.inherited.contacts.contact.page_data.chart_and_motion",
        lambda found: data,
    )
    command = (*STIFF, *arguments)
    code, line = refused(*command)
    assert code == status and says in line


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
    height = float(data.ball.sel(model="spring-damper").max())
    assert height == pytest.approx(one.max_height, rel=1e-5)
    gap = data.gap.sel(model="spring-damper")
    assert float(-gap.min()) == pytest.approx(one.greatest_compression, rel=1e-5)
    # The ball touches at zero and leaves at the contact's end.
    inside = data.since[np.flatnonzero(gap < 0)]
    step = float(data.since[1] - data.since[0])
    ends = [float(inside[0]), float(inside[-1])]
    assert ends == pytest.approx([0.0, one.contact_duration], abs=step)
    assert float(data.gap.sel(model="restitution").min()) >= -1e-12


def test_the_axes_of_the_page_are_in_seconds_and_metres():
    """A table that is not in the units of g = Ω = 1."""
    real = assessed(
        mass="20 g", frequency="50 Hz", acceleration="0.8 g", stiffness="2e5 N/m",
        restitution=0.65, n=1,
    )  # fmt: skip
    shown = chart_and_motion(real)
    one = real.judged
    # One cycle and a quarter of a period, of 20 ms.
    assert [float(shown.time[k]) for k in (0, -1)] == pytest.approx([0, 0.025], rel=1e-12)
    amplitude = 0.8 * 9.80665 / (100 * np.pi) ** 2
    times = shown.time.values
    assert shown.table.values == pytest.approx(
        amplitude * np.sin(100 * np.pi * times), abs=1e-12 * amplitude
    )
    ball = shown.ball.sel(model="spring-damper")
    assert float(ball.max()) == pytest.approx(one.max_height, rel=1e-5)
    # In flight the ball falls with g.
    top = int(np.argmax(ball.values))
    second = np.diff(ball.values[top - 20 : top + 20], 2) / np.diff(times)[0] ** 2
    assert second == pytest.approx(np.full(38, -9.80665), rel=1e-4)
    gap = shown.gap.sel(model="spring-damper")
    assert float(-gap.min()) == pytest.approx(one.greatest_compression, rel=1e-5)
    begins, ends = shown.since.values[[0, -1]]
    assert ends - begins == pytest.approx(3 * real.contact_time, rel=1e-12)
    assert begins == pytest.approx(-0.75 * real.contact_time, rel=1e-12)
    # The ball arrives with the impact speed.
    before = np.flatnonzero(shown.since.values < 0)[-2:]
    speed = np.diff(gap.values[before])[0] / np.diff(shown.since.values[before])[0]
    assert -speed == pytest.approx(one.impact_speed, rel=1e-3)


def test_the_page_shows_the_case(found, data):
    figure = draw(document(found), data, [("stiffness", "36 N/m")])
    star = next(line for line in figure.axes[0].lines if line.get_label() == "this contact")
    assert star.get_xydata().tolist() == [[0.65, found.frequency_ratio]]
    # The tolerance 1/99 in per cent, and as a line among the errors.
    assert figure.axes[0].get_title().startswith("right to 1.0101 % above the line")
    assert [1 / 99, 1 / 99] in [list(line.get_xdata()) for line in figure.axes[1].lines]
    labels = [label.get_text() for label in figure.axes[1].get_yticklabels()]
    assert labels == [QUANTITIES[quantity] for quantity in Quantity]
    texts = " ".join(" ".join(text.get_text().split()) for text in figure.texts)
    assert found.verdict in texts and found.reason in texts
    assert found.notes and all(f"Note: {note}." in texts for note in found.notes)


def test_a_page_without_errors_and_with_a_long_reason(found, data):
    """Every quantity has its row, and a line does not begin with a percent sign."""
    asked = document(found)
    for errors in (asked["orbits"][0][f"{x}errors"] for x in ("", "law_", "corrected_")):
        errors.update(dict.fromkeys(tuple(errors)[:3]))
    figure = draw(asked | {"reason": 33 * "so " + "long: 0.1 %"}, data, [])
    assert figure.axes[1].get_ylim() == (6.5, -0.5)
    assert figure.texts[2].get_text().endswith("\n0.1\u00a0%.")


def test_a_page_for_an_orbit_that_one_model_lacks(monkeypatch):
    lonely = assessed(**UNIT | {"restitution": 0.85, "acceleration": 0.247}, stiffness=100.0)
    monkeypatch.setattr("bouncing_ball_beyond.inherited.contacts.contact.page_data._CHART", 2)
    shown = chart_and_motion(lonely)
    assert shown.ball.sel(model="restitution").isnull().all()
    assert draw(document(lonely), shown, []).axes


@QUICK
def test_the_command_writes_the_page_and_answers_as_without(tmp_path, said, monkeypatch, data):
    monkeypatch.setattr(
        "bouncing_ball_beyond.inherited.contacts.contact.page_data.chart_and_motion",
        lambda found: data,
    )
    assert said(*STIFF, "--plot", str(tmp_path / "page.png")) == said(*STIFF)
    with Image.open(tmp_path / "page.png") as picture:
        # A4 upright, with ink in it.
        assert picture.height / picture.width == pytest.approx(2**0.5, abs=0.01)
        assert np.mean(np.asarray(picture.convert("L")) < 128) > 0.005


@QUICK
def test_a_page_in_a_folder_that_does_not_exist_is_refused_and_makes_none(tmp_path, refused):
    _, line = refused(*STIFF, "--plot", str(tmp_path / "new" / "page.png"))
    assert "is no folder that can be written to" in line
    assert not (tmp_path / "new").exists()


@QUICK
def test_the_text_says_which_model_has_no_orbit(said):
    # Between the saddle-nodes of the contact and of the restitution model.
    lonely = ("design", "--mass", "20 g", "--frequency", "50 Hz", "--acceleration", "0.247 g",
              "--stiffness", "2e5 N/m", "--restitution", "0.85")  # fmt: skip
    short = said(*lonely).splitlines()
    assert "no orbit (restitution)" in short[-2] and "none" not in short[-2]
    assert "no orbit" in short[-5]
    whole = said(*lonely, "--n", "1").splitlines()
    (height,) = [line for line in whole if line.startswith("    greatest height")]
    assert height.split("greatest height")[1].split() == "no orbit no orbit +0.042 %".split()
    faint = said(*STIFF, "--acceleration", "0.1 g")
    assert "no orbit (contact)" in faint
