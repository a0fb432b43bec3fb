"""The command line: answers, exit statuses, one-line errors."""

import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bouncing_ball
from bouncing_ball.cli.main import main
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits import restitution_orbit as restitution
from bouncing_ball.orbits import spring_damper_limits as limits
from bouncing_ball.orbits.orbit import OBSERVABLES
from bouncing_ball.orbits.stability import Side

BOUNDS = ("saddle_node", "period_doubling")
ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(sys.executable).with_name("bouncing-ball")


ORBIT = ("orbit", "--n", "1", "--restitution", "0.85", "--amplitude", "1.0")
STIFF_FORCE = ("--frequency-ratio", "10", "--release", "force")
FIELDS = [*OBSERVABLES[1:], "multipliers", "is_stable", "is_admissible", "residual"]


def test_restitution_orbit_is_the_closed_form(ask):
    answer = ask(*ORBIT)
    assert list(answer) == FIELDS
    assert answer["phase"] == float(restitution.phase(1, 0.85, 1.0))
    assert answer["bounce_velocity"] == math.pi == -answer["impact_velocity"]
    product = complex(*answer["multipliers"][0]) * complex(*answer["multipliers"][1])
    assert product == pytest.approx(0.85**2, rel=1e-14)
    assert answer["is_stable"] is True and answer["is_admissible"] is True


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("side", ["stable", "unstable"])
def test_spring_damper_orbit_in_full_precision(ask, release, side):
    answer = ask(*ORBIT, "--frequency-ratio", "10", "--release", release, "--side", side)
    assert list(answer) == [*FIELDS, "measured_restitution", "damping_ratio"]
    contact = SpringDamper(10.0, float(damping_ratio(0.85)), Release(release))
    orbit = limits.orbit_at(contact, 1, 1.0, Side(side))
    for name in ("phase", "impact_velocity", "bounce_velocity", "max_height"):
        assert answer[name] == float(getattr(orbit, name))
    assert answer["is_stable"] is (side == "stable")
    # The formula solves the paper's equations to rounding.
    assert answer["residual"] < 1e-13


def test_damping_ratio_in_place_of_restitution(ask):
    zeta = repr(float(damping_ratio(0.85)))
    call = ("orbit", "--damping-ratio", zeta, "--amplitude", "1", "--frequency-ratio", "10")
    assert ask(*call) == ask(*ORBIT, "--frequency-ratio", "10")


def test_limits_of_both_models(ask):
    answer = ask("limits", "--restitution", "0.85")
    assert answer["saddle_node"]["amplitude"] == float(restitution.saddle_node(1, 0.85))
    assert answer["period_doubling"]["amplitude"] == float(restitution.period_doubling(1, 0.85))
    answer = ask("limits", "--restitution", "0.85", "--frequency-ratio", "10")
    fields = {"amplitude", "phase", "contact_duration", "is_admissible"}
    assert set(answer["saddle_node"]) == fields
    # Table 1 as computed by continuation, see the accepted record.
    assert answer["saddle_node"]["amplitude"] == pytest.approx(0.2399879121, abs=1e-9)
    assert answer["period_doubling"]["amplitude"] == pytest.approx(1.0374563012, abs=1e-9)


def test_permanent_contact(ask):
    call = ("permanent-contact", "--restitution", "0.65", "--frequency-ratio", "6")
    answer = ask(*call)
    zeta, x = float(damping_ratio(0.65)), 1 / 36
    square = (1 - x) ** 2 + 4 * zeta**2 * x
    assert answer["threshold"] == pytest.approx(math.sqrt(square), rel=1e-15)
    assert answer["minimum"] == pytest.approx(2 * zeta * math.sqrt(1 - zeta**2), rel=1e-15)
    force = ask(*call, "--release", "force")
    expected = math.sqrt(square / (1 + 4 * zeta**2 * x))
    assert force["threshold"] == pytest.approx(expected, rel=1e-15)
    strong = ask("permanent-contact", "--damping-ratio", "0.9", "--frequency-ratio", "6")
    assert strong["minimum"] is None


