"""Files of measured impacts: those of the package, and hostile ones."""

import re
import sys

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.measured.experiment import DATA, experiment, experiment_names, read


def test_every_experiment_says_where_its_numbers_come_from():
    assert len(experiment_names()) >= 5
    for name in experiment_names():
        found = experiment(name)
        for text in ("title", "ball", "measured by", "published", "source", "read"):
            assert found.texts[text], (name, text)
        assert found.texts["source"].startswith("http")
        assert np.all((found.restitutions > 0) & (found.restitutions <= 1))


def test_the_experiments_of_the_package_need_no_other_units(monkeypatch):
    # A job of the workflow may not import pint.
    monkeypatch.setitem(sys.modules, "pint", None)
    for name in experiment_names():
        assert experiment(name).speeds.size


def test_the_table_of_gugan():
    croquet = experiment("croquet")
    assert croquet.speeds.tolist() == [0.5, 1, 1.64, 2.04, 2, 2.83, 3.51, 4.43, 5.47, 6.01]
    assert croquet.restitutions[:3].tolist() == [0.857, 0.842, 0.829]
    times = [0.75, 0.75, 0.50, 0.75, 0.75, 0.87, 0.75]
    assert croquet.durations == pytest.approx(np.mean(times) * 1e-3, rel=1e-4)


def test_the_spans_of_ten_bounces_give_the_numbers_in_the_file():
    """The speeds and e of metallic glass again, from the spans that its head quotes."""
    found = experiment("metallic_glass")
    quoted = found.texts["read"].partition("digits:")[2]
    spans = np.array(re.findall(r"(\d+\.\d{3}) (\d+\.\d{3})", quoted), dtype=float)
    assert spans.shape == (9, 2)
    mean = (spans[:, 1] - spans[:, 0]) / 10
    start = spans.mean(axis=1) - mean / 2
    e = 1 - (mean[:-1] - mean[1:]) / (start[1:] - start[:-1])
    np.testing.assert_allclose(found.restitutions, e, atol=6e-7)
    speeds = STANDARD_GRAVITY * (mean[:-1] + mean[1:]) / 4
    np.testing.assert_allclose(found.speeds, speeds, atol=6e-6)


def test_that_rule_is_exact_for_a_constant_restitution():
    intervals = 0.25 * 0.99 ** np.arange(200)
    times = np.concatenate([[0.0], np.cumsum(intervals)])
    spans = np.array([[times[k], times[k + 10]] for k in (0, 30, 70)])
    mean = (spans[:, 1] - spans[:, 0]) / 10
    starts = np.array([times[k : k + 10].mean() for k in (0, 30, 70)])
    np.testing.assert_allclose((mean[:-1] - mean[1:]) / np.diff(starts), 0.01, rtol=1e-12)
    # The middle of a span less half an interval is earlier than the mean start by (n² - 1)/12 steps
    # of the interval, n = 10. By its difference 1 - e is wrong by 8.25 (1 - e)² of its value.
    early = starts - (spans.mean(axis=1) - mean / 2)
    np.testing.assert_allclose(early, 99 / 12 * 0.01 * mean, rtol=0.05)


def test_the_drag_is_removed_where_the_ball_is_known():
    plastic = experiment("plastic_ball")
    heights = np.array([0.10, 0.46])
    back = np.array([0.015, 0.060])
    plain = np.sqrt(back / heights)
    found = plastic.restitutions[[0, -1]]
    # To first order e grows by (h + h′)/(2ℓ) of its value, ℓ = 69 m.
    np.testing.assert_allclose(found / plain - 1, (heights + back) / 2 / 69.35, rtol=0.01)
    assert plastic.drag_bias == pytest.approx(found[-1] - plain[-1], rel=1e-6)


def test_errors_by_a_height_are_those_of_a_difference():
    plain = experiment("bouncy_ball")
    heights = np.array([[0.10, 0.05], [1.70, 0.96]])
    places = [0, -3]
    higher = np.sqrt((heights[:, 1] + 1e-7) / heights[:, 0])
    slope = (higher - np.sqrt(heights[:, 1] / heights[:, 0])) / 1e-7
    np.testing.assert_allclose(plain.relative_errors[places], slope, rtol=1e-5)
    # Errors that are given, or speeds in the file, leave none to be taken by their ratios.
    assert experiment("croquet").relative_errors is None
    assert experiment("membrane_light").relative_errors is None


