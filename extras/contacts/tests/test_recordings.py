"""Tables as they are read, and those that are refused with the name of a column."""

import math
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball_contacts import Refused, fit, tables
from bouncing_ball_contacts.recordings import read
from bouncing_ball_contacts.tables import experiments
from bouncing_ball_contacts.tracks import copies

FLIGHTS = 0.9 * 0.82 ** np.arange(6)
TIMES = 0.3 + np.concatenate([[0.0], np.cumsum(FLIGHTS)])
G = 9.80665
# Between two touches are the contact, here of 8 ms, and the flight.
CONTACT = 0.008
TOUCHES = 0.3 + np.concatenate([[0.0], np.cumsum(FLIGHTS + CONTACT)])
FRAMES = np.arange(0, TIMES[-1] - 0.05, 1 / 60)
DROPS = (50, 75, 100, 125)
SPEEDS = (1.0, 2.0, 3.0, 4.0)


def column(values, form="{:.6f}"):
    return "\n".join(form.format(value) for value in values)


def position(t):
    """Return the height of a ball that falls, and bounces at TIMES."""
    if t < TIMES[0]:
        half = FLIGHTS[0] / 0.82 / 2
        return G / 2 * (half**2 - (t - TIMES[0] + half) ** 2)
    i = min(int(np.searchsorted(TIMES, t, side="right")) - 1, len(FLIGHTS) - 1)
    return G / 2 * (t - TIMES[i]) * (TIMES[i] + FLIGHTS[i] - t)


def track(form="{:.4f},{:.5f}", slow=1, shown=lambda y: y):
    return "\n".join(form.format(slow * t, shown(position(t))) for t in FRAMES)


def pairs(form="{},{}", ratio=0.6724):
    return "\n".join(form.format(h, h * ratio) for h in DROPS)