def test_simulation_holds_the_orbit(ask):
    orbit = ask(*ORBIT, "--frequency-ratio", "10")
    start = ("--phase", repr(orbit["phase"]), "--velocity", repr(orbit["impact_velocity"]))
    call = ("--restitution", "0.85", "--amplitude", "1", "--frequency-ratio", "10")
    answer = ask("simulate", *call, *start, "--impacts", "30")
    assert answer["status"] == "bouncing"
    assert len(answer["sequence"]["time"]) == 30
    # Rounding stays rounding on a stable orbit.
    assert np.ptp(answer["sequence"]["impact_velocity"]) < 1e-12


def test_simulation_into_permanent_contact(ask):
    call = ("--restitution", "0.5", "--amplitude", "0.5", "--frequency-ratio", "10")
    answer = ask("simulate", *call, "--velocity", "-1")
    assert answer["status"] == "permanent contact"
    assert answer["sequence"]["contact_duration"][-1] is None


def test_the_restitution_that_a_contact_really_has(ask):
    call = ("orbit", "--amplitude", "1", *STIFF_FORCE)
    asked = ask(*call, "--restitution", "0.7")
    assert asked["measured_restitution"] == pytest.approx(0.718, abs=5e-4)
    own = ask(*call, "--measured-restitution", "0.7")
    assert own["measured_restitution"] == pytest.approx(0.7, rel=1e-14)
    assert own["damping_ratio"] > asked["damping_ratio"]
    # Without a contact there is one r only.
    bare = ("orbit", "--amplitude", "1")
    assert ask(*bare, "--measured-restitution", "0.7") == ask(*bare, "--restitution", "0.7")


def test_every_orbit_can_be_reached(ask, refused, said):
    call = ("orbit", "--restitution", "0.85", "--amplitude", "0.9", "--frequency-ratio", "2")
    found = ask(*call, "--side", "all")["orbits"]
    assert [orbit["is_stable"] for orbit in found] == [True, False, True]
    durations = [orbit["contact_duration"] for orbit in found]
    assert durations == sorted(durations)
    third = ask(*call, "--index", "3")
    assert {name: third[name] for name in FIELDS} == found[2]
    status, line = refused(*call, "--index", "4")
    assert status == 1 and "has 3 1-T orbits at Λ = 0.9" in line
    assert "orbit 3" in said(*call, "--side", "all")


def test_limits_say_whether_their_orbits_are_the_balls(ask):
    soft = ask("limits", "--restitution", "0.85", "--frequency-ratio", "10")
    assert soft["period_doubling"]["is_admissible"] is True
    # The ball would rise at impact.
    for answer in (soft, ask("limits", "--restitution", "0.85")):
        assert all(isinstance(answer[x]["is_admissible"], bool) for x in BOUNDS)


def test_the_corrected_model_answers_too(ask):
    call = ("--restitution", "0.65", "--frequency-ratio", "100", "--model", "corrected")
    corrected = ask("orbit", "--amplitude", "1", *call)
    spring = ask("orbit", "--amplitude", "1", *call[:-1], "spring-damper")
    assert corrected["max_height"] == pytest.approx(spring["max_height"], rel=1e-3)


def test_the_error_law(ask):
    call = ("error-law", "--n", "1", "--restitution", "0.65", "--amplitude", "1")
    found = ask(*call)
    assert found["coefficients"]["max_height"] == pytest.approx(0.8213674, abs=1e-7)
    assert found["signed"]["max_height"] == -found["coefficients"]["max_height"]
    # Nothing to be relative to at r = 1.
    found = ask("error-law", "--restitution", "1", "--amplitude", "0.8")
    assert found["coefficients"]["saddle_node"] is None


