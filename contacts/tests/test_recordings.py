"""Files as instruments, programs and people write them."""

import io
import zipfile

import numpy as np
import pytest

from bouncing_ball_contacts import Refused, fit
from bouncing_ball_contacts.recordings import experiments, read

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


def pulse(t):
    return 9.0 if np.min(np.abs(t - TIMES)) < 5e-4 else 0.01 * np.sin(99 * t)


SPEEDS = (1.0, 2.0, 3.0, 4.0)
FILES = {
    "times": "time [s]\n" + column(TIMES),
    "times without a heading": column(TIMES),
    "intervals without a heading": column(FLIGHTS),
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
    "force plate with a row of units": "Time,Fz\ns,N\n"
    + "\n".join(f"{t:.4f},{pulse(t):.3f}" for t in PULSES),
}


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("coding", ["utf-8-sig", "utf-16"])
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


def spreadsheet(rows):
    """Return an xlsx file with shared strings, as programs write it."""
    texts = sorted({cell for row in rows for cell in row if isinstance(cell, str)})
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    lines = []
    for i, row in enumerate(rows, 1):
        cells = ""
        for letter, cell in zip("ABC", row, strict=False):
            if isinstance(cell, str):
                cells += f'<c r="{letter}{i}" t="s"><v>{texts.index(cell)}</v></c>'
            elif cell is not None:
                cells += f'<c r="{letter}{i}"><v>{cell}</v></c>'
        lines.append(f'<row r="{i}">{cells}</row>')
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as book:
        items = "".join(f"<si><t>{text}</t></si>" for text in texts)
        book.writestr("xl/sharedStrings.xml", f"<sst {space}>{items}</sst>")
        sheet = f"<worksheet {space}><sheetData>{''.join(lines)}</sheetData></worksheet>"
        book.writestr("xl/worksheets/sheet1.xml", sheet)
    return data.getvalue()


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


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("# title: nothing", "is empty"),
        ("a,b\nx,y", "no line of numbers"),
        ("a,b\n1,2", "no bounces in a, b"),
        ("h0,h1\n50,33\n75,50", "without a unit"),
        ("h0 [bananas],h1 [m]\n50,33", "bananas"),
        ("interval [s]\n812\n707", "is it in ms"),
        ("interval [s]\n0.5\n0.7\n0.6", "follows one of"),
        ("interval [s]\n0.5\n-0.4", "not positive"),
        ("height [m]\n0.5\n0.7\n0.6", "follows one of"),
        ("height [m]\n500\n300\n200", "is it in cm"),
        ("v_in,v_out\n1,2\n1,2", "exchanged"),
        ("v_in,v_out\n400,200\n300,200", "is it in cm/s"),
        ("speed,COR\n1,1.5", "above 1"),
        ("drop [m],rebound [m]\n0.5,0", "not both positive"),
        ("drop [m],rebound [m]\n0.5,0.7", "line 2"),
        ("speed,COR,std\n1,0.8,0.1\n2,0.8,", "each impact needs an uncertainty"),
        ("time [s]\n0.1\n0.9", "no impact lies between"),
        ("t\ty\n0.1\t1\n0.2\t1", "too short"),
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