FILES = {
    "times": "time [s]\n" + column(TIMES),
    "intervals with a unit behind": "interval_ms\n" + column(1000 * FLIGHTS),
    "short intervals": "interval_ms\n" + column(3 * FLIGHTS),
    "semicolons and decimal commas": "Nr;Interval (s)\n"
    + "\n".join(f"{i};{x:.6f}".replace(".", ",") for i, x in enumerate(FLIGHTS)),
    "one column with decimal commas": "Interval (s)\n" + column(FLIGHTS).replace(".", ","),
    "events with their intervals": '"Event number","Interval (s)","Time (s)"\n'
    + "\n".join(
        f"{i},{a:.9E},{b:.9E}" for i, a, b in zip(range(6), FLIGHTS, TIMES[1:], strict=True)
    ),
    "a stopwatch with times of events": "Event time (s),Interval (s)\n"
    + "\n".join(f"{b},{a}" for a, b in zip(FLIGHTS, TIMES[1:], strict=True)),
    "tops": '"Height (cm)"\n' + column(100 * G / 8 * FLIGHTS**2),
    "a title and a remark": "Lab 3\n\nDrop height (cm),Rebound height (cm),Remark\n"
    + pairs("{},{},ok"),
    "units behind a slash": "drop/cm,rebound/cm\n" + pairs(),
    "speeds": "v_in (m/s),v_out (m/s),COR\n" + "\n".join(f"{-v},{v * 0.82},0.82" for v in SPEEDS),
    "speed, COR and its error": "impact velocity,COR,std\n"
    + "\n".join(f"{v},0.82,0.01" for v in SPEEDS),
    "coefficients in per cent": "speed (m/s),COR (%)\n" + "\n".join(f"{v},82" for v in SPEEDS),
    "recordings": "recording,interval [s]\n"
    + "\n".join(f"{i},{x}" for i in (1, 2) for x in FLIGHTS),
    "Tracker, rounded times": "mass_A\nt\tx\ty\n" + track("{:.2f}\t0.001\t{:.5f}"),
    "heard, with a contact time": "# contact time: 8 ms\ntime [s]\n" + column(TOUCHES),
    "picture, y negative": "t,y\n" + track(shown=lambda y: -y),
    "picture, pixels": "t (s),y (px)\n" + track(shown=lambda y: round(900 - 700 * y)),
    "track, time and height": "time (s),height (m)\n" + track(),
    "one line of heights": "h0 (cm),h1 (cm),h2 (cm),h3 (cm)\n100,67.24,45.21,30.4",
    "two lines of heights": "h0 (cm),h1 (cm),h2 (cm),h3 (cm)\n100,67.24,45.21,30.4\n80,53.8,36.2,",
    "one line of heights, the last one missing": "h0 (m),h1 (m),h2 (m),h3 (m)\n1,0.6724,0.4521,",
    "trials": "drop height (cm),trial 1 (cm),trial 2 (cm)\n" + pairs("{0},{1},{1}"),
    "a text with a comma": "note,drop (cm),rebound (cm)\n" + pairs('"ball, old",{},{}'),
    "drops and bounces": "drop height (cm),bounce height (cm)\n" + pairs(),
    "h and h', in inches": "h (inches),h′ (inches)\n" + pairs(),
    "drops and bounces, the unit in words": "Drop Height in cm,Bounce Height in cm\n" + pairs(),
    "numbers of trials": "trial,drop height (cm),bounce height (cm)\n"
    + "\n".join(f"{i},{h},{h * 0.6724}" for i, h in enumerate(DROPS, 1)),
    "trials and their average": "drop (cm),trial 1 (cm),trial 2 (cm),average (cm)\n"
    + pairs("{0},{1},{1},{1}"),
    "averages alone": "drop (cm),average (cm)\n" + pairs(),
    "trials of intervals": "trial,interval [s]\n"
    + "\n".join(f"{i},{x}" for i in (1, 2) for x in FLIGHTS),
    "times since 1970": "time\n" + column(TIMES + 1717171717.1),
    "nanoseconds since 1970": "time (ns)\n" + column(1e9 * (TIMES + 1717171717.1), "{:.0f}"),
    "a track since 1970": "t,y\n"
    + "\n".join(f"{t + 1717171717:.4f},{position(t):.5f}" for t in FRAMES),
    "frames of a film": "# frame rate: 240 Hz\nframe\n" + column(np.round(240 * TIMES), "{:.0f}"),
    "a track by frames": "# frame rate: 60\nframe,y\n"
    + "\n".join(f"{60 * t:.0f},{position(t):.5f}" for t in FRAMES),
    # What instruments write, with their headings.
    "phyphox, acoustic stopwatch, multiple": "Start (s),Stop 1 (s),Stop 2 (s),Stop 3 (s)\n"
    + ",".join(f"{t:.9E}" for t in TIMES[:4]),
    "phyphox, acoustic stopwatch, all": '"Event time (s)","Interval (s)"\n'
    + "\n".join(f"{t:.9E},{x:.9E}" for t, x in zip(TIMES, [*FLIGHTS, 0.0], strict=True)),
    "phyphox, (in)elastic collision": ",".join(
        [
            "Bounce 0 (s),Height 0 (m)",
            *(f"Bounce {i} (s),Height {i} (m),Energy {i}" for i in (1, 2, 3)),
        ]
    )
    + f"\n{TIMES[0]},1.2,{TIMES[1]},.9,.67,{TIMES[2]},.6,.67,{TIMES[3]},.4,.67",
    "Logger Pro, the latest run": "Latest: Time (s),Latest: Position (m),Latest: Velocity (m/s)\n"
    + track("{:.4f},{:.5f},0"),
    "Logger Pro, a film": '"VideoAnalysis: Time (s)","VideoAnalysis: X (m)","VideoAnalysis: Y (m)",'
    '"VideoAnalysis: Y Velocity (m/s)"\n' + track("{:.4f},0.31,{:.5f},0.2"),
    "Logger Pro, two films in pixels": "VideoAnalysis: Time (s),VideoAnalysis: Y (pixels),"
    "VideoAnalysis 2: Time (s),VideoAnalysis 2: Y (pixels)\n"
    + track("{0:.4f},{1:.2f},{0:.4f},{1:.2f}", shown=lambda y: 100 + 700 * y),
    "Logger Pro, a data set with a name": "Second drop: Time (s),Second drop: Y (m)\n" + track(),
    "Graphical Analysis, a data set": "Data Set 1:Time(s),Data Set 1:Position(m),"
    "Data Set 1:Velocity(m/s),Data Set 1:Acceleration(m/s²)\n" + track("{:.4f},{:.5f},0,0"),
    "Logger Pro, a run": "Run 1: Time (s),Run 1: Position (m),Run 1: Velocity (m/s),"
    "Run 1: Acceleration (m/s^2)\n" + track("{:.6f},{:.6f},0,0"),
    "Capstone": '"Time (s) Run #1";"Position (m) Run #1";"Velocity (m/s) Run #1"\n'
    + track("{:.4f};{:.5f};0").replace(".", ","),
    "Tracker 6": ",mass A,,,,,\nt,frame,x,y,pixelx,pixely,\n"
    + track("{:.9E},7,1.2E-3,{:.9E},400.1,300.2,"),
    "Tracker 5, no velocity at the ends": "mass_A\nt\tx\ty\tv_{x}\tv_{y}\n-1.6E-2\t0\t\t\t\n"
    + track("{:.9E}\t1.2E-3\t{:.9E}\t0\t1"),
    "Arduino, distance below a sensor": "millis,distance_cm\n"
    + track("{:.1f},{:.3f}", slow=1000, shown=lambda y: 200 - 100 * y),
    "Arduino, sketch of a distance sensor": "Time,Distance,Filtered\n"
    + track("{:.4f},{:.1f},1000", shown=lambda y: 1500 - 700 * y),
    "Arduino, monitor with its clock": "9:30:1.123 -> Live readings:\n"
    "9:30:1.123 -> Time (ms), Distance (cm)\n"
    + track("10:30:01.123 -> {:.1f}, {:.3f}", slow=1000, shown=lambda y: 200 - 100 * y),
    "Audacity, labels": "\n".join(f"{t:.6f}\t{t:.6f}\t{i}" for i, t in enumerate(TIMES)),
    "Audacity, labels of regions with frequencies": "\n".join(
        f"{t:.6f}\t{t + 0.02:.6f}\t\n\\\t100.000000\t200.000000" for t in TIMES
    ),
    "phyphox, acoustic stopwatch, intervals alone": '"Interval (s)"\n' + column([*FLIGHTS, 0]),
    "computed columns": "Time (s),Δt (s),Height ratio\n"
    + "\n".join(f"{t},{x},0.6724" for t, x in zip(TIMES[1:], FLIGHTS, strict=True)),
    "films below each other": "t,y\n" + track() + "\n\n" + track(),
    "films by a column": "run,t,y\n"
    + "\n".join(f"{i},{line}" for i in (1, 2) for line in track().split("\n")),
    "frames at 60 fps": "# frame rate: 60 fps\nframe\n" + column(60 * TIMES, "{:.3f}"),
    # As people write them.
    "stops that did not happen": "Start (s),Stop 1 (s),Stop 2 (s),Stop 3 (s),Stop 4 (s)\n"
    + ",".join(f"{t:.6f}" for t in TIMES[:5])
    + "\n"
    + ",".join(f"{t:.6f}" for t in TIMES[:3])
    + ",0.0,0.0",
    "one fall a row, from its release": "H,T0,T1,T2\n"
    + "\n".join(
        f"{h},{','.join(f'{k * t:.6f}' for t in TIMES[:3])}" for h, k in ((1, 1), (2, 1.2))
    ),
    "one fall a row, times between touches": "H (cm),T0 (ms),T1 (ms),T2 (ms)\n"
    + "\n".join(
        f"{h},{','.join(f'{1000 * k * t:.4f}' for t in FLIGHTS[:3])}" for h, k in ((1, 1), (2, 1.2))
    ),
    "trials without a unit": "drop height (cm),trial 1,trial 2\n" + pairs("{0},{1},{1}"),
    "a rebound without a unit": "drop height (cm),rebound height\n" + pairs(),
    "runs side by side without a name": "time (s),time (s)\n"
    + "\n".join(f"{t:.6f},{1.1 * t:.6f}" for t in TIMES),
    "films side by side without a name": "t,y,t,y\n" + track("{0:.4f},{1:.5f},{0:.4f},{1:.5f}"),
    "drops side by side without a name": "drop (cm),rebound (cm),drop (cm),rebound (cm)\n"
    + pairs("{0},{1},{0},{1}"),
    "a table in capitals": "DROP HEIGHT (CM)\tTEST 1\tTEST 2\tAVERAGE\n"
    + pairs("{0}\t{1}\t{1}\t9"),
    "a unit in each cell": "Drop,Rebound\n" + pairs("{} Centimeters,{} cm"),
    "several units in a column": "Drop,Return height\n1 m,67.24 cm\n2 m,1344.8 mm\n3 m,2.0172 m",
    "fractions of an inch": "drop (in),rebound\n46 1/2,31.27\n6' 8\",53.79\n1 ft,8.07",
    "errors behind the readings": "drop (cm),rebound (cm)\n" + pairs("{} ± 0.5,{} ± 0.5"),
    "a clock": "time,y (m)\n" + track("00:00:0{:.4f},{:.5f}"),
    "runs with columns that are not read": "Time (s),X (m),Y (m),Time (s),X (m),Y (m)\n"
    + track("{0:.4f},3,{1:.5f},{0:.4f},4,{1:.5f}"),
    "numbers and their unit": "100 67.24 45.21 30.4 cm\n",
    # Columns divided by spaces or pipes, a row of units, and tables of ImageJ.
    "spaces": "t  y (m)\n" + track("{:.4f} {:.5f}"),
    "two spaces between names": "drop height (cm)  rebound height (cm)\n" + pairs("{} {}"),
    "pipes": "drop (cm)|rebound (cm)\n" + pairs("{}|{}"),
    "Markdown": "| drop (cm) | rebound (cm) |\n|---|---:|\n" + pairs("| {} | {} |"),
    "a row of units": "drop,rebound\n(cm),(cm)\n" + pairs(),
    "ImageJ, tracks": "# frame rate: 60\nFrame,X1,Y1,Flag1,X2,Y2,Flag2\nTracks 1 to 2\n"
    + track("{:.0f},3,{:.4f}, ,5,7,*", slow=60, shown=lambda y: 900 - 700 * y)
    + "\n\nTrack ,Length,Distance traveled,Nr of Frames\n1,219.7,117.9,191",
    "ImageJ, slices": "# frame rate: 60\n ,Area,XM,YM,Slice\n"
    + track("1,57,4,{1:.3f},{0:.0f}", slow=60, shown=lambda y: 900 - 700 * y),
    "bounces with a unit of length": "bounce (cm)\n100\n67.24\n45.21",
    "a count with a gap": "n,interval (s)\n"
    + "\n".join(f"{i},{x}" for i, x in enumerate(FLIGHTS) if i != 3),
}


