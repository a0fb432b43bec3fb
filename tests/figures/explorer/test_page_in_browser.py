"""The explorer in a real browser: its numbers against the command line, its badge, its manners.

Another page, made here, shows it in frames and writes down what the browser made of it. The
policy of the page keeps its own scripts only; what is asked is asked from outside.
"""

import html
import json
import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.attractors.motions import Kind
from bouncing_ball.cli.main import main
from bouncing_ball.configuration.study import typed
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.engines import ENGINES
from bouncing_ball.engines.reference import as_json
from bouncing_ball.figures.explorer.document import BOUND, to_html
from bouncing_ball.motion.history import history
from bouncing_ball.motion.simulation import simulate
from bouncing_ball.studies.reference_orbits import reference_orbits

pytestmark = pytest.mark.slow

REFERENCES = {"frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 250}, "seed": 31}
STATES = 80

# The page that looks at the page: what it sees is JSON in its element "seen".
OBSERVER = Path(__file__).with_name("observer.html").read_text(encoding="utf-8")


def states():
    """Random hashes about the stable ranges, and beyond."""
    rng = np.random.default_rng(7)
    for k in range(STATES):
        r, w = rng.uniform(0.2, 0.99), 10 ** rng.uniform(0.2, 3.5)
        n, release = int(rng.integers(1, 5)), ("displacement", "force")[k % 2]
        low = n * math.pi * (1 - r) / (1 + r)
        high = math.hypot(low, 2 * (1 + r * r) / (1 + r) ** 2)
        a = low + rng.uniform(-0.25, 1.3) * (high - low)
        side = "stable" if k % 4 < 3 else "unstable"
        yield f"#r={r:.4f}&w={w:.6g}&a={max(a, 0.01):.5f}&n={n}&release={release}&side={side}"


def engine_states():
    """A hash of the physical tab for each engine and release that it has, and one that is not."""
    rng = np.random.default_rng(11)
    pairs = [(name, rule) for name, engine in ENGINES.items() for rule in engine.releases]
    for name, release in [*pairs, ("drake", "displacement")]:
        r, e = rng.uniform(0.5, 0.95), 10 ** rng.uniform(-3, -1.5)
        m, k = 10 ** rng.uniform(0, 3), 10 ** rng.uniform(5, 7)
        yield (
            f"#tab=design&m={m:.4g}&f=20&acc=1.2&k={k:.6g}&r={r:.3f}&n=1&release={release}"
            f"&engine={name}&e={e:.2g}"
        )


@pytest.fixture(scope="module")
def seen(browse, tmp_path_factory):
    """All that is asked of the browser, in one run."""
    folder = tmp_path_factory.mktemp("explorer")
    data = typed(reference_orbits)(REFERENCES).assign_attrs(provenance_commit="c0ffee" * 6 + "c0ff")
    right = to_html(data, as_json())
    # Reference orbits that are not the model's.
    wrong = to_html(data.assign(max_height=data.max_height * 1.00000001), as_json())
    lost = to_html(data.assign(end_phase=data.end_phase + 1e-10), as_json())
    # A text of an engine that is not the package's.
    pasted = to_html(data, as_json().replace("hooke 100000.0", "hooke 100000.1", 1))
    (folder / "right.html").write_text(right, encoding="utf-8")
    (folder / "wrong.html").write_text(wrong, encoding="utf-8")
    (folder / "lost.html").write_text(lost, encoding="utf-8")
    (folder / "pasted.html").write_text(pasted, encoding="utf-8")
    # A script that was changed in the file, without its checksum.
    tampered = right.replace("const GRAVITY = 9.80665", "const GRAVITY = 9.81")
    (folder / "tampered.html").write_text(tampered, encoding="utf-8")
    observer = folder / "observer.html"
    script = OBSERVER.replace("STATES", json.dumps(list(states())))
    script = script.replace("ENGINES", json.dumps(list(engine_states())))
    observer.write_text(script, encoding="utf-8")
    text = browse(folder, observer, "--virtual-time-budget=30000", "--dump-dom")
    found = re.search(r'<pre id="seen">(.*)</pre>', text, re.DOTALL)
    assert found and found[1].startswith("{"), found and found[1]
    return json.loads(html.unescape(found[1])) | {"folder": folder}


def answered(capsys, command):
    """The command's own JSON, None where it says that there is no orbit."""
    try:
        main([*shlex.split(command)[1:], "--json"])
    except SystemExit as exit_:
        assert exit_.code == 1
        capsys.readouterr()
        return None
    return json.loads(capsys.readouterr().out)


def close(shown, expected):
    return abs(float(shown) - expected) <= BOUND * max(1.0, abs(expected))


def test_eighty_states_say_what_their_commands_print(seen, capsys):
    absent = 0
    for state in [seen["first"], *seen["states"]]:
        said, values = answered(capsys, state["command"]), state["values"]
        exists = values["spring-damper exists"]
        if said is None:
            absent += 1
            assert exists == "false", state["command"]
            continue
        assert exists == "true", state["command"]
        for name in ("phase", "contact_duration", "impact_velocity", "bounce_velocity",
                     "apparent_restitution", "max_height"):  # fmt: skip
            assert close(values[f"spring-damper {name}"], said[name]), (name, state["command"])
        found = np.array(values["spring-damper multipliers"].split(), dtype=float).reshape(2, 2)
        # The larger one may be steep in Λ next to the saddle-node: its size counts.
        size = max(1.0, np.abs(said["multipliers"]).max())
        assert np.abs(found - said["multipliers"]).max() < 1e-9 * size, state["command"]
        assert values["spring-damper is_stable"] == str(said["is_stable"]).lower()
    assert 0 < absent < STATES / 3


def test_errors_and_verdicts_are_those_of_the_calculator(seen, capsys, short_runs):
    judged = set()
    for number, state in enumerate(seen["states"][:30]):
        given = dict(zip(*[iter(shlex.split(state["command"])[2:])] * 2, strict=True))
        # What a ball does in place of an unstable orbit takes the calculator seconds.
        if given["--side"] == "unstable" or (number > 5 and "unstable" in state["verdict"]):
            continue
        r, n, ratio, lam = (
            given[f"--{x}"] for x in ("restitution", "n", "frequency-ratio", "amplitude")
        )
        call = (
            f"bouncing-ball design --mass 1 --gravity 1 --angular-frequency 1 --acceleration {lam} "
            f"--stiffness {float(ratio) ** 2!r} --restitution {r} --n {n} "
            f"--release {given['--release']}"
        )
        said = answered(capsys, call)
        if said is None:
            continue
        one = said["orbits"][0]
        for kind in ("errors", "corrected_errors"):
            for name, expected in one[kind].items():
                shown = float(state["values"][f"{kind} {name}"])
                # A difference of numbers of order 1 that agree to the bound.
                assert math.isfinite(shown) == (expected is not None)
                assert expected is None or abs(shown - expected) < 10 * BOUND
        if one["exists"] and not one["is_stable"]:
            assert "unstable" in state["verdict"]
        elif one["exists"] and one["is_admissible"]:
            judged.add(said["is_good_enough"])
            # The page judges orbits only, and no ball that is laid on the table.
            verdict = said["verdict"].partition("; a ball laid")[0].rstrip(".")
            assert state["verdict"].startswith(verdict)
    assert judged == {True, False}


def test_the_badge(seen):
    right, wrong, tampered = (seen["badges"][name] for name in ("right", "wrong", "tampered"))
    assert right["kind"] == "good" and float(right["worst"]) < BOUND / 20
    assert "500 orbits and 8 balls of the Python package, commit c0ffeec0ff" in right["text"]
    assert "and 40 settings of engines, computed again here" in right["text"]
    pasted = seen["badges"]["pasted"]
    assert pasted["kind"] == "bad" and "Infinity (settings of lammps)" in pasted["text"]
    assert wrong["kind"] == "bad" and float(wrong["worst"]) > BOUND
    lost = seen["badges"]["lost"]
    assert lost["kind"] == "bad" and "(end_phase, row " in lost["text"]
    assert wrong["text"].startswith("WRONG") and wrong["colour"] == "rgb(176, 0, 32)"
    # The policy does not let a changed script run, and what was not checked says so.
    assert tampered["kind"] == "" and tampered["text"].startswith("Not checked")


def test_no_request_leaves_the_page(seen):
    assert seen["requests"] == []
    assert {"connect-src", "img-src"} <= set(seen["blocked"])
    text = (seen["folder"] / "right.html").read_text(encoding="utf-8")
    assert "content=\"default-src 'none'; script-src 'sha256-" in text
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text)