def test_the_error_law_is_about_the_contacts_own_r(ask):
    contact = ("--damping-ratio", "0.2", "--release", "force", "--amplitude", "1.5")
    found = ask("error-law", *contact)
    exact = ask("orbit", "--frequency-ratio", "1e4", *contact)
    r = repr(found["measured_restitution"])
    plain = ask("orbit", "--restitution", r, "--amplitude", "1.5")
    for name in ("max_height", "bounce_velocity", "phase", "apparent_restitution"):
        error = 1e4 * (exact[name] / plain[name] - 1)
        # The next order is about 1/ϖ of it, more for the apparent restitution.
        assert error == pytest.approx(found["signed"][name], rel=2e-2)


def test_permanent_contact_has_no_corrected_form(refused):
    call = ("--restitution", "0.65", "--frequency-ratio", "9", "--model", "corrected")
    status, line = refused("permanent-contact", *call)
    assert status == 2 and "no corrected form" in line and "second order" in line


def test_the_version(capsys):
    with pytest.raises(SystemExit) as exit_:
        main(["--version"])
    assert exit_.value.code == 0
    assert capsys.readouterr().out == f"bouncing-ball {bouncing_ball.__version__}\n"


@pytest.mark.parametrize(
    ("encoding", "arguments", "status"),
    [
        ("ascii", ["--help"], 0),
        ("ascii", ["orbit", "--help"], 0),
        ("ascii", [*ORBIT], 0),
        ("latin-1", [*ORBIT], 0),
        ("latin-1", [*ORBIT, "--json"], 0),
        ("ascii", [*ORBIT[:-1], "0.1", "--json"], 1),
    ],
)
def test_any_encoding_of_the_output(encoding, arguments, status):
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, env=environment, check=False)
    assert done.returncode == status
    assert b"Traceback" not in done.stderr and done.stderr.count(b"\n") <= 1
    if "--json" in arguments:
        assert json.loads(done.stdout.decode(encoding))


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], [*ORBIT], [*ORBIT, "--json"]])
def test_a_full_device(arguments):
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr == "bouncing-ball: the output cannot be written: No space left on device\n"


def test_a_missing_orbit_exits_1_with_the_reason(refused, capsys):
    call = ("orbit", "--restitution", "0.85", "--amplitude", "0.1")
    assert refused(*call) == (
        1,
        "bouncing-ball: no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node "
        "at Λ = 0.254724",
    )
    status, line = refused(*call, "--frequency-ratio", "10")
    assert status == 1 and "below the saddle-node at Λ = 0.239988" in line
    with pytest.raises(SystemExit) as exit_:
        main([*call, "--json"])
    assert exit_.value.code == 1
    assert "below the saddle-node" in json.loads(capsys.readouterr().out)["error"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "a command is missing, one of orbit, limits"),
        (
            ("orbit", "--amplitude", "1"),
            "--restitution --damping-ratio --measured-restitution is required",
        ),
        (("orbit", "--restitution", "0.85"), "required: --amplitude"),
        (("orbit", "--restitution", "1.2", "--amplitude", "1"), "'1.2' is not a number in (0, 1]"),
        (("orbit", "--restitution", "nan", "--amplitude", "1"), "'nan' is not a number in (0, 1]"),
        (("orbit", "--restitution", "r", "--amplitude", "1"), "'r' is not a number in (0, 1]"),
        (("orbit", "--restitution", "0.5", "--amplitude", "inf"), "'inf' is not a number in"),
        ((*ORBIT, "--frequency-ratio", "0"), "'0' is not a number in [1e-08, 1e+08]"),
        (
            ("permanent-contact", "--restitution", "0.5", "--frequency-ratio", "1e-300"),
            "'1e-300' is not a number in [1e-08, 1e+08]",
        ),
        (("orbit", "--damping-ratio", "1", "--amplitude", "1"), "'1' is not a number in [0, 1)"),
        (("orbit", "--damping-ratio", "0.1", "--amplitude", "1"), "needs --frequency-ratio"),
        ((*ORBIT, "--n", "0"), "'0' is not a whole number"),
        ((*ORBIT, "--n", "1.5"), "'1.5' is not a whole number"),
        ((*ORBIT, "--model", "spring-damper"), "needs --frequency-ratio"),
        ((*ORBIT, "--model", "restitution", "--frequency-ratio", "3"), "has no meaning"),
        ((*ORBIT, "--release", "force"), "--release has no meaning for --model restitution"),
        ((*ORBIT, "--model", "corrected"), "--model corrected needs --frequency-ratio"),
        ((*ORBIT, "--side", "all", "--index", "2"), "not allowed with argument --side"),
        (
            ("orbit", "--measured-restitution", "0.1", "--amplitude", "9", *STIFF_FORCE),
            "r = 0.1 is not in (e⁻², 1]",
        ),
        ((*ORBIT, "--side", "left"), "invalid choice: 'left'"),
        ((*ORBIT, "--tension", "1"), "unrecognized arguments: --tension 1"),
        (
            (
                *("simulate", "--restitution", "0.5", "--amplitude", "1"),
                *("--frequency-ratio", "5", "--velocity", "9"),
            ),
            "rises from the table",
        ),
    ],
)
def test_a_bad_argument_exits_2_with_one_line(refused, arguments, said):
    status, line = refused(*arguments)
    assert status == 2
    assert said in line