@pytest.mark.parametrize("name", FILES)
def test_files_are_read_as_they_are(name, tmp_path):
    path = tmp_path / "recording.csv"
    # Spreadsheets write capitals as well as UTF-16.
    path.write_text(FILES[name], "utf-16" if "capitals" in name else "utf-8")
    fitted = fit(path)
    assert fitted.restitution == pytest.approx(0.82, abs=3e-3)
    low, high = fitted.interval
    assert low - 1e-6 <= 0.82 <= high + 1e-6


TITLES = """mass A,ball,body,sample,run 1,frame,time,height,position,drop,trial 1,bounce,rebound,
t,y,h,series,group,note,speed,golf ball,Messung 3"""


@pytest.mark.parametrize("head", ["{}\t\t\t\nt\tx\ty\n", "\n{}\n\nt\tx\ty\ns\tm\tm\n"])
def test_a_line_above_the_headings_is_a_title(head, tmp_path):
    """Of 23 names of a mass 20 were taken as headings."""
    path = tmp_path / "tracker.txt"
    for title in TITLES.replace("\n", "").split(","):
        path.write_text(head.format(title) + track("{:.4f}\t3\t{:.5f}"))
        assert fit(path).restitution == pytest.approx(0.82, abs=1e-3), title


def test_columns_are_named_where_no_synonym_is_known(tmp_path, typed):
    path = tmp_path / "messung.csv"
    numbers = track("{:.4f};{:.5f};0").replace(".", ",")
    path.write_text("Messung vom 3. Mai\nZeit in s;Ort in m;Tempo\n" + numbers)
    with pytest.raises(Refused, match="'Ort' is not known, 'Tempo' .* --columns 'NAME=t"):
        fit(path)
    fitted = fit(path, columns={"Zeit in s": "t (s)", "2": "y (m)"})
    assert fitted.restitution == pytest.approx(0.82, abs=1e-3)
    said = fitted.result.split(": ")[1]
    assert said in typed(f"fit {path} --columns 'zeit in s=t (s)' --columns '2=y (m)'")[1]
    with pytest.raises(Refused, match="no column 'Weg': its columns are Zeit in s, Ort in m, T"):
        fit(path, columns={"Weg": "y"})
    with pytest.raises(Refused, match="'Ort' is not known"):
        fit(path, columns={"2": "Ort"})
    with pytest.raises(Refused, match="'Zeit' is not read, 'y' is position, 'Tempo' is not"):
        fit(path, columns={"2": "y (m)"})
    with pytest.raises(Refused, match="are those of samples .Ort, Tempo."):
        fit(path, columns={"1": "t (s)"})
    path.write_text(numbers)
    assert fit(path, columns={"1": "t (s)", "2": "y (m)"}).result.endswith(said)


# Headings in several lines, names that no list has, and a position in millimetres or pixels.
OTHERS = {
    "Vicon": (
        "# frame rate: 60\nTrajectories\n60\n,,ball,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n"
        + track("{0:.3f},0,12,3,{1:.3f}", slow=60, shown=lambda y: 1000 * y),
        {"Frame": "frame", "Z": "y (mm)"},
    ),
    "TrackMate": (
        "LABEL,QUALITY,POSITION_Y,POSITION_T\nLabel,Quality,Y,T\n,(quality),(micron),(sec)\n"
        + track("ID,4.5,{1:.3f},{0:.4f}", shown=lambda y: 900 - 700 * y),
        {"T": "t (s)", "Y": "y (px)"},
    ),
    "Raven": (
        "Selection\tView\tBegin Time (s)\tEnd Time (s)\n"
        + "\n".join(f"{i}\tSpectrogram 1\t{t:.4f}\t{t + 0.02:.4f}" for i, t in enumerate(TIMES)),
        {"Begin Time (s)": "time (s)"},
    ),
    "Motive": (
        "Format Version,1.23,Take Name,Take 1\n\n,,ball,ball,ball\n,,1A,1A,1A\n"
        "Frame,Time (Seconds),X,Y,Z\n" + track("7,{:.6f},0.1,{:.6f},0.2"),
        {"Time": "t (s)", "Y": "y (m)"},
    ),
}


@pytest.mark.parametrize("name", OTHERS)
def test_files_of_other_programs_are_read_by_their_columns(name, tmp_path):
    path = tmp_path / "other.csv"
    text, columns = OTHERS[name]
    path.write_text(text)
    with pytest.raises(Refused, match="--columns"):
        fit(path)
    assert fit(path, columns=columns).restitution == pytest.approx(0.82, abs=3e-3)


def test_an_archive_with_one_table_is_that_table(tmp_path):
    path = tmp_path / "phyphox.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Data.csv", FILES["phyphox, acoustic stopwatch, all"])
        archive.writestr("meta/device.csv", "property,value\nversion,1.1")
    assert fit(path).restitution == pytest.approx(0.82, abs=1e-3)
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("Raw.csv", FILES["times"])
    with pytest.raises(Refused, match="phyphox.zip has Data.csv, Raw.csv: unpack it"):
        fit(path)
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("[Content_Types].xml", "")
    with pytest.raises(Refused, match="is a spreadsheet"):
        fit(path)


BALLS = {
    "in rows": "ball,h0,h1,h2,h3\ntennis,1,.5329,.284,.1513\ngolf,1,.6724,.4521,.304\n",
    "in long form": "ball,drop (m),rebound (m)\ntennis,1,.5329\ntennis,2,1.0658\ntennis,3,1.5987\n"
    "golf,1,.6724\n,2,1.3448\n,3,2.0172\n",
    "in headings": "drop (m),rebound (m) (tennis),rebound (m) (golf)\n1,.5329,.6724\n"
    "2,1.0658,1.3448\n3,1.5987,2.0172\n",
    "before headings": "tennis: h (m),tennis: h' (m),golf: h (m),golf: h' (m)\n1,.5329,1,.6724\n"
    "2,1.0658,2,1.3448\n3,1.5987,3,2.0172\n",
    "in times": "ball,time (s)\ntennis,1\n,1.9\n,2.557\n,3.03661\ngolf,1\n,1.9\n,2.638\n,3.24316\n",
}


