"""Files as instruments, programs and people write them."""

import io
import json
import re
import zipfile
from itertools import product

import numpy as np
import pint
import pytest

from bouncing_ball_contacts import Refused, fit
from bouncing_ball_contacts.recordings import read
from bouncing_ball_contacts.tables import experiments

FLIGHTS = 0.9 * 0.82 ** np.arange(6)
TIMES = 0.3 + np.concatenate([[0.0], np.cumsum(FLIGHTS)])
G = 9.80665


def column(values, form="{:.6f}"):
    return "\n".join(form.format(value) for value in values)


def position(t):
    """Return the height of a ball that falls, and bounces at TIMES."""
    if t < TIMES[0]:
        half = FLIGHTS[0] / 0.82 / 2
        return G / 2 * (half**2 - (t - TIMES[0] + half) ** 2)
    i = min(int(np.searchsorted(TIMES, t, side="right")) - 1, len(FLIGHTS) - 1)
    return G / 2 * (t - TIMES[i]) * (TIMES[i] + FLIGHTS[i] - t)


FRAMES = np.arange(0, TIMES[-1] - 0.05, 1 / 60)
PULSES = np.arange(0, 4.5, 2e-4)


# Between two touches are the contact, here of 8 ms, and the flight.
CONTACT = 0.008
TOUCHES = 0.3 + np.concatenate([[0.0], np.cumsum(FLIGHTS + CONTACT)])


def push(t):
    """Return the force of balls that touch at TOUCHES, half a sine, and noise."""
    since = t - TOUCHES[np.searchsorted(TOUCHES, t, side="right") - 1]
    is_touching = 0 <= since < CONTACT
    return 90 * np.sin(np.pi * since / CONTACT) * is_touching + 0.1 * np.sin(99999 * t)


def picture(kind):
    """Return a track as a table with the unit behind, as cameras have it: y grows downwards."""
    shown = {"-y": lambda y: -y, "2-y": lambda y: 2 - y, "px": lambda y: round(900 - 700 * y)}
    return "\n".join(f"{t:.4f},{shown[kind](position(t)):.5f}" for t in FRAMES)


def track(form="{:.4f},{:.5f}", slow=1):
    return "\n".join(form.format(slow * t, position(t)) for t in FRAMES)


