"""Answers of subcommands that two houses have under names of their own: ``orbit`` of the root is
``law-orbit`` of beyond.
"""

import json
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import strategies as st

FORCE = ("--frequency-ratio", "10", "--release", "force")
COMPLIANT = ("--restitution", "0.85", "--amplitude", "0.9", "--frequency-ratio", "2")
OF_ORBIT = ["multipliers", "is_stable", "is_admissible", "residual"]
"""What an answer has of an orbit after its observables."""

RARE = {
    "ratio": st.sampled_from([None, 1e-8, 0.7, 1.0, 3.0, 1e8]),
    "release": st.sampled_from(["displacement", "force"]),
    "r": st.sampled_from([1.0, 0.5, 1e-300]),
    "amplitude": st.sampled_from([1e8, 1.0, 1e-300]) | st.floats(1e-300, 1e8),
    "n": st.sampled_from([1, 1000]),
    "side": st.sampled_from(["stable", "unstable"]),
}
"""Parameters of an orbit that are seldom met."""


def stable_exactly_on_its_side(answer: dict, multipliers: Sequence[complex], side: str) -> None:
    """The answer has these multipliers, and solves the equations to some roundings."""
    assert [complex(*pair) for pair in answer["multipliers"]] == list(multipliers)
    assert answer["is_stable"] is (side == "stable") is bool(np.all(np.abs(multipliers) < 1))
    assert answer["is_admissible"] is True and answer["residual"] < 1e-13


def the_loss_has_three_names(ask: Callable, orbit: str, zeta: float) -> None:
    """``zeta`` is the house's own ζ of r = 0.85 by Eq. 16."""
    call = (orbit, "--amplitude", "1", *FORCE)
    by_eq_16 = ask(*call, "--restitution", "0.85")
    assert ask(*call, "--damping-ratio", repr(zeta)) == by_eq_16
    # The force release has a higher r than that of Eq. 16.
    assert by_eq_16["measured_restitution"] > 0.85
    own = ask(*call, "--measured-restitution", "0.85")
    assert own["measured_restitution"] == pytest.approx(0.85, rel=1e-14)
    assert own["damping_ratio"] > by_eq_16["damping_ratio"]
    # Without a contact there is one r only.
    bare = (orbit, "--amplitude", "1")
    assert ask(*bare, "--measured-restitution", "0.7") == ask(*bare, "--restitution", "0.7")


def every_orbit_is_reached(
    ask: Callable, refused: Callable, said: Callable, orbit: str, fields: Sequence[str]
) -> None:
    call = (orbit, *COMPLIANT)
    found = ask(*call, "--side", "all")["orbits"]
    assert [each["is_stable"] for each in found] == [True, False, True]
    third = ask(*call, "--index", "3")
    assert {name: third[name] for name in fields} == found[2]
    status, line = refused(*call, "--index", "4")
    assert status == 1 and "has 3 1-T orbits at Λ = 0.9" in line
    assert "orbit 3" in said(*call, "--side", "all")


def no_saddle_node_is_found(refused: Callable, limits: str) -> None:
    status, line = refused(limits, "--frequency-ratio", "0.7071", "--damping-ratio", "0.2155")
    assert status == 1 and "no saddle-node was found on the branch of 1-T orbits" in line


def a_ball_stays_on_a_stable_orbit(
    ask: Callable, said: Callable, orbit: str, simulate: str
) -> None:
    contact = ("--restitution", "0.85", "--amplitude", "1.0", *FORCE[:2])
    found = ask(orbit, *contact)
    start = ("--phase", repr(found["phase"]), "--velocity", repr(found["impact_velocity"]))
    answer = ask(simulate, *contact, *start, "--impacts", "30")
    assert answer["status"] == "bouncing" and len(answer["sequence"]["time"]) == 30
    # Rounding stays rounding on a stable orbit.
    assert np.ptp(answer["sequence"]["impact_velocity"]) < 1e-12
    call = (simulate, "--restitution", "0.5", "--amplitude", "0.5", *FORCE[:2])
    answer = ask(*call, "--velocity", "-1")
    assert answer["status"] == "permanent contact"
    assert answer["sequence"]["contact_duration"][-1] is None
    assert said(*call, "--velocity", "-1").splitlines()[-1].split().count("never") == 2


def a_missing_orbit_has_its_reason(refused: Callable, outcome: Callable, orbit: str) -> None:
    call = (orbit, "--restitution", "0.85", "--amplitude", "0.1")
    line = "no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node at Λ = 0.254724"
    assert refused(*call) == (1, f"bouncing-ball: {line}")
    status, out, _ = outcome(*call, "--json")
    assert status == 1 and "below the saddle-node" in json.loads(out)["error"]


def an_answer_or_a_line(
    outcome: Callable,
    orbit: str,
    *,
    ratio: float | None,
    release: str,
    r: float,
    amplitude: float,
    n: int,
    side: str,
) -> None:
    """There is no traceback, and no warning, which is an error in the tests."""
    command = [orbit, "--restitution", str(r), "--amplitude", str(amplitude), "--n", str(n)]
    command += ["--side", side, "--json"]
    if ratio is not None:
        command += ["--frequency-ratio", str(ratio), "--release", release]
    status, out, err = outcome(*command)
    if amplitude < 1e-12:
        assert status == 2 and len(err.splitlines()) == 1
        return
    assert status in (0, 1) and len(err.splitlines()) == status
    assert ("error" in json.loads(out)) is (status == 1)