def test_address_slider_and_typed_values(seen):
    assert seen["refused"] == "Not a value here, and left out: nonsense = 1."
    assert "--restitution 0.65 --frequency-ratio 6 --amplitude 1 " in seen["first"]["command"]
    assert "--restitution 0.5 --frequency-ratio 20 --amplitude 1.2" in seen["byAddress"]["command"]
    assert "--release force" in seen["byAddress"]["command"]
    assert "w=31.62" in seen["bySlider"]["hash"] and seen["bySlider"]["typed"] == "31.62"
    # What is out of range is marked, changes no address, and leaves no answer beside it.
    says = "restitution coefficient r: 1.5 is not a number from 0.001 to 1."
    assert seen["invalid"] == {
        "marked": "true", "hash": seen["bySlider"]["hash"], "refused": says,
        "verdict": "", "command": "", "shown": 0,
    }  # fmt: skip
    assert seen["valid"]["refused"] == "" and seen["valid"]["verdict"] and seen["valid"]["shown"]
    assert "left out: a = 0 (in its place 0.8)." in seen["still"]["refused"]
    assert "r = 0.1 is not above e⁻² = 0.1353" in seen["tooLossy"]["refused"]
    assert seen["tooLossy"]["verdict"] == seen["tooLossy"]["command"] == ""


