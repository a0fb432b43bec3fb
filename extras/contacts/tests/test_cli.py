"""The command as it is typed: answers, and one line for each mistake."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

BALL = 'design --mass "50 g" --restitution 0.8'
# A contact that is given is not searched for.
SHORT = f'{BALL} --contact-time "2 ms"'
MUJOCO = "diagnose --engine mujoco --mass 1 --time-step 2ms"
PYBULLET = "diagnose --engine pybullet --mass 1 --time-step 1/240"
RAPIER = "--engine rapier --time-step 1/60"
LAMMPS = "diagnose --engine lammps --mass 1 --time-step 2ms"


def test_the_first_sentence_that_one_types(typed):
    """It was refused, because --drop-height wanted a --rebound-height."""
    line = f'{BALL} --drop-height "1 m" --time-step "2 ms" --engine mujoco'
    status, out, err = typed(line)
    assert (status, err) == (0, "")
    assert out.startswith("mujoco, 2 ms: r = 0.8") or "(not 2 ms): r = 0.8" in out
    assert '\n<geom solref="-' in out and "\nNot for: " in out
    assert len(out.split()) < 80 and "Given: mass 50 g" in typed(f"{line} --explain")[1]


def test_everything_in_json(typed):
    answer = json.loads(typed(f"{SHORT} --engine pybullet --time-step 1/240 --json")[1])
    assert answer["outcome"]["rest"] > 0
    assert answer["parameters"]["contactStiffness"] > 0 and "changeDynamics" in answer["snippet"]
    answer = json.loads(typed(f"{MUJOCO} --restitution 0.5 --json")[1])
    assert answer["parameters"]["solref"] == [0.02, 1.0]
    answer = json.loads(typed("fit croquet --engine pybullet --time-step 1/240 --json")[1])
    assert len(answer["interval"]) == 2 and "changeDynamics" in answer["design"]["snippet"]


@pytest.mark.parametrize(
    "asked",
    [
        "croquet --engine mujoco",
        "golf_ball --engine drake --time-step 1ms",
        f"1.8 1.2 0.8 m {RAPIER}",
    ],
)
def test_a_fit_names_its_own_options(typed, asked):
    text = typed(f"fit {asked} --explain")[1]
    named = set(re.findall(r"--[a-z-]+", text))
    options = set(re.findall(r"--[a-z-]+", typed("fit --help")[1]))
    assert named <= options


@pytest.mark.parametrize(
    ("typed_numbers", "r"),
    [
        ("1.80 1.21 0.82 m", "r = 0.8"),
        ("180 121 82 cm", "r = 0.8"),
        ("0.9 0.738 0.6052 s", "r = 0.820"),
        ("0.3 1.2 1.938 2.5432 s", "r = 0.820"),
        ("300 1200 1938 2543.2 ms", "r = 0.820"),
    ],
)
def test_numbers_are_a_recording(typed, typed_numbers, r):
    assert r in typed(f"fit {typed_numbers}")[1]


def test_a_recording_is_piped(tmp_path):
    code = "from bouncing_ball_contacts.cli import run; run()"
    done = subprocess.run(
        [sys.executable, "-c", code, "fit", "-"],
        input="drop,rebound\n1,0.64\n0.5,0.32\n",
        capture_output=True,
        text=True,
        check=True,
    )
    assert "r = 0.8000" in done.stdout


def test_several_files_have_an_answer_each(typed, tmp_path):
    one, other = tmp_path / "a.csv", tmp_path / "b.csv"
    one.write_text("time (s)\n0.1\n0.9\n1.5")
    other.write_text("height (cm)\n100\n64\n41")
    out = typed(f"fit {one} {other}")[1]
    assert "a.csv: r = 0.75" in out and "b.csv: r = 0.80" in out
    assert "are no heights or times with one unit" in typed(f"fit {one} none.csv")[2]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full device")
def test_a_full_device_is_one_line():
    code = "from bouncing_ball_contacts.cli import run; run()"
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code, "engines"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            env={"PYTHONUNBUFFERED": ""},
        )
    assert done.returncode == 2
    assert done.stderr.startswith("bounce: ") and done.stderr.count("\n") == 1


COMMANDS = ("", "design", "diagnose", "fit", "engines")
HELP = {f"{command} {option}": "Usage" for command in COMMANDS for option in ("--help", "-h")}
HELP |= {"": "Examples:\n    bounce design --mass", "--version": "bounce, version "}


@pytest.mark.parametrize("line", HELP)
def test_help(typed, line):
    status, out, err = typed(line)
    assert (status, err) == (0, "") and HELP[line] in out


def test_engines_are_listed_with_what_was_run(typed):
    out = typed("engines")[1]
    assert "MuJoCo 4.0.0" in out
    assert max(map(len, out.splitlines())) <= 100
    assert typed("engines matter")[1].count("matter-js:") == 1 and "rapier:" in out


def test_a_recording_becomes_a_contact_in_one_command(typed):
    status, out, _ = typed('fit golf_ball --engine pybullet --time-step "1 ms"')
    assert status == 0 and "Golf ball on marble" in out and "restitution=" in out


MISTAKES = {
    "design": "the restitution is missing",
    'design --mass "50 g"': "restitution is missing",
    "design --density steel": "'bounce fit' measures it",
    "design --restitution 0.8": "mass is missing",
    'design --mass "50 g" --restitution 1.2': "not between 0 and 1",
    'design --mass "50 g" --restitution -0.1': "not between 0 and 1",
    'design --mass "50 g" --restitution 80': "80 % is written 0.8 or '80 %'",
    'design --mass "50 g" --restitution high': "does not begin with a number",
    'design --mass "0 g" --restitution 0.8': "not positive",
    'design --mass "-5 g" --restitution 0.8': "not positive",
    'design --mass "50 m" --restitution 0.8': "does not fit; write it as in '50 g'",
    'design --mass "50 grams of" --restitution 0.8': "does not fit",
    'design --mass "1,500 g" --restitution 0.8': "'1500 g' or as '1.500 g'",
    f"{BALL} --engine mujocco": "did you mean mujoco",
    f"{BALL} --engine nothing": "'bounce engines' lists",
    f"{BALL} --engine rapir --time-step 1ms": "did you mean rapier",
    f"{BALL} --time-step 0": "not positive",
    f"{BALL} --time-step 1/0": "divides by zero",
    f'{BALL} --time-step "2 mm"': "does not fit",
    f"{BALL} --time-step": "requires an argument",
    f'{BALL} --drop-height "1 m" --speed "2 m/s"': "either the drop height or the speed",
    f'{BALL} --radius "1 cm" --density steel': "give two of mass, radius and density",
    f'{BALL} --penetration "1 mm" --stiffness "1 kN/m"': "either the penetration or the stiffness",
    f'{BALL} --stiffness "1 kN/m" --contact-time "1 ms"': "the stiffness or the contact time",
    f'{BALL} --stiffness "1,500 N/m"': "can be read as",
    f'{BALL} --stiffness "1 kN/m" --engine lammps-hertz': "no stiffness in N/m",
    f"{BALL} --diameter 6cm": "No such option '--diameter'. Did you mean '--radius'?",
    f"{BALL} --dt 1ms": "Did you mean '--time-step'?",
    f"{BALL} --contact-time 1s": "deeper than the radius of 11.5 mm: give a shorter one",
    f"{BALL} --density cheese": "or 'rubber'",
    f"{BALL} --points 0": "no whole number from 1 to 1000",
    f"{BALL} --points two": "is not a valid integer",
    f'{BALL} --radius "2 mm" --penetration "5 mm"': "is deeper than the radius of 2 mm",
    f"{BALL} --gravity 0": "give the speed, --speed '2 m/s'",
    f"{BALL} --gravity -1": "not positive",
    f"{BALL} --gravity -9.81 --speed 2": "is not positive\n",
    f"{BALL} --time-step 240": "or '240 Hz' for a rate",
    "diagnose --engine mujoco --mass 1 --time-step 2s": "time step = 2 s is longer than 100 ms",
    f"{BALL} --time-step 0Hz": "not positive",
    f"{BALL} --friction slippery": "does not begin",
    f"{BALL} --friction -0.5": "not between 0 and inf",
    f"{BALL} --damping-ratio 2": "No such option",
    f"{BALL} --restitutionn 2": "No such option",
    f"{BALL} extra": "unexpected extra argument",
    "designn": "No such command",
    "diagnose": "mass is missing",
    f"{BALL} --gravity 1e12 --time-step 100ms": "moves 141000 m in a step of 100 ms: up to 1 km",
    "diagnose --engine nothing": "engine 'nothing' is not known",
    "diagnose --mass 1": "stiffness is missing",
    "diagnose solref --mass 1": "is not NAME=VALUE",
    "diagnose =3 --mass 1": "is not NAME=VALUE",
    f"{MUJOCO} solref=-0.02": "neither two negative numbers",
    f"{MUJOCO} solref=": "two numbers",
    f"{MUJOCO} solref=1,2,3": "two numbers",
    f"{MUJOCO} solreff=0.02": "did you mean solref",
    f"{MUJOCO} solref='0.02 1' dt=1ms": "; the time step is --time-step",
    f"{MUJOCO} integrator=RK4": "mujoco: 'integrator' is not computed here",
    f"{MUJOCO} kn=1": "computed are solref, solimp, refsafe",
    f"{MUJOCO} restitution=0.5": "condim, cone\n",
    f"{MUJOCO} solref='0.02 1' --other cone=elliptic": "the other body: 'cone' is not computed",
    f"{LAMMPS} kn=3e4 gamma_n=40 --one-body": "lammps sets the contact of a pair of bodies",
    f"{LAMMPS} --one-body": "a pair of bodies",
    "diagnose --engine cannon-es restitution=0.8 --other restitution=0.5": "a pair of bodies",
    "diagnose --engine ode bounce=0.5 --one-body --time-step 1ms": "a pair of bodies",
    f"diagnose {RAPIER} --other threshold=1 restitution=0.8": "rapier, the other body: 'threshold'",
    f"{PYBULLET} contactStiffness=1e4": "give both",
    f"{PYBULLET} contactStifness=1e4": "did you mean contactStiffness",
    f"{PYBULLET} q=1": "without a restitution contactStiffness, contactDamping\n",
    "diagnose --engine matter-js q=1": "frictionAir\n",
    f"{PYBULLET} contactStiffness='1e4 kg' contactDamping=1": "write it as in '100 kN/m'",
    f"{PYBULLET} restitution='0.8 m'": "write a number without a unit as in '0.8'",
    "diagnose --engine ode boun=0.8 --mass 1 --time-step 1ms": "did you mean bounce",
    LAMMPS: "kn is missing: give kn and gamma_n; lammps has no default",
    f"{LAMMPS} kn=1e5": "gamma_n is missing",
    f"{LAMMPS} kn=1e5 gamma_n=soft": "does not begin",
    f"{LAMMPS} kn=-1 gamma_n=1": "not between 0 and inf",
    f"{LAMMPS} kn=1e4 kn=2e4 gamma_n=1": "kn is given twice",
    f"{LAMMPS} kn=1e5 gamma_n=1 --points 0": "no whole number",
    f"{LAMMPS} kn=1e5 gamma_n=1 --restitution 2": "not between 0 and 1",
    "fit": "Missing argument",
    "fit nothing.csv": "the file nothing.csv does not exist",
    "fit croquet --speed fast": "does not begin",
    "fit croquet --speed 0": "not positive",
    "fit croquet --leave-out one": "is not a valid integer",
    "fit croquet --time-step 1ms": "--time-step needs an engine",
    "fit /": "/ is a folder: give a file in it",
    "fit ''": ". is a folder: give a file in it",
    "fit croquet --ball golf": "has no column of balls: leave out --ball",
    "fit croquet --from 2s": "--from and --to are of a sound in a file",
    "fit 1.8m 1.21cm": "are no heights or times with one unit",
    "fit croquet --penetration 1mm": "No such option",
    "engines mujocco": "did you mean mujoco",
    "fit bouncy_ball --engine mujoco": "--mass '50 g' or mass='50 g'\n",
    "fit croquet --resolution 1ms": "resolution",
    'fit croquet --mass "a lot"': "does not begin",
    "engines --all": "No such option",
    "design --mass 1e-300 --restitution 0.8": "mass = 1e-300 kg is not computed",
    f"design {RAPIER}": "the restitution is missing",
    "design --engine jolt --restitution 0.8": "the time step is missing",
    f"design {RAPIER} --restitution 0.8 --penetration 1mm": "--penetration has no place",
    f"design {RAPIER} --restitution 0.8 --points 4": "--points has no place",
    f"diagnose {RAPIER}": "restitution is missing: give restitution=0.8",
    f"diagnose {RAPIER} restitution=1.2": "not between 0 and 1",
    f"diagnose {RAPIER} threshold=1": "'threshold' is not computed here",
    "diagnose --engine jolt mRestitution=1 gravity=1 --time-step 1/60": "are mRestitution, ",
    f"diagnose {RAPIER} restitution=1 --drop-height 1mm": "is longer than the fall",
    "design --engine jolt --speed 1e200 --restitution 0.8 --time-step 1ms": "is not computed",
    "design --engine jolt --restitution 0.8 --time-step 1ns": "moves 4.43 nm in a step of 1 ns",
    f"design {RAPIER} --gravity 1e300 --restitution 0.8": "is not computed",
    "fit croquet --engine godot": "godot was not run, but has two engines: take godot-jolt",
}


@pytest.mark.parametrize("line", MISTAKES)
def test_a_mistake_is_one_line(typed, line):
    status, out, err = typed(line)
    assert (status, out) == (2, "")
    assert err.startswith("bounce: ") and err.count("\n") == 1
    assert MISTAKES[line] in err
    assert "1.2 %" not in err


EXTREMES = ("1e-300", "1e300", "0", "-1", "nan", "inf")
DROPS = "diagnose --engine lammps kn=1e5 gamma_n=9 --mass 1 --time-step 1ms"
EXTREME = [
    *(
        f"design --mass 1 --restitution 0.5 --time-step 1ms --engine mujoco --{option}={{}}"
        for option in ("mass", "restitution", "drop-height", "speed", "radius", "density")
    ),
    *(
        f"{SHORT} --engine mujoco --{option}={{}}"
        for option in ("gravity", "friction", "time-step")
    ),
    *(f"{BALL} --{option}={{}}" for option in ("penetration", "stiffness", "contact-time")),
    "design --engine jolt --restitution {} --time-step 1/60",
    "diagnose --engine rapier restitution={} --time-step 1/60",
    "diagnose --engine jolt restitution=0.5 --time-step {}",
    *(f"{DROPS.replace(was, '{}')}" for was in ("1e5", "9", "1ms")),
    *(f"fit croquet --{option}={{}}" for option in ("speed", "resolution", "mass", "contact-time")),
]


@pytest.mark.parametrize("line", EXTREME)
def test_an_extreme_number_has_an_answer_or_one_line(typed, line):
    for value in EXTREMES:
        status, out, err = typed(line.replace("{}", value, 1))
        if status:
            assert (status, out) == (2, "")
            assert err.startswith("bounce: ") and err.count("\n") == 1
        else:
            assert err == "" and not re.search(r"\b(nan|inf)\b", out), (line, value)


def test_the_command_starts_quickly():
    """Neither SciPy nor what reads recordings is imported for a design."""
    code = (
        "import sys; sys.argv = ['bounce', 'design', '--mass', '50 g', '--restitution', '0.8']\n"
        "from bouncing_ball_contacts.cli import run\n"
        "try: run()\n"
        "except SystemExit: pass\n"
        "halves = {f'bouncing_ball_contacts.{each}' for each in ('fits', 'tables', 'recordings')}\n"
        "print(sorted(({'scipy', 'mujoco'} | halves) & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