@pytest.mark.parametrize("name", BALLS)
def test_each_ball_has_its_own_r(name, tmp_path, typed):
    """They were pooled: tennis, golf and table tennis had one r of 0.8249."""
    path = tmp_path / "balls.csv"
    path.write_text(BALLS[name])
    restitutions = {ball: fit(recording).restitution for ball, recording in read(path).items()}
    assert restitutions == {
        "tennis": pytest.approx(0.73, abs=1e-3),
        "golf": pytest.approx(0.82, abs=1e-3),
    }
    assert fit(path, ball="golf").restitution == pytest.approx(0.82, abs=1e-3)
    assert fit(path, ball="Golf").restitution == fit(path, ball="golf").restitution
    with pytest.raises(Refused, match="has tennis, golf: name one, --ball"):
        fit(path)
    out = typed(f"fit {path}")[1]
    assert len(re.findall(r"^(tennis|golf)$", out, re.MULTILINE)) == 2
    assert out.count("! the drag of the air") <= 1 and out.count("! heights are") <= 1
    assert "r = 0.73" in typed(f"fit {path} --ball tennis")[1]
    assert "a contact is written for one, --ball" in typed(f"fit {path} --engine mujoco")[2]


def test_names_of_another_kind_are_asked_for(tmp_path):
    """Golf and tennis balls with 0.8 and 0.7 were given as 0.751 without a word."""
    surfaces = ["wood", "wood", "grass", "grass"]
    columns = {"drop (m)": [1, 2, 1, 2], "rebound (m)": [0.64, 1.28, 0.49, 0.98]}
    with pytest.raises(Refused, match="column 'surface' has grass, wood: name it 'ball' for one"):
        fit(columns | {"surface": surfaces})
    assert len(fit(columns | {"remark": surfaces}).impacts.speed) == 4
    grouped = fit(columns | {"group": surfaces})
    assert list(grouped.impacts.groups) == surfaces
    assert any("film or ball share an error" in note for note in grouped.notes)
    path = tmp_path / "rows.csv"
    path.write_text(BALLS["in rows"].replace("ball,", "type,"))
    with pytest.raises(Refused, match="column 'type' has golf, tennis: name it 'ball' for one"):
        fit(path)


# Straight up and down again, as no ball flies.
ZIGZAG = "\n".join(f"{i / 60:.4f},{1 - abs(i % 30 - 15) / 15 + 0.01:.4f}" for i in range(150))
TWO = "drop (cm),rebound (cm)\n50,32\n60,38\n70,45"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no line of numbers below a heading"),
        ("# title: nothing", "no line of numbers below a heading"),
        (
            "a,b\n1,2",
            "'a' is not known, 'b' is not known: write 'time .s.' over times of impacts, ",
        ),
        ("millis,distance_cm\n10,20", "too few lines of a track; tops"),
        ("Fallhöhe (m),Sprung (m)\n2,1", "'Fallhöhe' is not known, 'Sprung' is not known"),
        ("valhoogte (cm),stuithoogte (cm)\n2,1", "'valhoogte' is not known"),
        ("落下高さ (cm),跳ね返り (cm)\n2,1", "'落下高さ' is not known"),
        ("event_ms\n10\n20", "'event' is not known"),
        ("altura de queda (cm),altura\n2,1", "'altura de queda' is not known"),
        ("altura\n36 cm\n20 cm", "'altura' is not known"),
        ("drop (cm),rebound (%)\n10,20", "unit of column 'rebound': '%' in '1 %' does not fit"),
        (
            "drop,rebound\n36 in,20\n80,20 cm",
            "line 2: '36 in' below 'drop' is no number; a unit stands in .* as in drop .cm.",
        ),
        ("t,y\n0,1\n0.1,inf", "line 3: 'inf' below 'y' is no number"),
        ("v,COR\n1,1e300", "line 2: '1e300' below 'COR' is no number"),
        (
            "v,COR\n1,1e-300",
            "line 2: a restitution coefficient of 1e-300 below 'COR' is .* too small",
        ),
        ('drop (mm),rebound (mm)\n"1,000","640"', "'1,000' below 'drop' is .* thousands without"),
        ('t (s),y (m)\n"0,1","0,64"', "'0,1' below 't' is .* decimals with a point"),
        ("drop (mm);rebound (mm)\n1.234,5;640", "'1.234,5' below 'drop' is .* thousands without"),
        ("drop (mm),rebound (mm)\n1'234.5,640", "\"1'234.5\" below 'drop' is .* thousands without"),
        ("time\n2026-12-01T10:55:00.3\n", "'2026-12-01T10:55:00.3' below 'time' is .* in seconds"),
        ("time,y\n1.12.2026 10:55,3\n", "'1.12.2026 10:55' below 'time' is .* in seconds"),
        ("time\n36 in\n20", "'36 in' below 'time' is no number; a unit .* as in time .s."),
        ("drop,rebound\n~36,20", "'~36' below 'drop' is no number; correct it"),
        (
            "Latest: Time (s),Latest: Position (m),VideoAnalysis: Time (s),VideoAnalysis: Y (m)\n"
            + track("{0:.4f},{1:.5f},{0:.4f},{1:.5f}"),
            "Latest has Time .* and VideoAnalysis has .*: leave the same columns",
        ),
        ("1.9\n1.2\n0.9", "line 1: a table begins with headings: write 'time"),
        (
            "time,t\n0.9,0.72",
            "two columns are both time, 'time' and 't': .* same heading over runs",
        ),
        ("drop,rebound 1,rebound 2\n1,.6,.6", "write trial 1,trial 2 over repeated drops, h0,h1"),
        ("1.80 1.21 0.82", "are no heights or times with one unit: write 1.80 1.21 0.82 m"),
        ("drop (cm),first rebound,second rebound\n100,64,41", "'first rebound' is not known"),
        ("t [s],weg [cm]\n0,1\n1,2", "'weg' looks like a measurement, but time are read"),
        ("start,rebound (cm)\n1,2", "no bounces, as 'start' is touch, 'rebound' is rebound height"),
        ("H,T0,T1,T2\n1,0,.45,1.17", "the first time is the release .delete column 'T0'."),
        ("time 1,time 2\n0,0\n.9,.9", "or write one heading, as time 1, over runs side by side"),
        ("h0,h1,h2\n1,0.6724,0.672", "line 2: these heights do not fall on"),
        ("drop height,time\n1,1.1\n0.8,1", "'drop height' is drop height, 'time' is time: write"),
        ("drop height (cm),COR\n20,0.8", "'COR' is restitution: write 'time"),
        (
            "drop,rebound\n50,33\n75,50",
            "line 2: a height of 50 m below 'drop' is large: is it in cm",
        ),
        ("h0 [bananas],h1 [m]\n50,33", "bananas"),
        ("drop,rebound\n1,0.64,0.5", "line 2: 3 cells below 2 headings"),
        ("time\n812\n1707\n2200", "is too long: is it in ms"),
        ("time\n1\n1.7\n2.2\n0.3\n1.2", "sort the lines, or leave an empty line where another"),
        ("interval [s]\n0.5\n0.7\n0.6", "line 3: a flight of 0.7 s follows one of 0.5"),
        ("interval [s]\n0.5\n-0.4", "not positive"),
        ("interval [s]\n0.0009\n0.0007", "a flight of 0.0009 s is too short"),
        ("t,y\n" + ZIGZAG, "no impact between two flights in the track"),
        ("height [m]\n0.5\n0.7\n0.6", "a height of 0.7 m follows one of 0.5"),
        (
            "t,y\n" + "\n".join(reversed(track().split("\n"))),
            "the time is not after the one before",
        ),
        ("t,y\n0.1,0.5\n0.2,0.7\n0.3,0.6", "too few lines of a track; tops"),
        ("time,KE\n" + track(), "evenly spaced times are those of samples .KE.: positions, "),
        ("t,y (m/s^2)\n" + track(), "'y' is in m/s.2, and is no position"),
        ("speed,COR\n1,81", "is it in %"),
        ("speed,COR\n1,1.04\n2,1.041\n3,1.04\n4,1.041", "above 1 by more than its error"),
        ("# contact time: 0.6 s\ntime [s]\n0.1\n0.9\n1.4\n1.8", "contact time: 600 ms is longer"),
        ("# mass: 58\n# diameter: 67 mm\ntime [s]\n" + column(TIMES), "is a unit missing"),
        ("# frame rate: 0.01\ntime\n0.1\n0.9\n1.5", "an error of 28.9 s say nothing of r"),
        ("v_in,v_out\n1,2\n1,2", "exchanged"),
        ("drop,rebound\n1,1.12", "it rebounds with 1.12 m from 1 m"),
        ("time [s]\n0.1\n0.9", "no impact lies between"),
        (TWO + "\n\ndrop (in),rebound (in)\n5,3.2", "'drop .in.' below 'drop' is no number"),
        ("time (s)\n" + column(np.delete(TIMES, 1)), "an impact is missing within it"),
        ("time (s)\n" + column(np.delete(TIMES, [2, 3])), "line 4: a flight of 1.8.* is missing"),
        (
            "drop (cm),rebound (cm),second rebound (cm)\n100,67,45\n80,53,36",
            "'second rebound' looks like a measurement, but drop height and rebound height are",
        ),
        ("interval (s),height (m)\n.9,.6\n.7,.4", "column 'height' looks like a measurement"),
        ("drop (cm),trial 1 (cm),rebound (cm)\n100,60,64", "column 'trial 1' looks like"),
        ("drop (cm),rebound (cm),time (s)\n100,60,.4", "column 'time' looks like a measurement"),
        ("t x y\n0.1 1\n0.2 1 3", "line 2: 2 cells below 3 headings: divide columns by commas"),
        ("drop height rebound height\n1 0.64", "2 cells below 4 headings: .* spaces divide names"),
        ("|\n|", "no line of numbers below a heading"),
        ("t,y\ns,m", "no line of numbers below a heading"),
        ("t,y" + 20 * "\n1,2", "no impact between two flights in the track"),
        (
            " ,Area,XM,YM,Slice\n1,5716,465.6,65.3,29",
            "'Slice' is frame: frames are times with a li",
        ),
        ("drop (px),rebound (px)\n800,512", "'px' in '1 px' does not fit"),
        ("drop height (cm),tennis,golf\n50,27,34", "'tennis' is not known, 'golf' is not known"),
        ("height\n1000\n900\n800", "is it in cm or mm"),
        ("Heights of a ball, third run, indoors\n1000,640,410", "a title or a comment begins w"),
        ("0.500000\t0.320000\n0.900000\t0.600000\n1.2\t0.8", "a table begins with headings"),
        (
            "drop (cm),bounce 1 (cm),bounce 2 (cm)\n100,64,41\n80,51,33",
            "two columns are both height, 'bounce 1' and 'bounce 2'",
        ),
        ("frame\n10\n200\n350", "frames are times with a line above .* # frame rate: 30"),
    ],
)
def test_other_files_are_refused_in_one_line(text, said, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(text)
    with pytest.raises(Refused, match=said) as refused:
        fit(path)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("after", "line"), [(0, 3), (2, 5), (4, 7), (5, 8), (6, 9)])