KINDS = {
    "stays": {"permanent contact"}, "repeats": {"orbit", "subharmonic"}, "sticks": {"locked"},
    "goes on": {"chaotic"},
}  # fmt: skip


def test_scenes_end_as_their_commands_say(seen, capsys):
    assert set().union(
        *(KINDS[end["kind"]] for one in seen["scenes"] for end in one["ends"])
    ) == set(Kind) - {Kind.UNDECIDED}
    for scene in seen["scenes"]:
        commands = scene["command"].splitlines()
        assert len(commands) == len(scene["ends"]) and scene["look"] != "Balls on one table."
        for command, end in zip(commands, scene["ends"], strict=True):
            said = answered(capsys, f"{command} --impacts 500")
            assert said["kind"] in KINDS[end["kind"]], command
            assert (said["periods"], said["impacts"]) == (end["periods"], end["impacts"]), command


def test_balls_on_the_stage_are_where_the_package_has_them(seen):
    for scene in seen["scenes"]:
        given, balls = scene["state"], scene["balls"]
        place = np.arange(given.get("balls", 1))
        phase = given["phi"] + place * given.get("dphi", 0)
        velocity = given["v"] + place * given.get("dv", 0)
        for end in scene["ends"]:
            r, name = given["r"], end["name"]
            contact = SpringDamper.from_restitution(r, given.get("w", 1.0), Release.DISPLACEMENT)
            law = r if name == "restitution" else contact
            run = simulate(law, given["a"], phase, velocity, impacts=300)
            for k, ball in enumerate(ball for ball in balls if ball["model"] == name):
                expected = history(run[k], ball["since"]).height
                # Over 100 periods the time itself is known to 1e-13, and a ball is not much faster.
                assert ball["heights"] == pytest.approx(expected, abs=1e-10), (scene["name"], k)


def test_step_and_play_and_what_is_refused_on_the_stage(seen):
    # In half a second, of which the browser draws some, less than a period passes.
    assert seen["stepped"] == 0 and 0 < seen["played"] < 2 * math.pi
    assert seen["noBalls"]["refused"] == "balls: 0 is not a whole number from 1 to 9."
    assert seen["noBalls"]["verdict"] == ""
    rising = seen["rising"]
    assert rising["refused"] == (
        "The velocity of ball 1 at its first impact, 2, is above that of the table, "
        "Λ cos φ = 1: it rises, and there is no impact."
    )
    assert rising["verdict"] == rising["command"] == "" and rising["picture"] == 0


def test_what_an_engine_is_told_is_what_the_command_prints(seen, capsys, short_runs):
    assert len(seen["engines"]) == 11
    for state in seen["engines"]:
        said, rows = answered(capsys, state["command"]), state["rows"]
        engine = said["engine"]
        assert state["snippet"] == engine["snippet"], state["command"]
        assert state["says"].startswith(f"For {engine['name']}, whose contacts end by ")
        assert f"in {engine['steps']} steps of {engine['scheme']}" in state["says"]
        assert state["chosen"] == engine["release"]
        step = next(float(rows[name]) for name in rows if name.startswith("time step for an error"))
        assert step == engine["time_step"]
        assert close(rows["restitution of a free impact"], engine["restitution"])
        for name, expected in {
            "greatest height": engine["max_height"],
            "duration of contact": engine["contact_duration"],
        }.items():
            assert float(rows[name]) == pytest.approx(expected, rel=BOUND), name
        penetration = float(rows["greatest compression (sampled)"])
        assert penetration == pytest.approx(engine["penetration"], rel=1e-5)


def test_the_physical_tab_by_key(seen, capsys, short_runs):
    tab = seen["tab"]
    assert tab["selected"] == ["false", "true", "false"] and tab["focused"] == "tab-design"
    assert tab["shown"] and tab["hidden"] == 0 and "tab=design" in tab["hash"]
    said, rows = answered(capsys, tab["command"]), tab["rows"]
    orbit, corrected = said["orbits"][0], said["corrected"]
    for name, expected in {
        "contact time, free": said["contact_time"],
        "damping c": said["damping"],
        "greatest height": orbit["max_height"],
        "impact speed": orbit["impact_speed"],
        "corrected model: delay t_c": corrected["delay"],
        "corrected model: load σ": corrected["load"],
    }.items():
        assert float(rows[name]) == pytest.approx(expected, rel=BOUND), name
    # Sampled, at 2000 points of a contact.
    force = said["orbits"][0]["peak_force"]
    assert float(rows["peak force (sampled)"]) == pytest.approx(force, rel=1e-6)