STAMPS = [*enumerate(TIMES, 1)]
BALLS = (("A", 1), ("B", 0.9))
SPEEDS = (1.0, 2.0, 3.0, 4.0)
FILES = {
    "times": "time [s]\n" + column(TIMES),
    "times without a heading": column(TIMES),
    "intervals with a unit behind": "interval_ms\n" + column(1000 * FLIGHTS),
    "semicolons and decimal commas": "Nr;Interval (s)\n"
    + "\n".join(f"{i};{x:.6f}".replace(".", ",") for i, x in enumerate(FLIGHTS)),
    "decimal commas alone": "Interval (s)\n" + column(FLIGHTS).replace(".", ","),
    "labels of Audacity": "\n".join(f"{t:.6f}\t{t + 0.004:.6f}\tbounce" for t in TIMES),
    "labels of Audacity without texts": "\n".join(f"{t:.6f}\t{t:.6f}\t" for t in TIMES),
    "phyphox, events": '"Event number","Interval (s)","Time (s)"\n'
    + "\n".join(
        f"{i},{a:.9E},{b:.9E}" for i, (a, b) in enumerate(zip(FLIGHTS, TIMES[1:], strict=True))
    ),
    "phyphox, one line": ",".join(f'"Time {i} (s)"' for i in range(6))
    + "\n"
    + ",".join(f"{x:.9E}" for x in FLIGHTS),
    "phyphox, heights": '"Height (cm)"\n' + column(100 * G / 8 * FLIGHTS**2),
    "a row of units": "h0;h1\ncm;cm\n" + "\n".join(f"{h};{h * 0.6724}" for h in (50, 75, 100, 125)),
    "a title and units": "Lab 3\n\nDrop height (cm),Rebound height (cm),Remark\n"
    + "\n".join(f"{h},{h * 0.6724},ok" for h in (50, 75, 100, 125)),
    "units behind a slash": "h0/cm,h1/cm\n"
    + "\n".join(f"{h},{h * 0.6724}" for h in (50, 75, 100, 125)),
    "three rebounds in a line": "drop (cm),rebound 1 (cm),rebound 2 (cm),rebound 3 (cm)\n"
    + "\n".join(",".join([str(h)] + [f"{h * 0.6724}"] * 3) for h in (50, 75, 100, 125)),
    "speeds": "v_in (m/s),v_out (m/s),COR\n" + "\n".join(f"{-v},{v * 0.82},0.82" for v in SPEEDS),
    "velocities of one sign": "velocity before,velocity after\n"
    + "\n".join(f"{-v},{-v * 0.82}" for v in SPEEDS),
    "impact velocity, COR, std": "impact velocity,COR,std\n"
    + "\n".join(f"{v},0.82,0.01" for v in SPEEDS),
    "recordings": "recording,interval [s]\n"
    + "\n".join(f"{i},{x}" for i in (1, 2) for x in FLIGHTS),
    "Tracker, rounded times": "mass_A\nt\tx\ty\n"
    + "\n".join(f"{t:.2f}\t0.001\t{position(t):.5f}" for t in FRAMES),
    "Tracker, decimal commas": "mass_A\nt\tx\ty\n"
    + "\n".join(f"{t:.3f}\t0,001\t{position(t):.5f}" for t in FRAMES).replace(".", ","),
    "phyphox, audio scope": '# contact time: 8 ms\n"Time (ms)","Recording (a.u.)"\n'
    + "\n".join(f"{1000 * t:.9E},{push(t):.9E}" for t in PULSES),
    "force plate with a row of units": "Time,Fz\ns,N\n"
    + "\n".join(f"{t:.4f},{push(t):.3f}" for t in PULSES),
    "heard, with a contact time": "# contact time: 8 ms\ntime [s]\n" + column(TOUCHES),
    "heads as columns are written": "# Contact_time = 8 ms\ntime [s]\n" + column(TOUCHES),
    "intervals, with a contact time": "time [s],interval [s],duration [ms]\n"
    + "\n".join(f"{a},{b},8" for a, b in zip(TOUCHES[1:], FLIGHTS + CONTACT, strict=True)),
    "picture, y negative": "t,y\n" + picture("-y"),
    "picture, y from above": "t,y\n" + picture("2-y"),
    "picture, pixels": "t (s),y (px)\n" + picture("px"),
    "picture, pixels behind": "t,y_px\n" + picture("px"),
    "picture, heights": "time,height\n" + picture("px"),
    "track, time and height": "time (s),height (m)\n" + track(),
    "track, time and position": "time,position\n" + track(),
    "track, x before y": "time,x position,y position\n" + track("{:.4f},0.001,{:.5f}"),
    "tops and their times": "time (s),height (m)\n0.4,1\n1.2,0.6724\n1.9,0.4521\n2.4,0.304",
    "track, t and z": "t (s),z (m)\n" + track(),
    "one line of heights": "h0 (cm),h1 (cm),h2 (cm),h3 (cm)\n100,67.24,45.21,30.4",
    "two lines of heights": "h0 (cm),h1 (cm),h2 (cm),h3 (cm)\n100,67.24,45.21,30.4\n80,53.8,36.2,",
    "two lines of times": "t1 (s),t2 (s),t3 (s)\n0.1,0.92,1.5924\n0.2,0.7,1.11",
    "several rebounds in one line": "h0 (cm),h1 (cm),h2 (cm),h3 (cm)\n100,67.24,67.2,67.3",
    "rebounds and their average": "drop (cm),rebound 1 (cm),rebound 2 (cm),mean rebound (cm)\n"
    + "\n".join(f"{h},{h * 0.6724},{h * 0.6724},{h * 0.9}" for h in (50, 75, 100, 125)),
    "average rebounds alone": "drop (cm),average (cm)\n"
    + "\n".join(f"{h},{h * 0.6724}" for h in (50, 75, 100, 125)),
    "trials and their average": "Drop height (cm),Trial 1 (cm),Trial 2 (cm),Average (cm)\n"
    + "\n".join(f"{h},{h * 0.6724},{h * 0.6724},{h * 0.7}" for h in (50, 75, 100, 125)),
    "German heights": "Höhe h0 [cm];Rücksprunghöhe [cm]\n100;67,24\n80;53,79\n50;33,62",
    "French heights": "hauteur de chute (cm);hauteur de rebond (cm)\n100;67.24\n80;53.79\n50;33.62",
    "Spanish heights": "altura inicial (m),altura rebote (m)\n1,0.6724\n0.8,0.5379\n0.5,0.3362",
    "Italian heights": "altezza di caduta (m),rimbalzo (m)\n1,0.6724\n0.8,0.5379\n0.5,0.3362",
    "German speeds": "Einfallsgeschwindigkeit (m/s);Abprallgeschwindigkeit (m/s)\n"
    + "\n".join(f"{v};{v * 0.82}" for v in SPEEDS),
    "minutes and seconds": "time (mm:ss)\n"
    + "\n".join(f"{(t + 58) // 60:.0f}:{(t + 58) % 60:.6f}" for t in TIMES),
    "hours, with decimal commas": "\n".join(f"00:01:{t + 10:.6f}" for t in TIMES).replace(".", ","),
    "time stamps": "nr,time\n"
    + "\n".join(f"{i},2024-05-01T12:00:{t + 10:.6f}Z" for i, t in STAMPS),
    "a date and a time": "time\n" + "\n".join(f"2024-05-01 12:00:{t + 10:.6f}" for _, t in STAMPS),
    "nanoseconds": "t_ns\n" + column(1e9 * TIMES + 1.7e18, "{:.0f}"),
    "labels of Audacity with frequencies": "\n".join(
        f"{t:.6f}\t{t + 0.004:.6f}\tbounce\n\\\t200.0\t3000.0" for t in TIMES
    ),
    "three balls side by side": "time 1 (s),time 2 (s),time 3 (s)\n"
    + "\n".join(f"{t},{0.9 * t},{0.8 * t}" for t in TIMES),
    "two balls side by side": "interval 1 (s),interval 2 (s)\n"
    + "\n".join(f"{t},{1.1 * t}" for t in FLIGHTS),
    "recordings with names": "ball,time (s)\n"
    + "\n".join(f"{name},{shift + t}" for name, shift in (("A", 5), ("B", 0)) for t in TIMES),
    "decimal commas in quotes": "h0 (cm),h1 (cm)\n"
    + "\n".join(f'"{h:.2f}","{h * 0.6724:.2f}"' for h in (50, 75, 100, 125)).replace(".", ","),
    "a text with a comma": "note,h0 (cm),h1 (cm)\n"
    + "\n".join(f'"ball, old",{h},{h * 0.6724}' for h in (50, 75, 100, 125)),
    "JSON": json.dumps({"interval_ms": list(1000 * FLIGHTS)}),
    "coefficients in per cent": "speed (m/s),COR (%)\n" + "\n".join(f"{v},82" for v in SPEEDS),
    "frames": "# fps: 240\nbounce,frame\n"
    + "\n".join(f"{i},{240 * t:.3f}" for i, t in enumerate(TIMES)),
    "Tracker, with an acceleration": "mass_A\nt\tx\ty\tv_{y}\ta_{y}\n"
    + "\n".join(f"{t:.4f}\t0\t{position(t):.5f}\t0\t-9.8" for t in FRAMES),
    "a count with a gap, intervals": "n,interval (s)\n"
    + "\n".join(f"{i},{x}" for i, x in enumerate(FLIGHTS) if i != 3),
    "a count with a gap, times": "Bounce,Time (s)\n"
    + "\n".join(f"{i},{t}" for i, t in enumerate(TIMES) if i != 3),
    "a count with a gap, heights": "Bounce,Height (cm)\n"
    + "\n".join(f"{i},{100 * 0.6724**i}" for i in (1, 2, 3, 5, 6, 7)),
    "a ball in each line": "ball,t1,t2,t3,t4\n"
    + "\n".join(",".join([name, *map(str, a * FLIGHTS[:4])]) for name, a in BALLS),
    "runs in columns": "run 1 interval (s),run 2 interval (s)\n"
    + "\n".join(f"{x},{0.9 * x}" for x in FLIGHTS),
    "errors in cells": "Impact speed (m/s),COR\n" + "\n".join(f"{v},0.82 ± 0.01" for v in SPEEDS),
    "coefficients without unit": "speed (m/s),e (-)\n" + "\n".join(f"{v},0.82" for v in SPEEDS),
}


PAIRS = """
Height before,Height after | drop,bounce | initial height,final height | dropped,bounced
height dropped,height bounced
start height,end height | drop height,max height | h,h' | hi,hf | height,rebound | height,bounce
dropped from,bounced to | release height,bounce height | height before,bounce | h0,height
"""


