"""The command line: every command, its files, and mistakes in one line."""

import csv
import runpy
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from bouncing_ball_beyond.cli import commands, main

LAW = "--law tsuji --restitution 0.85 --set duration=0.1 --set speed=3 --amplitude 1"
SHAKER = "--frequency 50Hz --acceleration 0.8g --stiffness 1e7N/m --restitution 0.85"
TWO = "--harmonic 1 1 0 --harmonic 3 0.05 -1.1"
RIGID = "--restitution 0.65 --amplitude 1"
SPRING = f"{RIGID} --frequency-ratio 80"
ANSWERS = {
    f"orbit {RIGID}": ["0.841428", "5.6804"],
    f"orbit {SPRING} --side unstable": ["stable", "False"],
    f"orbit {SPRING} --corrected": ["PeriodicOrbit"],
    "limits --restitution 0.65": ["saddle-node", "0.666398", "period doubling", "1.2394"],
    "follow --restitution 0.85 --amplitude 1 --to 1.3": ["period doubling at 1.0383042"],
    "follow --restitution 0.85 --amplitude 1 --to 1.3 --doublings 1": [
        "impacts         2",
        "1.3 is reached",
    ],
    "follow --restitution 0.5 --amplitude 1.6 --phase 1 --velocity -3 --to 1.61": ["impacts"],
    "curve --restitution 0.5 --amplitude 1.4 --to 1.8 --kind period-doubling --across restitution"
    " --range restitution 0.4 0.6": ["period doubling"],
    f"simulate {RIGID} --impacts 4": ["impact_velocity"],
    "motion --restitution 0.5 --amplitude 1.6": ["kind                periodic", "periods"],
    "diagram --restitution 0.5 --amplitude 1.5 1.6 --points 2": ["1.5", "periodic"],
    f"thresholds {RIGID} --corrected": ["82.178", "82.1774", "2.29014", "132.569"],
    f"error-law {SPRING} --corrected": ["-0.01027", "-7.545e-06"],
    "error-law --law tsuji --restitution 0.85 --set duration=0.1 --set speed=3 --amplitude 1": [
        "-0.02579"
    ],
    f"shaker --mass 20g {SHAKER}": ["558.9 µm", "is not good enough"],
    # Two frequencies, from an implementation that shares no code.
    f"limits --restitution 0.9 {TWO}": ["period doubling", "0.858168"],
    f"limits --restitution 0.9 --frequency-ratio 100 {TWO}": ["0.85895"],
    f"follow --restitution 0.9 --amplitude 0.7 --to 1 {TWO}": ["period doubling at 0.8581675"],
    f"simulate {RIGID} --impacts 4 {TWO}": ["impact_velocity"],
    f"motion --restitution 0.5 --amplitude 1 {TWO}": ["kind                periodic"],
    f"error-law {SPRING} {TWO}": ["max height"],
    f"shaker --mass 20g {SHAKER} {TWO}": ["good enough"],
    "curve --help": ["--across", "--harmonic", "--law"],
}


@pytest.mark.parametrize("line", ANSWERS)
def test_answers(line, capsys):
    with pytest.raises(SystemExit) as ended:
        main(line.split())
    output = capsys.readouterr()
    assert (ended.value.code, output.err) == (0, "")
    for text in ANSWERS[line]:
        assert text in output.out


MISTAKES = {
    f"orbit {RIGID} --frequency-ratio -1": "--frequency-ratio = -1",
    f"orbit {RIGID} --frequency-ratio x": "--frequency-ratio",
    "orbit --restitution 0.65": "Missing option '--amplitude'",
    "orbit --amplitude 1": "Missing option --restitution or --law.",
    "orbit --restitution 0.65 --amplitude 0.3": "below the saddle-node at Λ = 0.666398",
    f"orbit {RIGID} --output orbit.txt": "--output",
    f"orbit {RIGID} --law hooke": "--law",
    f"orbit {RIGID} --law tsuji --set stiffness": "--set",
    f"orbit {RIGID} --set harmonic_3=0.05": "--set gives the parameters of a --law",
    f"orbit {RIGID} --highest-harmonic 5": "--highest-harmonic: is that of the samples",
    f"error-law {RIGID}": "--frequency-ratio: must be given",
    f"follow {RIGID} --to 2 --along hardness": "--along = 'hardness'",
    f"thresholds {RIGID} --tolerance 0": "--tolerance",
    f"shaker --mass 20g {SHAKER.replace('50Hz', '50m')}": "--frequency = '50m'",
    f"shaker {SHAKER}": "--mass",
    "shaker --mass 20g": "Missing options --frequency, --restitution.",
    "orbit": "Missing options --amplitude, --restitution or --law.",
    f"orbit {RIGID} --harmonic 0 1 0": "--harmonic: (0, 1.0, 0.0): must be",
    f"orbit {RIGID} --table nowhere.csv": "nowhere.csv",
    f"follow {RIGID}": "Missing option '--to'",
    "fly": "fly",
}