def write(tmp_path, text, name="drops.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_units_are_those_of_the_heading(tmp_path):
    path = write(tmp_path, "speed [km/h], restitution [%], duration [us]\n3.6, 80, 250\n7.2, 70,\n")
    found = read(path)
    assert found.speeds.tolist() == [1.0, 2.0]
    assert found.restitutions.tolist() == [0.8, 0.7]
    assert found.durations[0] == 250e-6 and np.isnan(found.durations[1])


def test_whole_numbers_in_two_columns_are_no_decimal_commas(tmp_path):
    path = write(tmp_path, "drop_height [cm],rebound_height [cm]\n100,49\n50,18\n")
    assert read(path).restitutions == pytest.approx([0.7, 0.6], rel=1e-12)


def test_a_rebound_above_its_drop_is_named_by_its_line(tmp_path, refusal):
    path = write(tmp_path, "drop_height [cm],rebound_height [cm]\n100,49\n50,60\n")
    with refusal(ModelError, "line 3: the rebound height of 0.6 m is above the drop height"):
        read(path)


def test_a_list_of_intervals_needs_no_heading(tmp_path):
    path = write(tmp_path, "0.8\n0.4\n0.2\n")
    assert read(path, intervals=True).restitutions.tolist() == [0.5, 0.5]
    times = write(tmp_path, "time [ms]\n-100\n700\n1100\n1300\n", "times.csv")
    np.testing.assert_allclose(read(times).restitutions, 0.5, rtol=1e-12)


def test_recordings_are_read_apart(tmp_path):
    head = "# resolution: 1 ms\n"
    one = "0.8\n0.4\n0.2\n"
    other = "0.9\n0.3\n"
    both = "recording,interval [s]\n7,0.8\n7,0.4\n7,0.2\n1,0.9\n1,0.3\n"
    parts = [read(write(tmp_path, head + text), intervals=True) for text in (one, other)]
    found = read(write(tmp_path, head + both))
    for name in ("speeds", "restitutions"):
        wanted = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_array_equal(getattr(found, name), wanted)
    # Errors within a recording are correlated, those of two recordings are not.
    np.testing.assert_array_equal(found.uncertainties[:2, :2], parts[0].uncertainties)
    assert found.uncertainties[0, 1] < 0
    assert np.all(found.uncertainties[:2, 2] == 0)
    times = "recording,time [s]\n7,5.0\n7,5.8\n7,6.2\n1,0\n1,0.9\n1,1.2\n"
    apart = read(write(tmp_path, times))
    np.testing.assert_allclose(apart.restitutions, [0.5, 1 / 3], rtol=1e-12)


def test_a_golf_ball_that_was_heard_loses_a_tenth_of_its_speed():
    golf = experiment("golf_ball")
    assert golf.speeds.size == 5 * 7 and golf.uncertainties is None
    # The first fall has 845.25 and 759.90 ms. By the series of T and v in s = u/w, e is the ratio
    # of the intervals times 1 + (s₁² + s₂²)/4, s = gT/(2w) and w² = gℓ, up to terms in s⁴.
    intervals = np.array([0.84525, 0.75990])
    first = golf.heard.ratios[0]
    assert first == pytest.approx(intervals[1] / intervals[0], rel=1e-5)
    length = 2 * 0.0415 / (1.2 * 0.47 * np.pi * 0.042**2 / 4)
    squares = STANDARD_GRAVITY * intervals**2 / (4 * length)
    assert golf.restitutions[0] / first - 1 == pytest.approx(squares.sum() / 4, rel=0.01)


@pytest.mark.parametrize(("name", "density"), [("membrane_heavy", 7930), ("membrane_light", 3250)])
def test_the_balls_on_a_membrane_have_the_mass_of_their_density(name, density):
    found = experiment(name)
    assert found.mass == pytest.approx(density * np.pi / 6 * found.diameter**3, rel=1e-3)
    assert found.durations.shape == found.duration_uncertainties.shape == found.speeds.shape


def test_options_stand_in_place_of_the_head(tmp_path):
    path = write(tmp_path, "# mass: 10 g\n# resolution: 1 ms\ninterval [s]\n0.8\n0.4\n0.2\n")
    found = read(path, mass="20 g", contact_time="1 ms")
    assert found.mass == 0.02 and found.durations == 1e-3
    assert found.uncertainties.shape == (2, 2)


HEAD = "speed [m/s],restitution\n"
HOSTILE = {
    "": "no line with the names of the columns",
    HEAD: "no line of numbers",
    "recording,interval\n1,0.8\n1,0.4\n2,0.7\n": "recording 2 has fewer than two intervals",
    "recording,interval\nA,0.8\nA,0.4\n": "line 2: recording = 'A' does not begin with a number",
    "recording,speed\n1,0.8\n": "line 1: the columns must be",
    "speed,drop_height\n1,0.8\n": "line 1: the columns must be",
    "interval,time\n0.8,0\n": "there are fewer than two intervals",
    "interval,time,time\n0.8,0,0\n": "line 1: the columns must be",
    "v_in,v_out\n1,1.1\n": "line 2: the rebound speed of 1.1 m/s is above the speed of 1 m/s",
    "Note (a\nspeed,restitution\n": "no line of numbers",
    "time\n0\n0.02\n0.04\n0.06\n": "the times are equally spaced, as those of a film",
    "interval\n0\n0.4\n0.2\n": "line 2: interval = 0 is not",
    "No.,interval\n1,0\n2,0.4\n3,0\n": "line 4: interval = 0 is not",
    "interval,uncertainty\n0.8,0.1\n": "line 1: intervals and times have no column uncertainty",
    "time,duration\n0.8,0.1\n": "line 1: intervals and times have no column duration",
    "speed,restitution,duration_uncertainty\n1,0.8,0.1\n": "needs a column duration",
    "# resolution: 1 ms\n" + HEAD + "1,0.8\n": "a resolution needs intervals or times",
    "# contact time uncertainty: 1 ms\n" + HEAD + "1,0.8\n": "needs the contact time",
    "interval\n0,8\n": "there are fewer than two intervals",
    "interval\n0,8\n0.4\n": "line 2: 2 values for one column",
    HEAD + "1.0,nan\n": "line 2: restitution = 'nan' does not begin with a number",
    HEAD + "1.0,1.2\n": "line 2: restitution = 1.2 is not a number in (0, 1]",
    HEAD + "1.0,85\n": "line 2: restitution = 85 is not a number in (0, 1]",
    HEAD + "1.0,0.8,0.1\n": "line 2: 3 values for 2 columns",
    HEAD + "1.0\n": "line 2: 1 values for 2 columns",
    HEAD + "0,50,0,857\n": "line 2: 4 values for 2 columns; numbers have a decimal point",
    HEAD + '"0,50","0,857"\n': "line 2: speed = 0,50 has a comma: write '0.50'",
    "0.8\n0.4\n": "line 1: numbers without a heading: is it a file of intervals",
    "# a remark\ninterval\n0.5\n0.3\n0.4\n": "line 5, recording 1: 0.4 s after 0.3 s, where each",
    "recording,interval\n1,0.5\n1,0.3\n2,0.4\n2,0.6\n": "line 5, recording 2: 0.6 s after 0.4 s",
    HEAD + "1.0,\n": "line 2: restitution = ",
    HEAD + "-1.0,0.8\n1.0,0.8\n": "line 2: speed = -1",
    HEAD + "1 m/s,0.8 m\n": "line 2: restitution = 0.8 m",
    "speed [kg],restitution\n1,0.8\n": "line 1: speed = 1 kg is in",
    "speed,velocity\n1,0.8\n": "line 1: the columns must be drop_height and rebound_height; or",
    "Drops\nspeed,velocity\n1,0.8\n": "line 2: the columns must be",
    "velocity,e,#\n1,0.8,2\n": "each of them once; not known: 'velocity'",
    "speed,restitution,note\n1\n": "line 2: 1 values for 3 columns",
    "speed,restitution,note\n0,50,0,857\n": "line 2: 4 values for 3 columns",
    "speed,restitution,e\n1,0.8,0.8\n": "line 1: the columns must be",
    "speed,speed\n1,0.8\n": "line 1: the columns must be",
    "speed\n1\n": "line 1: the columns must be drop_height and rebound_height",
    "# masss: 3 g\n" + HEAD: "line 1: unknown key 'masss'; did you mean mass?",
    "# mass: 3 s\n" + HEAD: "line 1: mass = 3 s is in second, not in kg",
}


WRITTEN = {
    "a telephone's event times": '"Event","Event time (s)"\n1,0.0\n2,0.8\n3,1.2\n4,1.4\n',
    "tabs and decimal commas": "Event\tInterval (s)\n1\t0,8\n2\t0,4\n3\t0,2\n",
    "semicolons and a mark at the end": "Interval (ms);\n800,0;\n400;\n200,0;\n",
    "capitals and units in parentheses": "INTERVAL (ms)\n800\n400\n200\n",
    "decimal commas alone": "0,8\n0,4\n0,2\n",
    "bare numbers": "0.8\n0.4\n0.2\n",
    "quotation marks": '"Time interval (s)"\n"0.8"\n"0.4"\n"0.2"\n',
}


@pytest.mark.parametrize("name", WRITTEN)
def test_files_of_instruments_are_read(tmp_path, name):
    found = read(write(tmp_path, WRITTEN[name]), intervals=True)
    assert found.restitutions == pytest.approx([0.5, 0.5], rel=1e-12)
    assert found.heard.speeds == pytest.approx([9.80665 * 0.4, 9.80665 * 0.2], rel=1e-12)


def test_heights_of_a_spreadsheet_are_read(tmp_path):
    text = "No.;Drop height (cm);Rebound height (cm)\n1;100,0;25,0\n2;50;12,5\n"
    assert read(write(tmp_path, text)).restitutions == pytest.approx([0.5, 0.5], rel=1e-12)


# A column is left out if another one says what the file is; what only counts needs no note.
PASSED_OVER = {
    "No.;Drop height (cm);Rebound height (cm);Remark\n1;100,0;25,0;a, b\n2;50;12,5\n": ["'Remark'"],
    "drop_height [cm],rebound_height [cm],e,Speed\n100,25,0.5,4.43\n100,25,0.5,x\n": [
        "'e', 'Speed', because 'drop_height [cm]' is read"
    ],
    "recording,speed,restitution\n1,1,0.5\n1,2,0.5\n": ["'recording'"],
    "Ball 3, on stone\nNr.\tv_in\tv_out\n1\t2,0\t1,0\n2\t3,0\t1,5\n": ["line 1 above the heading"],
    "# Logger v2.1 2026-11-25T10:00\n# Date: today\nspeed before,speed after\n2,1\n4,2\n": [],
    "rebound_speed (cm/s),impact speed (m/s),Temperature (C)\n100,2,20\n200,4,\n": [
        "'Temperature (C)'"
    ],
    "v,e\n1,0.5\n2,0.5\n": [],
}


@pytest.mark.parametrize("text", PASSED_OVER, ids=range(len(PASSED_OVER)))
def test_what_is_not_known_is_left_out_with_a_note(tmp_path, text):
    found = read(write(tmp_path, text))
    assert found.restitutions == pytest.approx([0.5, 0.5], rel=1e-12)
    assert len(found.notes) == len(PASSED_OVER[text])
    for note, part in zip(found.notes, PASSED_OVER[text], strict=True):
        assert note.startswith("Left out: ") and part in note


@pytest.mark.parametrize("sign", ["-", "\N{MINUS SIGN}"])
def test_velocities_that_are_all_negative_are_speeds_with_a_note(tmp_path, refusal, sign):
    file = tmp_path / "a.csv"
    file.write_text(f"v_in,v_out\n{sign}2,1.6\n{sign}4,3\n", encoding="utf-8")
    found = read(file)
    plain = tmp_path / "b.csv"
    plain.write_text("v_in,v_out\n2,1.6\n4,3\n", encoding="utf-8")
    assert found.speeds.tolist() == read(plain).speeds.tolist() == [2.0, 4.0]
    assert found.restitutions.tolist() == [0.8, 0.75]
    (note,) = found.notes
    assert note == "The velocities 'v_in' are all negative: their sizes are the speeds."
    # The axis may point down instead.
    file.write_text(f"v_in,v_out\n2,{sign}1.6\n4,{sign}3\n", encoding="utf-8")
    assert read(file).restitutions.tolist() == [0.8, 0.75]
    # If one of them has another sign, it is a mistake.
    file.write_text("v_in,v_out\n-2,1.6\n4,3\n", encoding="utf-8")
    with refusal(ModelError, "line 2: speed = -2 is not a number in"):
        read(file)


@pytest.mark.parametrize(
    ("heading", "unit"),
    [
        ("interval_ms", 1e-3),
        ("Interval ms", 1e-3),
        ("interval_s", 1.0),
        ("t_us", 1e-6),
        ("t_ms", 1e-3),
    ],
)
def test_a_unit_may_stand_behind_a_heading_without_brackets(tmp_path, heading, unit):
    intervals = np.array([0.6, 0.54, 0.486])
    heard = np.cumsum([0.0, *intervals]) if heading.startswith("t") else intervals
    text = "\n".join([heading, *(f"{x / unit:.12g}" for x in heard)])
    file = tmp_path / "a.csv"
    file.write_text(text, encoding="utf-8")
    assert read(file).restitutions == pytest.approx([0.9, 0.9], rel=1e-9)


def test_speeds_with_a_unit_behind_the_heading(tmp_path, refusal):
    file = tmp_path / "a.csv"
    file.write_text("v_in cm/s,v_out_cm/s\n200,160\n", encoding="utf-8")
    assert read(file).speeds.tolist() == [2.0]
    # A word that is no unit of the column makes it another column.
    file.write_text("v_in,v_out_left\n2,1\n", encoding="utf-8")
    with refusal(ModelError, "not known: 'v_out_left'"):
        read(file)


def test_speeds_before_and_after_are_a_restitution(tmp_path):
    text = "v_in [cm/s],v_out [cm/s],uncertainty\n200,160,0.01\n400,300,0.02\n"
    found = read(write(tmp_path, text))
    assert found.speeds == pytest.approx([2.0, 4.0], rel=1e-12)
    assert found.restitutions == pytest.approx([0.8, 0.75], rel=1e-12)
    assert found.uncertainties.tolist() == [0.01, 0.02] and found.relative_errors is None
    # No flight is computed, on which the drag would act.
    assert not found.is_of_flights


BOTH = '"No.","Event time (s)","Interval (s)"\n1,3.0,0\n2,3.8,0.8\n3,4.2,0.4\n4,4.4,0.2\n'
PHYPHOX = '"Number of interval","Interval (s)","Retained energy (%)"\n1,0.8,\n2,0.4,25\n3,0.2,25\n'


@pytest.mark.parametrize(
    "text",
    [BOTH, BOTH.replace(",0\n", ",\n"), PHYPHOX],
    ids=["a first interval of 0", "none", "numbers of intervals"],
)
@pytest.mark.parametrize("intervals", [True, False])
def test_times_and_intervals_are_read_as_asked_and_it_is_said(tmp_path, text, intervals):
    found = read(write(tmp_path, text), intervals=intervals)
    assert found.restitutions == pytest.approx([0.5, 0.5], rel=1e-12)
    if text is PHYPHOX:
        assert found.notes == ("Left out: column 'Retained energy (%)'.",)
    elif intervals:
        assert found.notes == (
            "Left out: column 'Event time (s)', because 'Interval (s)' is read.",
            "Line 2 is the first impact, before which there is no interval.",
        )
    else:
        assert found.notes == (
            "Left out: column 'Interval (s)', because 'Event time (s)' is read.",
        )


def test_each_recording_may_begin_with_an_impact_without_an_interval(tmp_path):
    text = "recording,No.,interval\n1,1,0\n1,2,0.8\n1,3,0.4\n2,1,0.0\n2,2,0.4\n2,3,0.2\n"
    found = read(write(tmp_path, text))
    assert found.restitutions == pytest.approx([0.5, 0.5], rel=1e-12)
    assert [note[:6] for note in found.notes] == ["Line 2", "Line 5"]


def test_a_line_that_is_left_out_may_have_anything(tmp_path):
    text = "speed,restitution\n1,0.5\n-,no ball\n2,0.5\n"
    assert read(write(tmp_path, text), leave_out=[3]).speeds.tolist() == [1.0, 2.0]
    text = "interval\n0.8\n0.4\nmissed\n0.1\n0.05\n"
    found = read(write(tmp_path, text), leave_out=[4])
    assert found.restitutions == pytest.approx([0.5, 0.5], rel=1e-12)


def test_a_bad_bounce_is_left_out_with_the_impacts_beside_it(tmp_path, refusal):
    path = write(tmp_path, "interval\n0.8\n0.4\n0.5\n0.1\n0.05\n0.02\n")
    with refusal(ModelError, "line 4, recording 1: 0.5 s after 0.4 s"):
        read(path)
    found = read(path, leave_out=[4])
    assert found.restitutions == pytest.approx([0.5, 0.5, 0.4], rel=1e-12)
    assert found.left_out == (4,)
    # Between times, no flight has both ends.
    path = write(tmp_path, "time\n0\n0.8\n1.2\n1.25\n1.4\n1.5\n1.55\n")
    assert read(path, leave_out=[5]).restitutions == pytest.approx([0.5, 0.5], rel=1e-12)
    with refusal(ModelError, "has no line 40 with numbers to leave out"):
        read(path, leave_out=[40])
    heights = write(tmp_path, "drop_height,rebound_height\n1,0.25\n1,0.9\n")
    assert read(heights, leave_out=[3]).restitutions == pytest.approx([0.5], rel=1e-12)


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_files_get_one_line(tmp_path, refusal, text):
    path = write(tmp_path, text)
    with refusal(ModelError, HOSTILE[text]):
        read(path)


@pytest.mark.parametrize(
    "text",
    ["interval\n0.8\n0.9\n", "time\n0\n1\n0.5\n", "drop_height,rebound_height\n1,2\n"],
)
def test_numbers_that_no_ball_has_are_those_of_a_file(tmp_path, refusal, text):
    path = write(tmp_path, text)
    with refusal(ModelError, str(path)):
        read(path)


# Numbers that are right in another unit, which the message names.
IN_ANOTHER_UNIT = {
    "775\n607\n489\n": (
        "line 1: a flight of 775 s is 736265 m high: are these ms?",
        "interval (ms)",
    ),
    "time [s]\n0\n775\n1382\n": ("line 3: a flight of 775 s", "'time (ms)'"),
    "interval\n9.1\n4\n2\n": ("line 2: a flight of 9.1 s is 102 m high", "leave the line out by"),
    "drop_height,rebound_height\n100,60\n": (
        "line 2: a height of 100 m: are these cm?",
        "'drop_height (cm)'",
    ),
    "drop_height [m],rebound_height [m]\n50,20\n101,40\n": ("line 3: a height of 101 m", "(cm)"),
    HEAD + "443,0.8\n": ("line 2: a speed of 443 m/s: are these cm/s?", "'speed (cm/s)'"),
    "v_in,v_out\n443,350\n": ("line 2: a speed of 443 m/s: are these cm/s?", "'speed (cm/s)'"),
}


@pytest.mark.parametrize("text", IN_ANOTHER_UNIT, ids=range(len(IN_ANOTHER_UNIT)))
def test_numbers_in_another_unit_are_refused_with_the_unit_that_was_meant(tmp_path, refusal, text):
    is_heard = text[0].isdecimal() or "interval" in text or "time" in text
    with refusal(ModelError, *IN_ANOTHER_UNIT[text]):
        read(write(tmp_path, text), intervals=is_heard)


def test_numbers_within_the_bounds_are_read(tmp_path):
    high = "drop_height [m],rebound_height [m]\n50,20\n99,40\n"
    assert read(write(tmp_path, high)).speeds.size == 2
    with_unit = "interval (ms)\n775\n607\n489\n"
    assert read(write(tmp_path, with_unit)).speeds[0] == pytest.approx(9.80665 * 0.775 / 2)
    assert read(write(tmp_path, HEAD + "99,0.5\n")).speeds.size == 1
    # A clap before the ball is left out with its line.
    clap = "time\n-20\n0\n0.8\n1.2\n"
    assert read(write(tmp_path, clap), leave_out=[2]).restitutions == pytest.approx([0.5])


def test_the_uncertainty_of_a_contact_time_may_belong_to_a_column(tmp_path):
    head = "# contact time uncertainty: 0.1 ms\nspeed,restitution,duration [ms]\n"
    assert read(write(tmp_path, head + "1,0.8,1\n")).duration_uncertainties == 1e-4


def test_files_that_are_none_get_one_line(tmp_path, refusal):
    with refusal(ModelError, "cannot be read", "No such file"):
        read(tmp_path / "none.csv")
    path = tmp_path / "picture.csv"
    path.write_bytes(b"\xff\xfe\x00\x01")
    with refusal(ModelError, "it is not a text in UTF-8"):
        read(path)
    with refusal(ModelError, "no column interval or time"):
        read(DATA / "croquet.csv", intervals=True)
    with refusal(ModelError, "unknown experiment 'none': one of"):
        experiment("none")