@pytest.mark.parametrize("heading", [each.strip() for each in re.split(r"\||\n", PAIRS.strip())])
def test_two_heights_are_a_drop_and_its_rebound(heading, tmp_path):
    """They were taken for tops of one ball, of which the other column was dropped."""
    path = tmp_path / "pairs.csv"
    for unit, scale in ((" (cm)", 100), ("", 1)):
        lines = [f"{scale * h},{scale * h * 0.64}" for h in (1.0, 0.8, 0.6)]
        path.write_text(heading.replace(",", f"{unit},") + f"{unit}\n" + "\n".join(lines))
        found = fit(path)
        assert (found.recording.kind, len(found.impacts.speed)) == ("drops", 3)
        assert found.restitution == pytest.approx(0.8, abs=1e-6)


@pytest.mark.parametrize("heading", ["Vi (m/s),Vf (m/s)", "initial speed,final speed", "v0,vf"])
def test_two_speeds_are_those_before_and_after(heading, tmp_path):
    path = tmp_path / "speeds.csv"
    path.write_text(heading + "\n1,0.8\n2,1.6\n3,2.4")
    assert fit(path).restitution == pytest.approx(0.8, abs=1e-6)


UNITS = (
    "(meters) | (centimeters) | (millimeters) | (inches) | (foot) | (yd) | (cm ± 0.5) | ± 0.5 cm"
    " | in feet | / cm | / yd | inches"
)


@pytest.mark.parametrize("unit", UNITS.split(" | "))
def test_units_are_words_too(unit, tmp_path):
    """Metres with an s at the end were times."""
    path = tmp_path / "drops.csv"
    path.write_text(f"Drop {unit},Rebound {unit}\n3,1.92\n2,1.28\n4,2.56")
    found = fit(path)
    assert (found.recording.kind, len(found.impacts.speed)) == ("drops", 3)
    assert found.restitution == pytest.approx(0.8, abs=1e-6)


@pytest.mark.parametrize("unit", ["ms^-1", "ms-1", "m s-1"])
def test_units_of_speeds_have_powers(unit):
    for form in ("{} ({})", "{} / {}", "{}/({})"):
        names = [form.format(name, unit) for name in ("speed before", "speed after")]
        found = fit({names[0]: [1, 2, 3], names[1]: [0.8, 1.6, 2.4]})
        assert found.restitution == pytest.approx(0.8, abs=1e-6)


def test_a_row_of_units_may_have_inches(tmp_path):
    path = tmp_path / "drops.csv"
    path.write_text("Drop height,Rebound height\nft,in\n1,7.68\n2,15.36\n3,23.04")
    assert fit(path).restitution == pytest.approx(0.8, abs=1e-6)


WIDE = ("semicolons and decimal commas", "German heights", "Tracker, rounded times")