@pytest.mark.parametrize("line", MISTAKES)
def test_mistakes_are_one_line(line, capsys):
    with pytest.raises(SystemExit) as ended:
        main(line.split())
    output = capsys.readouterr()
    assert ended.value.code == 2 and output.out == ""
    assert output.err.startswith("bouncing-ball: ") and output.err.count("\n") == 1
    assert MISTAKES[line] in output.err


def test_the_package_runs_as_the_command(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["bouncing_ball_beyond", *f"orbit {RIGID}".split()])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("bouncing_ball_beyond", run_name="__main__")
    assert ended.value.code == 0 and "max_height" in capsys.readouterr().out


def printed(capsys, *arguments):
    """What a command prints on both streams."""
    with pytest.raises(SystemExit):
        main(list(arguments))
    return "".join(capsys.readouterr())


@pytest.mark.parametrize("name", ["height", "acceleration"])
def test_table_of_recorded_samples(name, tmp_path, capsys):
    tau = 2 * np.pi * np.arange(64) / 64
    sign = -1 if name == "acceleration" else 1
    lines = [f"{sample:.17g}" for sample in sign * np.sin(tau)]
    file = tmp_path / "period.csv"
    file.write_text("\n".join([f"time,{name}", *(f"0,{line}" for line in lines)]))
    line = f"orbit {RIGID}".split()
    recorded = printed(capsys, *line, "--table", str(file))
    known = printed(capsys, *line).splitlines()
    assert set(known) <= set(recorded.splitlines())
    file.write_text(f"{name}\n0\n1\nx\n0")
    assert "line 4: 'x' is no number" in printed(capsys, *line, "--table", str(file))
    file.write_text("0\n1\n0\n-1")
    assert "must have a first line with height or acceleration" in printed(
        capsys, *line, "--table", str(file)
    )
    noise = np.random.default_rng(1).normal(0, 0.002, 64)
    rough = [f"{sample:.17g}" for sample in np.sin(tau) + noise * np.array([1, -1] * 32)]
    file.write_text("\n".join(["height", *rough]))
    noisy = [*line, "--table", str(file)]
    assert "give the highest harmonic that is meant" in printed(capsys, *noisy)
    assert "stable" in printed(capsys, *noisy, "--highest-harmonic", "3")
    both = [*line, *TWO.split(), "--table", str(file)]
    assert "--harmonic, --table: at most one of them may be given" in printed(capsys, *both)


def test_files(tmp_path, capsys):
    line = "follow --restitution 0.85 --amplitude 1 --to 1.3 --output"
    for name in ("branch.nc", "branch.csv", "branch.png"):
        with pytest.raises(SystemExit) as ended:
            main([*line.split(), str(tmp_path / name)])
        assert ended.value.code == 0
    with xr.open_dataset(tmp_path / "branch.nc") as data:
        assert "period doubling" in data.kind.values
        points = data.sizes["point"]
    with open(tmp_path / "branch.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["point"] for row in rows} == {str(i) for i in range(points)}
    assert (tmp_path / "branch.png").read_bytes().startswith(b"\x89PNG")


def test_help_names_every_command(capsys):
    with pytest.raises(SystemExit) as ended:
        main([])
    output = capsys.readouterr().out
    assert ended.value.code == 0
    for name, command in commands.commands.items():
        assert f"\n  {name} " in output
        assert command.help.strip()
        assert all(option.help for option in command.params)


def test_help_imports_neither_numpy_nor_scipy():
    code = (
        "import sys, bouncing_ball_beyond.cli as cli\n"
        "try:\n    cli.main([])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'xarray', 'pint', 'matplotlib', 'numba'}\n"
        "sys.exit(', '.join(heavy & sys.modules.keys()) or 0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