def test_an_echo_is_named_where_it_is(after, line, tmp_path):
    """The touch after it was called missing, or the one before."""
    path = tmp_path / "heard.csv"
    path.write_text("time (s)\n" + column(np.sort([*TIMES, TIMES[after] + 0.012])))
    with pytest.raises(Refused, match=f"line {line}: 0.012 s after the touch before it: an echo"):
        fit(path)


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA])
def test_an_archive_with_a_wrong_bit_is_read_or_refused_in_one_line(method, tmp_path):
    """Passwords, compressions that are not known and damages gave tracebacks."""
    path = tmp_path / "phyphox.zip"
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.writestr("Data.csv", FILES["times"])
    data = path.read_bytes()
    said = set()
    for i in range(32, 8 * len(data)):
        flipped = bytearray(data)
        flipped[i // 8] ^= 1 << i % 8
        path.write_bytes(flipped)
        try:
            read(path)
        except Refused as refused:
            said.add(re.split("[:,]", str(refused).replace("Data.csv", ""))[1])
    assert {" copy it again", " That compression method is not supported"} <= said
    assert any("encrypted" in message for message in said)


def test_what_is_no_text_is_refused(tmp_path):
    path = tmp_path / "lab.xlsx"
    for data, said in (
        (bytes(range(256)) * 20, "is no text: save it as csv"),
        (
            b"PK\x03\x04 and more",
            "lab.xlsx is a damaged archive: .*; of a spreadsheet save the sheet",
        ),
    ):
        path.write_bytes(data)
        with pytest.raises(Refused, match=said):
            fit(path)


def test_every_published_experiment_names_its_source():
    assert len(experiments()) == 8
    for name in experiments():
        head = read(name)[""].head
        assert {"title", "measured by", "published", "source", "read"} <= head.keys()


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ([1, 2, 3], "list is no recording: give a file, .* columns such"),
        ({"time": [[0.45, 1.17], [1.75, 2]]}, "below 'time' is no number"),
        ("croqet", "the file croqet does not exist, and the experiments are .*, croquet, "),
        (
            {"ball": ["tennis", "golf"], "drop (cm)": [100, 80], "rebound (cm)": [54, 70]},
            "the recording has tennis, golf: name one, --ball",
        ),
    ],
)
def test_other_sources_are_refused(source, said):
    with pytest.raises(Refused, match=said):
        fit(source)


def test_columns_are_read_as_those_of_a_file():
    heights = np.array(DROPS)
    columns = {"drop height (cm)": heights, "rebound height (cm)": 0.6724 * heights[:3]}
    fitted = fit(columns)
    assert fitted.restitution == pytest.approx(0.82, abs=1e-9)
    assert fitted.impacts.speed == pytest.approx(np.sqrt(2 * G * heights[:3] / 100))


DRAGGED = {
    "flights": {"interval (s)": 0.6 * 0.9 ** np.arange(7)},
    "heights": {"height (m)": 1.5 * 0.6 ** np.arange(5)},
    "drops": {"drop (m)": [0.5, 1.0, 1.5, 2.0], "rebound (m)": [0.345, 0.68, 1.005, 1.32]},
    "track": {"t (s)": FRAMES, "y (m)": [position(t) for t in FRAMES]},
}