@pytest.mark.parametrize(
    "arguments",
    [
        ("--frequency-ratio", "1e8"),
        ("--frequency-ratio", "1e-8"),
        ("--frequency-ratio", "1"),
        ("--frequency-ratio", "1", "--n", "1000"),
        ("--frequency-ratio", "0.7", "--side", "unstable"),
        ("--frequency-ratio", "3", "--release", "force", "--side", "unstable"),
        ("--n", "1000"),
    ],
)
@pytest.mark.parametrize("r", ["1", "0.5", "1e-300"])
@pytest.mark.parametrize("amplitude", ["1e8", "1", "1e-300"])
def test_no_traceback_and_no_warning_ever(capsys, arguments, r, amplitude):
    # Warnings are errors in this suite.
    try:
        main(["orbit", "--restitution", r, "--amplitude", amplitude, *arguments, "--json"])
    except SystemExit as exit_:
        assert exit_.code == 1
    out, err = capsys.readouterr()
    assert "Traceback" not in err and len(err.splitlines()) <= 1
    json.loads(out)


@pytest.mark.parametrize("ratio", ["1e-8", "1e8"])
def test_permanent_contact_at_the_limits_of_the_frequency_ratio(ask, ratio):
    call = ("permanent-contact", "--restitution", "0.65", "--frequency-ratio", ratio)
    for release in ("displacement", "force"):
        assert math.isfinite(ask(*call, "--release", release)["threshold"])


@pytest.mark.parametrize(
    "arguments", [["--help"], ["--version"], ["bounce"], ["--tension", "1"], []]
)
def test_without_a_subcommand_no_numpy_is_imported(arguments):
    program = (
        "import sys\n"
        "from bouncing_ball.cli.main import main\n"
        "try:\n"
        "    main(sys.argv[1:])\n"
        "except SystemExit:\n"
        "    sys.exit(sorted({'numpy', 'xarray'} & set(sys.modules)) or None)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout or done.stderr.startswith("bouncing-ball: ")


def test_readable_tables(said):
    out = said(*ORBIT)
    assert "phase                                   1.31323433" in out
    assert "is stable                               yes" in out


def test_diff_for_nobody_who_reads(tmp_path):
    # Python on this end, and on the other nobody: the status is the diff's all the same.
    for side in ("record", "results"):
        (tmp_path / side).mkdir()
        (tmp_path / side / "paper.md").write_text(side if side == "record" else "", "utf-8")
    shutil.copytree(ROOT / "config", tmp_path / "record" / "config")
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [PROGRAM, "diff", "record", "results"],
        cwd=tmp_path,
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(writer)
    # The texts differ.
    assert (done.returncode, done.stderr) == (1, "")


def test_the_installed_program():
    done = subprocess.run([PROGRAM, *ORBIT, "--json"], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["is_stable"] is True
    assert done.stderr == ""