@pytest.mark.parametrize(
    ("name", "coding"), [*product(FILES, ["utf-8-sig"]), *product(WIDE, ["utf-16"])]
)
def test_files_are_read_as_they_are(name, coding, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(FILES[name], encoding=coding)
    found = fit(path)
    assert found.restitution == pytest.approx(0.82, abs=3e-3)
    low, high = found.interval
    assert low - 1e-6 <= 0.82 <= high + 1e-6


def test_rounded_times_of_a_camera_are_those_of_even_frames(tmp_path):
    path = tmp_path / "track.txt"
    lines = [f"{t:.2f}\t0\t{position(t):.6f}" for t in np.arange(0, 3.5, 1 / 75)]
    path.write_text("mass_A\nt\tx\ty\n" + "\n".join(lines))
    # Even frames leave exact parabolas, whose heights are rounded to 1 µm; times that are rounded
    # to 10 ms leave errors of 0.001.
    assert np.abs(fit(path).impacts.restitution - 0.82).max() < 1e-4


def spreadsheet(*sheets):
    """Return an xlsx file with shared strings, as programs write it."""
    texts = sorted(
        {cell for rows in sheets for row in rows for cell in row if isinstance(cell, str)}
    )
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as book:
        items = "".join(f"<si><t>{text}</t></si>" for text in texts)
        book.writestr("xl/sharedStrings.xml", f"<sst {space}>{items}</sst>")
        for n, rows in enumerate(sheets, 1):
            lines = ""
            for i, row in enumerate(rows, 1):
                cells = ""
                for letter, cell in zip("ABC", row, strict=False):
                    if isinstance(cell, str):
                        cells += f'<c r="{letter}{i}" t="s"><v>{texts.index(cell)}</v></c>'
                    elif cell is not None:
                        cells += f'<c r="{letter}{i}"><v>{cell}</v></c>'
                lines += f'<row r="{i}">{cells}</row>'
            sheet = f"<worksheet {space}><sheetData>{lines}</sheetData></worksheet>"
            book.writestr(f"xl/worksheets/sheet{n}.xml", sheet)
    return data.getvalue()


def test_the_first_sheet_with_numbers_is_read(tmp_path):
    """The first one was, and nothing said that there were more."""
    pairs = [["Drop (cm)", "Rebound (cm)"], [50, 32], [100, 64], [150, 96]]
    path = tmp_path / "lab.xlsx"
    for above, said in ([["Lab 3"], ["our names"]], False), (pairs, True):
        path.write_bytes(spreadsheet(above, pairs))
        found = read(path)
        assert found.chains[0] == pytest.approx(np.array(pairs[1:]) / 100)
        assert ("2 sheets have numbers: the first one of them is read" in found.notes) == said


def test_a_spreadsheet_is_read(tmp_path):
    rows = [["No.", "Drop height (cm)", "Rebound height (cm)"]]
    rows += [[i, h, h * 0.6724] for i, h in enumerate((50.0, 75.0, 100.0, 125.0))]
    path = tmp_path / "heights.xlsx"
    path.write_bytes(spreadsheet(rows))
    assert fit(path).restitution == pytest.approx(0.82, abs=1e-3)
    path.write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(Refused, match="spreadsheet cannot be read"):
        fit(path)


def test_a_line_is_left_out_with_the_impacts_beside_it(tmp_path):
    path = tmp_path / "heard.csv"
    wrong = [*FLIGHTS[:3], 0.9, *FLIGHTS[3:]]
    path.write_text("interval [s]\n" + column(wrong))
    with pytest.raises(Refused, match="follows one of"):
        fit(path)
    with pytest.raises(Refused, match="no line 99"):
        fit(path, leave_out=(99,))
    found = fit(path, leave_out=(5,))
    assert len(found.impacts.speed) == 4
    assert found.restitution == pytest.approx(0.82, abs=1e-3)


TWO = "Drop (cm),Rebound (cm)\n50,32\n60,38\n70,45"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("# title: nothing", "is empty"),
        ("a,b\nx,y", "no line of numbers"),
        ("Drop,Rebound\n50 cm,32 cm", "no line of numbers; units belong to the headings"),
        (
            '"Time 1 (s)","Time 2 (s)","Time 3 (s)"\n0.9,0.72,0.576\n0.95,0.76,0.61',
            "each line or each column may be a recording",
        ),
        (
            "a,b\n1,2",
            "no bounces, as 'a' is not known, 'b' is not known: write .* drop_height and rebound_h",
        ),
        ("Fallhöhe (m),Sprung (m)\n2,1\n1,0.5", "'Fallhöhe' is height before, 'Sprung' is not k"),
        ("time\n20h 45\n21h 17", "seconds, mm:ss.s, hh:mm:ss.s or 2024-05-01T12:00:00.25"),
        ('{"time": {"0": 0.45, "1": 1.17, "2": 1.75}}', "no recording: .* columns such"),
        ('{"time": "0.45 1.17 1.75"}', "no recording: .* columns such"),
        ('{"time": [[0.45, 1.17], [1.75]]}', "no recording: .* columns such"),
        ("[0.45, 1.17, 1.75]", "recording.csv is no recording: .* or columns such as {'time"),
        ("h0,h1\n50,33\n75,50", "without a unit"),
        ("h0 [bananas],h1 [m]\n50,33", "bananas"),
        ("time\n812\n1707\n2200", r"is it in ms\? write \(ms\) behind the heading"),
        ("height A,height B\n1,0.8\n0.64,0.5", "two columns are both taken as height"),
        ("time,height A,height B\n0,1,0.8\n0.5,0,0.1\n0.9,0.5,0", "two columns are both taken as"),
        ("height 1,height 2\n1,0.8\n0.64,0.5", "each line or each column may be a recording"),
        (
            "drop height,time\n1,1.1\n0.8,1\n0.7,0.9",
            "'drop height' is height before, 'time' is time: w",
        ),
        ("drop height (cm),COR\n20,0.8\n30,0.79", "'COR' is coefficient: .* speed and COR"),
        ('h0 (mm),h1 (mm)\n"1,000","640"', "'1,000' may have thousands or decimals"),
        ("time\n1\n1.7\n2.2\n0.3\n1.2\n1.8", "sort the lines, or leave an empty line where"),
        ("interval [s]\n0.5\n0.7\n0.6", "follows one of"),
        ("interval [s]\n0.5\n-0.4", "not positive"),
        ("height [m]\n0.5\n0.7\n0.6", "follows one of"),
        ("height [m]\n500\n300\n200", "is it in cm"),
        ("time [s]\n0.1\n0.9\n1.5\n1.2\n2", "line 5: the time is not after .* sort"),
        ("t,y\n" + "\n".join(reversed(track().split("\n"))), "line 3: the time .* sort"),
        ("interval [s]\n0.5\n0.4\n#\n0.45", "line 5: a flight of 0.45 s follows one of 0.4 s"),
        ("time,height\n0.1,0.5\n0.2,0.7\n0.3,0.6", "3 lines of a track or a signal are too few"),
        ("height [cm]\n50\n-4", "line 3: a height of -0.04 m is not positive"),
        ("speed,COR\n1,81", "line 2: .* is it in %"),
        ("speed,COR,std (cm)\n1,0.8,0.1", "std.*does not fit"),
        ("speed,COR\n1,1.04\n2,1.041\n3,1.04\n4,1.041", "above 1 by more than its error"),
        ("# contact time: 0.6 s\ntime [s]\n0.1\n0.9\n1.4\n1.8", "contact time: 600 ms is longer"),
        ("# contact time: 300 ms\ntime [s]\n" + column(TIMES), "300 ms is longer than flights are"),
        ("# mass: 58 g\n# diameter: 6.7\ntime [s]\n" + column(TIMES), "58 g .* 6.7 m .* density"),
        ("# mass: 58\n# diameter: 67 mm\ntime [s]\n" + column(TIMES), "is a unit missing"),
        ("v_in,v_out\n1,2\n1,2", "exchanged"),
        ("v_in,v_out\n400,200\n300,200", "is it in cm/s"),
        ("speed,COR\n1,1.5", "restitution coefficient of 1.5"),
        ("drop [m],rebound [m]\n0.5,0", "line 2: a height of 0 m is not positive"),
        ("drop [m],rebound [m]\n0.5,0.7", "line 2"),
        ("speed,COR,std\n1,0.8,0.1\n2,0.8,", "each impact needs an uncertainty"),
        ("time [s]\n0.1\n0.9", "no impact lies between"),
        ("1.0\n0.64\n0.41\n0.26", "a column without a heading is taken as times .* write a head"),
        ("0.82\n0.81\n0.8\n0.82", "a column without a heading is taken as times"),
        (TWO + "\n\nDrop (in),Rebound (in)\n5,3.2", "line 6 is a second heading"),
        ("golf\n" + TWO + "\n\ntennis\nDrop (cm),Rebound (cm)\n5,3", "line 8 is a second head"),
        ("time,z\n" + track(slow=1000), "line 5: a flight of .* is it in ms"),
        ("time,z\n" + track("{:.0f},{:.5f}", slow=1e9), "line 5: a flight of .* is it in ms"),
        ("t (s),y (m)\n" + track(slow=32), "of 26.*, or divide times of slow motion by its fac"),
        ("time (s)\n" + column(TIMES / 86400, "{:.10f}"), "line 3: .* small: .* such as .days"),
        ("drop (m),rebound (m)\n1e-300,1e-12\n1,0.5", "line 2: a height of .* is too small"),
        ("time;X;Y\n0:00:00:00;0,1;0,9\n0:00:00:01;0,1;0,8", "0 lines .* times are in seconds"),
        ("Drop height (m),h2/h1\n1,0.5\n2,0.6", "'h2/h1' is no reading, but derived"),
        ("v (m/s),restitution (energy)\n1,0.5\n2,0.6", "'restitution .energy.' is not used"),
        ("t,y1,y2\n" + track("{0:.4f},{1:.5f},{1:.5f}"), "as position, 'y1' and 'y2': .* several"),
        ("t,ball A,ball B\n" + track("{0:.4f},{1:.5f},{1:.5f}"), "evenly spaced times .* of what"),
        ("t\ty\n0.1\t1\n0.2\t1", "too few"),
    ],
)
def test_other_files_are_refused_in_one_line(text, said, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(text)
    with pytest.raises(Refused, match=said) as refused:
        fit(path)
    assert "\n" not in str(refused.value)


def test_what_is_no_text_is_refused(tmp_path):
    path = tmp_path / "picture.png"
    path.write_bytes(bytes(range(256)) * 20)
    with pytest.raises(Refused, match="no text and no spreadsheet"):
        fit(path)


def test_every_published_experiment_names_its_source():
    assert len(experiments()) == 12
    for name in experiments():
        head = read(name).head
        assert {"title", "measured by", "published", "source", "read"} <= head.keys()


def test_what_is_no_file_is_refused():
    with pytest.raises(Refused, match="list is no recording: give a file, .* columns such"):
        fit([1, 2, 3])


def test_balls_side_by_side_are_all_read(tmp_path):
    path = tmp_path / "heard.csv"
    path.write_text(FILES["two balls side by side"])
    assert len(fit(path).recording.chains) == 2


def test_columns_are_read_as_those_of_a_file():
    heights = np.array([50, 75, 100, 125])
    columns = {"drop height (cm)": heights, "rebound height (cm)": [*(0.6724 * heights[:3]), None]}
    found = fit(columns)
    assert found.restitution == pytest.approx(0.82, abs=1e-9)
    assert found.impacts.speed == pytest.approx(np.sqrt(2 * G * heights[:3] / 100))
    with pytest.raises(Refused, match="columns differ in length: 2, 1 cells"):
        fit({"drop": [1, 2], "rebound": [0.5]})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (FILES["picture, y negative"], "downwards, as in a picture"),
        (
            "drop [m],rebound [m]\n1,0.64\n0.5,\n\n0.8,0.5\n0.9,nan",
            "missing in line 3, 4, 6, which",
        ),
        (FILES["two lines of heights"], "missing in line 3, which"),
        (
            "n,Zeit (s),Δt (s),r\n1,0.1,,\n2,0.9,0.8,\n3,1.54,0.64,0.8\n4,2.052,0.512,0.8",
            "columns not used: 'Δt', 'r'",
        ),
        (FILES["picture, pixels"], r"gravity, 68\d\d px/s² in this track, is the scale"),
        (FILES["times without a heading"], "no heading: taken as times in s"),
        (
            "Temperature (°C),n,Drop (cm),Rebound (cm)\n5,1,50,20\n20,1,50,30\n40,1,50,32",
            "columns not used: 'Temperature'$",
        ),
        ("Ball mass (g),drop (m),rebound (m)\n46,1,0.64\n58,1,0.5", "not used: 'Ball mass'"),
        (
            "Masse in g,Durchmesser/mm,drop (m),up (m)\n2.7,40,1,0.6\n,,0.9,0.6\n2.7,40,1,0.6",
            "drag of the air is removed, 0.13 of",
        ),
        (
            "drop (cm),± (cm),rebound (cm),± (cm)\n50,0.5,32,1\n60,0.5,38,1",
            "errors of readings .* --resolution",
        ),
        ("# uncertainty: 5 mm\n" + TWO, "the head has 'uncertainty: 5 mm'"),
        (FILES["heard, with a contact time"], "the contact, 8 ms, is taken off"),
        (FILES["force plate with a row of units"], "the contact, 7.[789]"),
        # 8 ms move r by 0.0024 here.
        ("time [s]\n" + column(TOUCHES), "lower by 0.0003 for each ms that it lasts"),
        (
            "# radius: 33 mm\n# gravity = 9.79 m/s^2\n# date: 2024-05-03\n" + FILES["times"],
            "the head has 'radius: 33 mm', 'gravity: 9.79 m/s.2', but only mass, diameter",
        ),
        (
            "t (s),y (m)\n" + track(slow=8),
            "gravity is 0.153 m/s² .* the times are 8 times the true ones",
        ),
        ("speed,COR\n1,1.02\n2,0.98\n3,1.03\n4,0.98", "above 1 within its error"),
    ],
)
def test_a_note_says_what_was_done(text, said, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(text)
    assert [note for note in fit(path).notes if re.search(said, note)]


def test_heights_that_agree_with_gravity_are_not_remarked(tmp_path):
    path = tmp_path / "track.csv"
    path.write_text(FILES["track, time and height"])
    assert not [note for note in fit(path).notes if "true ones" in note]


def test_a_track_is_turned_only_if_it_grows_downwards(tmp_path):
    path = tmp_path / "track.csv"
    for name in ("track, time and height", "Tracker, rounded times"):
        path.write_text(FILES[name])
        assert not [note for note in fit(path).notes if "picture" in note]
    path.write_text(FILES["track, time and height"])
    upwards = fit(path).impacts
    path.write_text(FILES["picture, y from above"])
    assert fit(path).impacts.log_r == pytest.approx(upwards.log_r, abs=1e-4)
    assert fit(path).impacts.speed == pytest.approx(upwards.speed, rel=1e-4)


def test_a_force_that_rings_on_shows_no_contact(tmp_path):
    path = tmp_path / "plate.csv"
    since = PULSES - TOUCHES[np.searchsorted(TOUCHES, PULSES, side="right") - 1]
    force = np.where(since >= 0, 50 * np.exp(-since / 0.03), 0)
    path.write_text("time (s),force (N)\n" + "\n".join(map("{:.4f},{:.3f}".format, PULSES, force)))
    notes = fit(path).notes
    assert any("7 impacts were found" in note for note in notes)
    assert not any("taken off" in note for note in notes)


def test_a_contact_time_is_taken_off_flights(tmp_path):
    path = tmp_path / "heard.csv"
    path.write_text("time [s]\n" + column(TOUCHES))
    as_heard = fit(path)
    corrected = fit(path, contact_time="8 ms")
    assert as_heard.restitution > 0.822
    assert corrected.restitution == pytest.approx(0.82, abs=1e-5)
    assert corrected.impacts.speed == pytest.approx(G * FLIGHTS[:-1] / 2, rel=1e-5)
    # The note has the slope of r by the duration.
    found = next(note for note in as_heard.notes if "each ms" in note)
    slope = float(re.search(r"lower by (\S+)", found)[1])
    assert (as_heard.restitution - 0.82) / 8 == pytest.approx(slope, rel=0.2)


def test_an_empty_line_divides_a_series(tmp_path):
    """Flights on both sides of it were compared."""
    path = tmp_path / "two.csv"
    path.write_text("time [s]\n\n0.1\n0.9\n1.5\n\n0.2\n1.0\n1.6\n\n")
    found = read(path)
    assert [list(chain) for chain in found.chains] == [pytest.approx([0.8, 0.6])] * 2
    assert found.notes == (
        "a number is missing in line 6, which is left out and divides the series",
    )
    # An empty line after each line is a way to write files.
    path.write_text("time [s]\n\n0.1\n\n0.9\n\n1.5\n\n1.95\n\n")
    assert list(read(path).chains[0]) == pytest.approx([0.8, 0.6, 0.45])
    assert not read(path).notes


def test_a_ball_that_is_held_and_lies_at_last_is_followed_in_between(tmp_path):
    """A parabola through the held ball gave r = 0.65 for 0.82; the ball at rest was refused."""
    held = [f"{t:.4f},{position(0):.5f}" for t in np.arange(-60, 0) / 60]
    lying = [f"{t:.4f},0" for t in FRAMES[-1] + np.arange(1, 61) / 60]
    path = tmp_path / "track.csv"
    path.write_text("\n".join(["t,y", *held, track(), *lying]))
    found = fit(path)
    assert np.abs(found.impacts.restitution - 0.82).max() < 1e-3
    assert len(found.impacts.speed) == 6


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time,KE\n" + track(), "evenly spaced times are those of samples"),
        ("t,x,y,x,y\n0,0,1,0,1\n1,0,2,0,2", "two columns are both taken as position"),
        ("time A,time B\n0.1,0.2\n0.9,1\n1.5,1.7", "two columns are both taken as time"),
        ("t,y\n0,2\n" + "\n".join(f"{t + 9:.4f},{position(t):.5f}" for t in FRAMES), "a gap in"),
        ("v,COR,duration\n1,0.8,5\n2,0.8,4", "a contact time of 5 s .* is it in ms"),
    ],
)
def test_what_would_give_a_wrong_r_is_refused(text, said, tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text(text)
    with pytest.raises(Refused, match=said):
        fit(path)


def test_an_uncertainty_is_one_of_r(tmp_path):
    """It was 100 % of an r in per cent, and an r of the heights beside it."""
    path = tmp_path / "recording.csv"
    path.write_text("speed,COR (%),std\n1,80,1\n2,79,1")
    assert read(path).uncertainty == pytest.approx([0.01, 0.01])
    path.write_text("speed,COR,uncertainty of duration (ms)\n1,0.8,1\n2,0.79,1")
    assert read(path).uncertainty is None
    path.write_text("drop,rebound,std\n1,0.64,0.01\n0.5,0.32,0.01")
    assert read(path).uncertainty is None


def test_a_name_stands_for_the_empty_cells_below_it(tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text("ball,time\nA,0.1\n,0.9\n\n,1.5\n,2.0\nB,0.2\n,1.0")
    assert [list(each) for each in read(path).chains] == [
        pytest.approx([each]) for each in (0.8, 0.5, 0.8)
    ]


def test_kilometres_per_hour_are_not_metres_per_second(tmp_path):
    """Behind a slash or an underscore they were."""
    path = tmp_path / "recording.csv"
    for heading in ("v_in/km/h,v_out/km/h", "v_in_km/h,v_out_km/h", "v_in (km/h),v_out (km/h)"):
        path.write_text(heading + "\n3.6,2.88\n7.2,5.76")
        assert read(path).chains[0] == pytest.approx(np.array([[1, 0.8], [2, 1.6]]))


def test_a_line_that_is_left_out_divides_a_named_recording(tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text("recording,height\n1,1\n1,0.7\n1,0.5\n1,0.35")
    chains = read(path, leave_out=(4,)).chains
    assert [list(each) for each in chains] == [[1, 0.7], [0.35]]


def test_a_torn_line_divides_the_recording_in_which_it_is(tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text("recording,height\n1,1\n1,0.7\nx,x\n1,0.35\n1,0.25\n2,1\n2,0.7")
    assert [list(each) for each in read(path).chains] == [[1, 0.7], [0.35, 0.25], [1, 0.7]]


def test_headings_in_quotes_are_read_between_spaces(tmp_path):
    """The number of the line was taken for a time."""
    path = tmp_path / "recording.csv"
    path.write_text('no "flight time/ms"\n1 900\n2 720\n3 576')
    assert fit(path).restitution == pytest.approx(0.8, abs=1e-6)


DROPS = {"drop height (m)": [1.0, 1.5, 2.0], "rebound height (m)": [0.64, 0.96, 1.28]}
DERIVED = (
    "rebound ratio | height lost (m) | predicted rebound (m) | theoretical rebound height (m) "
    "| rebound height squared | sqrt rebound height | rebound (%) | loss of height (m) "
    "| log rebound height | expected rebound (m) | bounce efficiency | h² | berechnete Höhe (m)"
)


@pytest.mark.parametrize("more", DERIVED.split(" | "))
def test_what_was_computed_is_no_reading(more):
    """With a column of ratios r was 0.818, with one of predictions 0.841, where it is 0.8."""
    found = fit(DROPS | {more: [0.9, 0.8, 0.7]})
    assert found.restitution == pytest.approx(0.8, abs=1e-6)
    assert any("columns not used: " in note for note in found.notes)
    with pytest.raises(Refused, match="is no reading, but derived"):
        fit({"drop height (m)": DROPS["drop height (m)"], more: [0.9, 0.8, 0.7]})


@pytest.mark.parametrize("more", ["COR^2", "COR²", "1-e", "e squared", "velocity ratio"])
def test_what_was_made_of_r_is_not_r(more):
    """The square of r was taken for r: 0.64 for 0.8."""
    with pytest.raises(Refused, match="is no reading, but derived"):
        fit({"impact velocity (m/s)": [1, 2, 3], more: [0.64, 0.64, 0.64]})


@pytest.mark.parametrize("heading", ["calculated COR", "restitution coefficient, ratio"])
def test_a_coefficient_is_always_computed(heading):
    found = fit({"impact velocity (m/s)": [1, 2, 3], heading: [0.8] * 3})
    assert found.restitution == pytest.approx(0.8, abs=1e-6)


@pytest.mark.parametrize(
    "headings",
    [
        ("rebound on wood (m)", "rebound on carpet (m)"),
        ("rebound height 20C (m)", "rebound height 5C (m)"),
        ("rebound golf (m)", "rebound tennis (m)"),
    ],
)
def test_conditions_side_by_side_are_no_successive_bounces(headings):
    """They were taken for bounces 1 and 2: r was 0.755 where it is 0.8 and 0.566."""
    others = dict(zip(headings, ([0.64, 0.96, 1.28], [0.32, 0.48, 0.64]), strict=True))
    with pytest.raises(Refused, match="two columns are both taken as height after"):
        fit({"drop height (m)": [1.0, 1.5, 2.0]} | others)


@pytest.mark.parametrize("form", ["bounce {}", "{} bounce height"])
def test_headings_that_count_are_successive_bounces(form):
    counts = ("1", "2") if form.startswith("b") else ("first", "second")
    heights = np.array([1.0, 1.5, 2.0])
    found = fit(
        {"drop height (m)": heights}
        | {f"{form.format(n)} (m)": heights * 0.64**i for i, n in enumerate(counts, 1)}
    )
    assert (found.recording.kind, len(found.impacts.speed)) == ("heights", 6)
    assert found.restitution == pytest.approx(0.8, abs=1e-6)


def test_trials_have_another_unit_than_the_drop():
    """Centimetres were compared with metres: the trials were taken for successive bounces."""
    trials = {"Trial 1 (cm)": [16.4, 32.4, 47.9], "Trial 2 (cm)": [15.7, 31.2, 48.4]}
    found = fit({"Drop height (m)": [0.25, 0.5, 0.75]} | trials)
    assert found.recording.kind == "drops"
    assert found.restitution == pytest.approx(0.8, abs=0.01)


def test_names_that_are_pooled_are_said():
    """Golf and tennis balls with 0.8 and 0.7 were given as 0.751 without a word."""
    balls = {"Ball": ["Golf", "Golf", "Tennis", "Tennis"]}
    heights = {"Drop height (m)": [1, 1.5, 1, 1.5], "Rebound height (m)": [0.64, 0.96, 0.49, 0.735]}
    assert "Ball has Golf, Tennis: one r is fitted to all of them" in fit(balls | heights).notes
    assert not any("all of them" in note for note in fit(heights).notes)


@pytest.mark.parametrize("head", ["# drop height: 1 m", "Drop height = 100 cm"])
def test_a_drop_height_in_the_head_is_that_of_all_rebounds(head, tmp_path):
    path = tmp_path / "rebounds.csv"
    path.write_text(f"{head}\ntrial,Rebound (cm)\n1,64\n2,62\n3,66\n4,64\n")
    found = read(path)
    assert found.kind == "drops"
    assert np.concatenate(found.chains)[:2] == pytest.approx(np.array([[1, 0.64], [1, 0.62]]))
    path.write_text(f"{head}\nbounce,Rebound (cm)\n1,64\n2,41\n3,26\n")
    with pytest.raises(Refused, match="fall on as those of one ball"):
        read(path)


def test_a_missed_impact_is_refused_with_its_line(tmp_path):
    """Its r of 0.36 was pooled with those of 0.8."""
    flights = 0.7 * 0.8 ** np.arange(8)
    times = np.cumsum([0.2, *flights])
    path = tmp_path / "heard.csv"
    path.write_text("time (s)\n" + column(np.delete(times, 1)))
    with pytest.raises(Refused, match="line 3: a flight of 1.26 s.* an impact is missing within"):
        fit(path)
    assert fit(path, leave_out=(3,)).restitution == pytest.approx(0.8, abs=1e-4)


def test_of_components_that_with_the_impacts_is_read():
    times = PULSES[::5]
    pushes = np.array([push(t) for t in times])
    noise = np.sin(77777 * times)
    names = [f"Acceleration {axis} (m/s^2)" for axis in "xyz"]
    for i, name in enumerate(names):
        columns = {"Time (s)": times} | dict.fromkeys(names, noise)
        found = fit(columns | {name: pushes})
        # The contact of 8 ms stays in the flights.
        assert found.restitution == pytest.approx(0.8225, abs=1e-3)
        others = ", ".join(f"'Acceleration {axis}'" for axis in "xyz" if axis != "xyz"[i])
        assert f"columns not used: {others}" in found.notes
    # As phyphox exports them.
    absolute = {"Absolute acceleration (m/s^2)": np.abs(pushes)}
    again = fit(columns | {name: pushes} | absolute)
    assert again.restitution == pytest.approx(found.restitution)


def test_of_a_log_of_an_engine_the_vertical_position_is_read():
    """The horizontal one was, or the speed."""
    up = np.array([position(t) for t in FRAMES])
    columns = {"time": FRAMES, "qpos_x": 0 * up, "qpos_y": 0 * up, "qpos_z": up}
    found = fit(columns | {"qvel_z": np.gradient(up, FRAMES)})
    assert found.restitution == pytest.approx(0.82, abs=1e-3)


@pytest.mark.parametrize(
    "heading", ["Distance (m)", "Displacement (m)", "Run 1: Position (m)", "cy", "pos_z"]
)
def test_motion_detectors_and_trackers_have_positions(heading):
    up = np.array([position(t) for t in FRAMES])
    columns = {"Run 1: Time (s)": FRAMES, heading: up, "Latest: Velocity (m/s)": np.gradient(up)}
    found = fit(columns | {"Latest: Acceleration (m/s²)": 0 * up})
    assert found.restitution == pytest.approx(0.82, abs=1e-3)


def test_a_track_says_how_many_impacts_are_left_out():
    """The last flight of this one has three positions."""
    kept = TIMES[2] + 0.06 > FRAMES
    found = fit({"t": FRAMES[kept], "y": np.array([position(t) for t in FRAMES[kept]])})
    assert any("2 of 3 impacts were found" in note for note in found.notes)


def test_a_head_without_signs_above_the_headings_names_the_ball(tmp_path):
    path = tmp_path / "sheet.csv"
    lines = ["Lab 3: bouncing ball,,", "Mass,46,g", "Diameter,43,mm", ",,"]
    lines += ["Drop height (cm),Trial 1 (cm),Trial 2 (cm)", "100,64,65", "150,96,95"]
    path.write_text("\n".join(lines))
    found = read(path)
    assert (found.head["mass"], found.head["diameter"]) == ("46 g", "43 mm")
    assert len(found.chains[0]) == 4
    # Numbers above are no head.
    path.write_text("time (s)\n0.1\n0.9\n1.5\n\ndrop height,rebound height\n1,0.64")
    assert list(read(path).chains[0]) == pytest.approx([0.8, 0.6])


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("croqet", "none of the experiments: did you mean croquet"),
        ("zzz", "did you mean blue_marble or bouncy_ball or"),
        ("", "is a directory: give a file in it"),
    ],
)
def test_what_is_no_recording_is_said(source, said, tmp_path):
    with pytest.raises(Refused, match=said):
        fit(source or tmp_path)


def test_what_cannot_be_read_is_said(tmp_path):
    path = tmp_path / "recording.csv"
    path.write_text("frame,x_px,y_px\n0,3,1\n1,3,2")
    with pytest.raises(Refused, match="'frame' is a time with a line '# fps: 240' only, 'x' is"):
        fit(path)
    path.write_text("drop,rebound\n1,0.6\n2,1.2")
    with pytest.raises(Refused, match="no line that is not left out has numbers in drop, rebound"):
        fit(path, leave_out=(2, 3))
    path.write_text("time (s)\n0\n0.4516\n1.1742\n1.7544")
    with pytest.raises(Refused, match="the first time is that of the release"):
        fit(path)


@pytest.mark.parametrize(
    "head",
    [
        "mass: 2.7 g\ndiameter: 40 mm",
        "mass = 2.7 g\ndiameter = 40 mm",
        "% mass: 2.7 g\n% diameter: 40 mm",
        "// mass: 2.7 g\n// diameter: 40 mm",
        "; mass: 2.7 g\n; diameter: 40 mm",
        '"Mass: 2.7 g"\n"Diameter: 40 mm"',
        "Mass: 2.7 g, Diameter: 40 mm",
        "mass (g),2.7\ndiameter (mm),40",
        "# Masse: 2.7 g\n# Durchmesser: 40 mm",
        "# masse: 2.7 g\n# diamètre: 40 mm",
        "# ball mass: 2.7 g\n# ball diameter: 40 mm",
        "Mass of ball,2.7 g\nDiameter of ball,40 mm",
        "# mass [g]: 2.7\n# diameter [mm]: 40",
        "# mass: 2.7 ± 0.1 g\n# diameter: 40 mm (caliper)",
        "# mass: 2.7 g, diameter: 40 mm",
    ],
)
def test_the_head_is_read_as_people_write_it(head, tmp_path):
    path = tmp_path / "drops.csv"
    path.write_text(f"{head}\n{TWO}")
    found = read(path).head
    assert (found["mass"], found["diameter"]) == ("2.7 g", "40 mm")


@pytest.mark.parametrize("r", [0.35, 0.5])
def test_a_release_is_refused_if_the_ball_bounces_little_too(r, tmp_path):
    """The fall is half a flight: r of 0.5 was 0.56."""
    flights = 0.9 * r ** np.arange(4)
    path = tmp_path / "heard.csv"
    path.write_text("time (s)\n" + column(np.cumsum([0, flights[0] / r / 2, *flights])))
    with pytest.raises(Refused, match="line 3: a flight of .* begins with the release"):
        fit(path)
    assert fit(path, leave_out=(2,)).restitution == pytest.approx(r, abs=1e-4)


def test_flights_are_free_of_contact_and_intervals_are_not():
    """With the contact taken off flights r was 0.817."""
    touches = {"contact time (ms)": [8] * len(FLIGHTS)}
    for heading, lasting in (("flight", 0), ("air time", 0), ("interval", CONTACT)):
        column_of = {f"{heading} (s)": FLIGHTS + lasting}
        for found in (fit(touches | column_of), fit(column_of, contact_time="8 ms")):
            assert found.restitution == pytest.approx(0.82, abs=1e-6)
            assert any("is taken off" in note for note in found.notes) == (lasting > 0)


def test_impacts_that_may_lie_between_samples_are_refused():
    """Of nine impacts three were found: r was 0.43 for 0.9."""
    t = np.arange(0, TIMES[-1] + 0.2, 1 / 400)
    near = np.abs(t[:, None] - TIMES).min(axis=1)
    with pytest.raises(Refused, match="impacts have one sample each"):
        fit({"time (s)": t, "acceleration (m/s^2)": 900 * np.maximum(1 - near / 0.0015, 0)})


@pytest.mark.parametrize(("rate", "noise"), [(240, 0.008), (480, 0.008)])
def test_noise_of_many_frames_hides_no_impacts(rate, noise):
    """It turned tracks upside down, at random."""
    t = np.arange(0, TIMES[-1] - 0.05, 1 / rate)
    exact = np.array([position(each) for each in t])
    rng = np.random.default_rng(7)
    for _ in range(4):
        found = fit({"t (s)": t, "y (m)": exact + noise * rng.normal(size=len(t))})
        assert found.restitution == pytest.approx(0.82, abs=0.01)
        assert not any("turned" in note for note in found.notes)


def test_a_count_of_intervals_is_none(tmp_path):
    """As phyphox exports a stopwatch: the count was read as intervals in s."""
    path = tmp_path / "stopwatch.csv"
    lines = [f"{i},{x:.6f}" for i, x in enumerate(FLIGHTS, 1)]
    path.write_text("\n".join(['"Interval","Time (s)"', *lines]))
    assert fit(path).restitution == pytest.approx(0.82, abs=1e-4)
    assert not read(path).notes
    with pytest.raises(Refused, match="no column of intervals"):
        read(path, intervals=True)


@pytest.mark.parametrize("heading", ["±", "+/-", "+-", "Standardabweichung", "sigma_e"])
def test_a_column_of_errors_is_one_of_r(heading):
    columns = {"v (m/s)": [1.0, 2, 3], "COR": [0.8, 0.79, 0.8], heading: [0.01, 0.02, 0.01]}
    assert read(columns).uncertainty == pytest.approx([0.01, 0.02, 0.01])


def test_a_column_may_be_a_quantity():
    flights = [0.72, 0.58, 0.465, 0.372]
    of_numbers = read({"interval (s)": flights})
    for heading in ("interval (s)", "interval"):
        found = read({heading: 1000 * np.array(flights) * pint.Unit("ms")})
        assert found.chains[0] == pytest.approx(of_numbers.chains[0])


def test_errors_within_cells_are_said_to_be_left():
    cells = {"v (m/s)": [1, 2, 3], "COR": ["0.80 ± 0.01", "0.79 ± 0.01", "0.80 ± 0.01"]}
    assert any("errors in cells are not used" in note for note in read(cells).notes)
    assert not read({**cells, "COR": [0.8, 0.79, 0.8]}).notes