@pytest.mark.parametrize("ball", [("58 g", "67 mm"), ("2.7 g", "40 mm")])
@pytest.mark.parametrize("kind", DRAGGED)
def test_the_size_of_the_drag_is_the_difference_of_r_with_and_without(kind, ball):
    """It was 2.2 to 2.9 times too large, as if a ball kept the speed of its impact."""
    mass, diameter = ball
    fitted = fit(DRAGGED[kind], mass=mass, diameter=diameter)
    plain = fit(DRAGGED[kind])
    note = next(note for note in fitted.notes if "the drag of the air is removed" in note)
    printed = float(note.rsplit(" ", 1)[1])
    assert printed == pytest.approx(fitted.restitution - plain.restitution, rel=0.05)
    # Without mass and diameter the size is that of a table tennis ball, which is light.
    note = next(note for note in plain.notes if "drag" in note)
    assert float(re.search(r"0\.\d+", note)[0]) >= printed / 1.01


def test_the_drag_is_said_only_where_it_matters():
    low = fit({"drop (m)": [0.1, 0.2, 0.3], "rebound (m)": [0.064, 0.125, 0.197]})
    assert not any("drag" in note for note in low.notes)
    high = fit({"drop (m)": [1.0, 2.0, 3.0], "rebound (m)": [0.64, 1.2801, 1.9199]})
    assert any("the drag of the air is not removed" in note for note in high.notes)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (FILES["picture, y negative"], "downwards, as in a picture"),
        (
            "drop [m],rebound [m]\n1,0.64\n0.5,\n\n0.8,0.5\n0.9,nan\n0.7,NA\n0.6,-",
            "missing in line 3, 4, 6, 7, 8, which",
        ),
        (FILES["two lines of heights"], "missing in line 3, which"),
        (
            FILES["picture, pixels"],
            "by the times the ball falls from 1.48 m: if it does not, correct the times",
        ),
        ("t (s),y (cm)\n" + track(shown=lambda y: 1e4 * y), "gravity is 981 m/s² .* correct what"),
        (TWO, "lowest point of the ball"),
        (
            "Temperature (°C),n,drop (cm),rebound (cm)\n5,1,50,20\n20,1,50,30",
            "not used: 'Temperature'$",
        ),
        ("drop (cm),rebound (cm),uncertainty (cm)\n50,32,1\n60,38,1", "not used: 'uncertainty'$"),
        ("# uncertainty: 5 mm\n" + TWO, "the head has 'uncertainty: 5 mm'"),
        (FILES["heard, with a contact time"], "the contact, 8 ms, is taken off"),
        # 8 ms move r by 0.0024 here.
        ("time [s]\n" + column(TOUCHES), "too high by 0.0003 for each ms of it"),
        ("t (s),y (m)\n" + track(slow=8), "gravity is 0.153 m/s² .* 8 times the true ones"),
        ("speed,COR\n1,1.02\n2,0.98\n3,1.03\n4,0.98", "above 1 within its error"),
    ],
)
def test_a_note_says_what_was_done(text, said, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(text)
    assert [note for note in fit(path).notes if re.search(said, note)]


@pytest.mark.parametrize(
    "columns",
    [
        # A series ends where another ball begins.
        {"interval (s)": [0.9, 0.72, 0.9, 0.7, 0.9, 0.74]},
        {"height (cm)": [100, 64, 100, 62, 100, 66]},
        {"drop (cm)": [100, 80, 100, 80, 100, 80], "rebound (cm)": [64, 51, 62, 50, 66, 53]},
        {"v in (m/s)": [4, 3, 4.1, 3.1, 4.2, 3.2], "v out (m/s)": [3.2, 2.4, 3.2, 2.4, 3.4, 2.6]},
        {"h0 (m)": [1] * 6, "h1 (m)": [0.64, 0.63, 0.66, 0.64, 0.65, 0.63]},
    ],
)
def test_a_column_group_pools_balls_whose_impacts_share_an_error(columns):
    fitted = fit(columns | {"group": ["a", "", "b", "b", "c", "c"]})
    assert sorted(set(fitted.impacts.groups)) == ["a", "b", "c"]
    assert "3 groups deviate" in str(fitted) or len(fitted.impacts.speed) == 3


@pytest.mark.parametrize(("drop", "r"), [(1.0, "0.825"), (1.04, "0.809")])
def test_heights_of_the_top_of_a_ball_have_the_r_of_the_page(drop, r):
    """Both heights of the top were said to have 0.825."""
    fitted = fit({"drop (m)": [drop], "rebound (m)": [0.8**2 + 0.04]})
    assert f"{fitted.restitution:.3f}" == r
    page = Path(__file__).parents[1] / "docs" / "files.md"
    assert r in page.read_text("utf-8")


def test_a_line_without_r_has_no_error_either():
    """Errors of four impacts met five lines: a traceback of NumPy."""
    r = [0.8, None, 0.79, 0.81, 0.8]
    fitted = fit({"speed (m/s)": [1, 2, 3, 4, 5], "COR": r, "std": [0.01] * 5})
    assert len(fitted.impacts.speed) == 4 and "missing in line 3" in fitted.notes[0]


def test_a_line_is_left_out_with_the_impacts_beside_it(tmp_path):
    path = tmp_path / "heard.csv"
    wrong = [*FLIGHTS[:3], 0.9, *FLIGHTS[3:]]
    path.write_text("interval [s]\n" + column(wrong))
    with pytest.raises(Refused, match="follows one of"):
        fit(path)
    with pytest.raises(Refused, match="no line 99"):
        fit(path, leave_out=(99,))
    fitted = fit(path, leave_out=(5,))
    assert len(fitted.impacts.speed) == 4
    assert fitted.restitution == pytest.approx(0.82, abs=1e-3)
    # Nothing is missing in a line that was to be left out.
    assert not any("is missing" in note for note in fitted.notes)


def test_an_empty_line_divides_a_series(tmp_path):
    """Flights on both sides of it were compared."""
    path = tmp_path / "two.csv"
    path.write_text("time [s]\n0.1\n0.9\n1.5\n\n0.2\n1.0\n1.6\n\n")
    recording = read(path)[""]
    assert [list(chain) for chain in recording.chains] == [pytest.approx([0.8, 0.6])] * 2
    assert (
        "a number is missing in line 5, which is left out and divides the series" in recording.notes
    )


def test_a_ball_that_is_held_and_lies_at_last_is_followed_in_between(tmp_path):
    """A parabola through the held ball gave r = 0.65 for 0.82; the ball at rest was refused."""
    held = [f"{t:.4f},{position(0):.5f}" for t in np.arange(-60, 0) / 60]
    lying = [f"{t:.4f},0" for t in FRAMES[-1] + np.arange(1, 61) / 60]
    path = tmp_path / "track.csv"
    path.write_text("\n".join(["t,y", *held, track(), *lying]))
    fitted = fit(path)
    assert np.abs(fitted.impacts.restitution - 0.82).max() < 1e-3
    assert len(fitted.impacts.speed) == 6


def test_rounded_times_of_a_camera_are_those_of_even_frames(tmp_path):
    path = tmp_path / "track.txt"
    lines = [f"{t:.2f}\t0\t{position(t):.6f}" for t in np.arange(0, 3.5, 1 / 75)]
    path.write_text("mass_A\nt\tx\ty\n" + "\n".join(lines))
    # Even frames leave exact parabolas, whose heights are rounded to 1 µm; times that are rounded
    # to 10 ms leave errors of 0.001.
    assert np.abs(fit(path).impacts.restitution - 0.82).max() < 1e-4


def test_kilometres_per_hour_are_not_metres_per_second(tmp_path):
    """Behind a slash or an underscore they were."""
    path = tmp_path / "recording.csv"
    for heading in ("v_in/km/h,v_out/km/h", "v_in_km/h,v_out_km/h", "v_in (km/h),v_out (km/h)"):
        path.write_text(heading + "\n3.6,2.88\n7.2,5.76")
        assert read(path)[""].chains[0] == pytest.approx(np.array([[1, 0.8], [2, 1.6]]))


def test_films_are_read_as_one_recording_of_all_impacts(tmp_path):
    """Of two films below each other the time was said not to be sorted."""
    path = tmp_path / "films.csv"
    for name in ("films below each other", "films by a column"):
        path.write_text(FILES[name])
        assert len(fit(path).impacts.speed) == 12
    path.write_text("t,y\n" + track() + "\n" + track())
    with pytest.raises(Refused, match="leave an empty line before another film"):
        fit(path)


@pytest.mark.parametrize(
    "headings",
    [
        '"Run 1: Time (s)","Run 1: Position (m)","Run 2: Time (s)","Run 2: Position (m)"',
        '"Latest: Time (s)","Latest: Position (m)","Run 1: Time (s)","Run 1: Position (m)"',
        '"Time (s) Run #1","Position (m) Run #1","Time (s) Run #2","Position (m) Run #2"',
        "Data Set 1:Time(s),Data Set 1:Position(m),Data Set 2:Time(s),Data Set 2:Position(m)",
    ],
)
def test_runs_side_by_side_are_recordings(headings, tmp_path):
    """They were refused as two columns of times."""
    path = tmp_path / "runs.csv"
    first = track().split("\n")
    second = [*track(shown=lambda y: 0.5 * y).split("\n")[:-40], *[","] * 40]
    rows = [f"{one},{two}" for one, two in zip(first, second, strict=True)]
    path.write_text("\n".join([headings, *rows]))
    fitted = fit(path)
    assert len(fitted.impacts.speed) == 10
    assert np.abs(fitted.impacts.restitution - 0.82).max() < 1e-3
    assert not any("is missing" in note for note in fitted.notes)


def test_runs_have_a_time_of_their_own_or_one_of_all(tmp_path):
    path = tmp_path / "runs.csv"
    lines = track("{0:.4f},{1:.5f},{1:.5f}")
    path.write_text("Time (s),Position (m) Run #1,Position (m) Run #2\n" + lines)
    assert len(fit(path).impacts.speed) == 12
    path.write_text("Run 1: Time (s),Run 2: Time (s)\n" + "\n".join(f"{t},{t}" for t in TIMES))
    assert len(fit(path).impacts.speed) == 10
    # A last bounce without its height is no end of the run.
    headings = "Run 1: n,Run 1: height (m),Run 2: n,Run 2: height (m)"
    path.write_text(headings + "\n0,1,0,1\n1,.64,1,.64\n2,.41,2,\n3,.26,,")
    assert any("missing in line 4, which" in note for note in fit(path).notes)
    # Times of one run are not those of the positions of another.
    path.write_text("Run 1: Time (s),Run 2: Position (m)\n" + track())
    with pytest.raises(Refused, match=r"Run 1 has Time \(s\) and Run 2 has Position \(m\): leave"):
        fit(path)


def test_an_interval_of_0_is_an_end_and_no_flight(tmp_path):
    """Only behind the last event: within a series it is refused."""
    path = tmp_path / "stopwatch.csv"
    path.write_text("run,interval (s)\n1,0.9\n1,0.72\n1,0\n2,0.9\n2,0.72\n2,0")
    fitted = fit(path)
    assert len(fitted.impacts.speed) == 2 and not any("missing" in note for note in fitted.notes)
    path.write_text("interval (s)\n0.9\n0\n0.72")
    with pytest.raises(Refused, match="line 3: a time of 0 s"):
        fit(path)


@pytest.mark.parametrize("typed_label", ["0.3\t0.3\t0", "0.3\t0.3", "0.3"])
def test_a_label_that_is_typed_by_hand_is_read(tmp_path, typed_label):
    """One such label among exported ones had the whole file refused."""
    path = tmp_path / "labels.txt"
    exported = [f"{t:.6f}\t{t:.6f}\t{i}" for i, t in enumerate(TIMES)]
    path.write_text("\n".join([typed_label, *exported[1:]]))
    fitted = fit(path)
    assert fitted.restitution == pytest.approx(0.82, abs=1e-6)
    assert not any("not used" in note for note in fitted.notes)


def test_numbers_are_read_alike_by_command_line_and_column(typed, tmp_path):
    """The line of a file was refused, whose numbers the command read."""
    path = tmp_path / "heights.csv"
    for text in ("h0 (m),h1 (m),h2 (m),h3 (m)\n1.7,.81,.70,.59", "height (m)\n1.7\n.81\n.70\n.59"):
        path.write_text(text)
        answer = fit(path).result.split(": ")[1]
        for numbers in (
            "1.7 0.81 0.70 0.59 m",
            '"1.7 m" "0.81 m" "0.70 m" "0.59 m"',
            "1.7m 0.81m 0.70m 0.59m",
            "1.7,0.81,0.70,0.59 m",
        ):
            assert answer in typed(f"fit {numbers}")[1]


def test_a_resolution_relaxes_what_it_makes_doubtful():
    """A second interval of a stopwatch that was longer by an error of the hand was refused."""
    tapped = {"recording": [1, 1, 2, 2, 3, 3], "interval (s)": [0.7, 0.6, 0.6, 0.65, 0.7, 0.55]}
    with pytest.raises(Refused, match="follows one of"):
        fit(tapped)
    assert fit(tapped, resolution="60 ms").restitution < 1
    pairs = {"drop (m)": [1.0, 1.0], "rebound (m)": [0.9, 1.2]}
    with pytest.raises(Refused, match="exchanged"):
        fit(pairs)
    assert fit(pairs, resolution="10 cm").restitution <= 1


def test_only_columns_with_computed_numbers_are_left_alone():
    """An r beside times is computed of them, and one beside a drop height is half of a pair."""
    times = {"time (s)": TIMES, "COR": [0.82] * len(TIMES)}
    assert fit(times).restitution == pytest.approx(0.82, abs=1e-3)
    with pytest.raises(Refused, match="no bounces"):
        fit({"drop height (m)": [1.0], "COR": [0.8]})


def test_more_impacts_than_a_fit_takes_are_refused():
    """Of 20,000 the arrays crashed."""
    many = np.full(10001, 1.0)
    with pytest.raises(Refused, match="10001 impacts are more than 10000: fit parts of them"):
        fit({"drop (m)": many, "rebound (m)": 0.64 * many})
    series = {"height (m)": 0.99 ** np.arange(1002)}
    with pytest.raises(Refused, match="1001 impacts of one series are more than 1000"):
        fit(series)


FRAME = np.arange(len(FRAMES))
COPIES = "copies of the frame before: line"
OUTLIERS = "positions that no ball has: line"
# Positions of a film y, with numbers from 0 to 1 by chance, and what is said of them.
SPOILED = {
    "every fifth frame is a copy": (lambda y, at: y[FRAME - (FRAME % 5 == 4)], COPIES),
    "every other frame is a copy": (lambda y, at: y[FRAME // 2 * 2], COPIES),
    "no echo": (lambda y, at: np.where(at < 0.05, 3.57, y), OUTLIERS),
    "an echo of the floor": (lambda y, at: np.where(at < 0.05, 0.0, y), OUTLIERS),
    "jumps": (lambda y, at: np.where(at < 0.04, y + 0.2, y), OUTLIERS),
    "frames are missing": (lambda y, at: np.where(at < 0.1, math.nan, y), "is missing in line"),
    "a gap": (
        lambda y, at: np.where(abs(FRAME - 45) < 5, math.nan, y),
        "frames that are missing before: line 52",
    ),
}


@pytest.mark.parametrize("kind", SPOILED)
def test_a_spoiled_film_holds_r_with_less_than_three_times_the_width_of_a_clean_one(kind):
    """Of films with copies and of sensors without echo most impacts were lost without a word."""
    spoil, said = SPOILED[kind]
    widths, holds = [], []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        y = np.array([position(t) for t in FRAMES]) + 2e-3 * rng.normal(size=len(FRAMES))
        spoiled = spoil(y, rng.random(len(y)))
        clean, fitted = (
            fit({"t (s)": FRAMES, "y (m)": np.round(positions, 4)}) for positions in (y, spoiled)
        )
        assert not any("left out" in note for note in clean.notes)
        assert any(said in note for note in fitted.notes)
        holds.append(fitted.interval[0] < 0.82 < fitted.interval[1])
        widths.append((np.ptp(fitted.interval), np.ptp(clean.interval)))
    wide, narrow = np.median(widths, axis=0)
    # Of twelve intervals of 95 %, fewer than nine hold r in one of 5,000 cases.
    assert wide < 3 * narrow and sum(holds) >= 9


def test_rounded_positions_near_a_top_are_no_copies():
    """Positions in whole pixels repeat where a ball turns; beside a copy it moves on."""
    t = np.arange(0, TIMES[-1] - 0.05, 1 / 240)
    y = np.round([700 - 500 * position(time) for time in t])
    assert not copies(t, y, 1.0).any()
    y[101::2] = y[100::2][: len(y[101::2])]
    assert copies(t, y, 1.0)[101::2].sum() > 100 and not copies(t, y, 1.0)[100::2].any()


@pytest.mark.parametrize("shown", [1, 2, 3])
def test_copies_that_are_tracked_one_by_one_are_left_out(shown):
    """A film of 60 Hz from a camera of 30 Hz had an interval six times as wide, without a word."""
    pictures = np.arange(0, TIMES[-1] - 0.05, 1 / 30)
    frames = np.repeat([position(t) for t in pictures], shown)
    t = np.arange(len(frames)) / (30 * shown)
    widths = []
    for seed in range(7):
        y = np.round(frames + 3e-3 * np.random.default_rng(seed).normal(size=len(t)), 4)
        fitted, clean = (fit({"t (s)": t[::n], "y (m)": y[::n]}) for n in (1, shown))
        assert any(COPIES in note for note in fitted.notes) == (shown > 1)
        assert abs(fitted.restitution - 0.82) < np.ptp(fitted.interval)
        widths.append((np.ptp(fitted.interval), np.ptp(clean.interval)))
    copied, once = np.median(widths, axis=0)
    assert copied < 2 * once


def film(rate, noise, hidden=0.0):
    """Return the columns of a film in which the ball is not seen below a height in m."""
    t = np.arange(0, TIMES[-1] - 0.05, 1 / rate)
    y = np.array([position(time) for time in t])
    y = np.where(y < hidden, math.nan, y + noise * np.random.default_rng(7).normal(size=len(t)))
    return {"t (s)": np.round(t, 5), "y (m)": np.round(y, 4)}


@pytest.mark.parametrize("noise", [1e-4, 5e-4, 2e-3])
@pytest.mark.parametrize("hidden", [0.0, 0.02, 0.08, 0.2])
def test_a_film_of_more_frames_is_worth_more(hidden, noise):
    """With a hidden floor 120 frames a second left one impact of four, and 240 none."""
    fits = [fit(film(rate, noise, hidden)) for rate in (60, 120, 240, 480, 960)]
    counts = [len(fitted.impacts.speed) for fitted in fits]
    assert counts == sorted(counts) and counts[0] > 1
    widths = [np.ptp(fitted.interval) for fitted in fits]
    # One interval has an error of its width, of four impacts about a third.
    assert widths[-1] < 0.75 * widths[0] or counts[0] < 3
    for fitted in fits:
        assert fitted.restitution == pytest.approx(0.82, abs=np.ptp(fitted.interval))
        assert not any("copies" in note for note in fitted.notes)


def test_a_bounce_that_is_not_seen_is_no_impact():
    """Parabolas of the flights beside it meet as well, with r = 0.90."""
    columns = film(240, 5e-4)
    t = columns["t (s)"]
    columns["y (m)"][(t > TIMES[1] - 0.05) & (t < TIMES[2] + 0.05)] = math.nan
    fitted = fit(columns)
    assert "positions are missing around it for so long" in str(fitted.notes)
    assert np.abs(fitted.impacts.restitution - 0.82).max() < 0.01


def test_a_tracker_that_jumps_to_another_ball_is_named():
    """Of two balls with 0.8 and 0.57 a mean was given without a word."""
    columns = film(240, 5e-4)
    late = columns["t (s)"] > TIMES[2] + 0.2
    columns["y (m)"][late] = 0.6 * columns["y (m)"][late] + 0.3
    assert "does the tracker jump, as to another ball?" in str(fit(columns).notes)


RECORDINGS = {"tables", "tracks", "flights", "cameras", "recordings", "intervals", "fits", "sounds"}
BOTH = {"units", "bounces"}
JOINED = {"cli", "__init__", "__main__"}


def test_recordings_and_engines_import_only_what_both_need():
    """Only the command and the package join both halves."""
    for path in Path(tables.__file__).parent.glob("*.py"):
        of_package = re.findall(r"from bouncing_ball_contacts\.(\w+) import", path.read_text())
        if path.stem in RECORDINGS:
            assert set(of_package) <= RECORDINGS | BOTH, path.stem
        elif path.stem not in JOINED:
            assert not set(of_package) & RECORDINGS, path.stem
