"""The names that users import from the package, as README and docs/python.md show them."""

import doctest
import pickle
import pydoc
from pathlib import Path

import numpy as np
import pytest

import bouncing_ball

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(("page", "least"), [("README.md", 3), ("docs/python.md", 14)])
def test_the_examples_print_what_the_pages_say(page, least):
    result = doctest.testfile(str(ROOT / page), module_relative=False)
    assert result.failed == 0
    assert result.attempted >= least


def test_every_public_name_is_there_and_documented():
    for name in bouncing_ball.__all__:
        assert getattr(bouncing_ball, name).__doc__, name
    assert set(bouncing_ball.__all__) <= set(dir(bouncing_ball))


def test_help_shows_the_way_in():
    text = pydoc.render_doc(bouncing_ball, renderer=pydoc.plaintext)
    for call in ("bouncing_ball.orbit(", "bouncing_ball.limits(", "bouncing_ball.simulate("):
        assert call in text


@pytest.mark.parametrize("impacts", [0, -1, 2.5])
def test_what_the_command_line_refuses_is_refused(impacts, refusal):
    with refusal(
        bouncing_ball.ModelError, f"impacts = {impacts} is not a whole number from 1 to 100000"
    ):
        bouncing_ball.simulate(1.0, restitution=0.85, impacts=impacts)


CONTACT = {"restitution": 0.85, "frequency_ratio": 10.0}


def test_a_scalar_in_is_a_float_out():
    one = bouncing_ball.orbit(1, np.float64(0.9), **CONTACT)
    ends = bouncing_ball.limits(1, restitution=0.85)
    numbers = (one.phase, one.max_height, one.law.damping_ratio, ends.saddle_node.amplitude)
    assert {type(x) for x in (*numbers, *one.path(1.0))} == {float}
    assert type(one.is_stable()) is type(one.is_admissible()) is bool
    assert pickle.loads(pickle.dumps(one)).phase == one.phase


@pytest.mark.parametrize(
    "given",
    [
        {"restitution": 0.85},
        CONTACT,
        CONTACT | {"model": "corrected"},
        {"law": "tsuji", "parameters": {"stiffness": 900.0, "damping": 0.1}},
    ],
)
def test_every_model_answers_single_numbers_with_single_numbers(given):
    model = bouncing_ball.model(**given)
    orbit, ball = model.orbit(1, 0.9), model.simulate(0.9, 0.0, -3.0, 2)
    found = [x for end in (model.saddle_node(1), model.period_doubling(1)) for x in end.unknowns]
    found += [orbit.phase, orbit.amplitude, *model.cycle(0.9, 0.1, -3.0), ball.amplitude]
    assert {type(x) for x in (*found, model.permanent_contact_threshold())} == {float}
    assert type(orbit.is_stable()) is bool and type(ball.impacts) is int
    assert model.absence(1, 0.01) == "below the saddle-node"
    # And arrays with arrays, of the same numbers but for rounding in products of matrices.
    row = model.orbit([1, 1], 0.9)
    assert row.phase.shape == (2,) and abs(row.phase[1] - orbit.phase) < 1e-14
    assert repr(bouncing_ball.orbit(1, 0.9, **given)) == repr(orbit)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("history", {"amplitude": 1.0, "periods": 1.0}),
        ("drop", {"height": [5.0, 8.0], "periods": 1.0}),
        ("branch", {"n": [1, 2], "points": 20}),
        ("motion_of", {"amplitude": [1.0, 1.1]}),
        ("lyapunov_exponent", {"amplitude": 1.0, "phase": 1.1}),
        ("orbit_diagram", {"amplitudes": [1.0, 1.1], "impacts": 50, "samples": 4}),
        ("basins", {"amplitude": 1.0, "starts": 4}),
    ],
)
def test_a_model_has_the_calls_as_methods(name, given, refusal):
    call, model = getattr(bouncing_ball, name), bouncing_ball.model(0.85)
    assert getattr(model, name)(**given).equals(call(**given, restitution=0.85))
    with refusal(bouncing_ball.ModelError, "restitution is not allowed with model, which has its"):
        call(**given, restitution=0.85, model=model)
    with refusal(bouncing_ball.ModelError, "several models have no labels"):
        getattr(bouncing_ball.model([0.5, 0.85]), name)(**given)


def test_a_sequence_counts_the_impacts_that_it_has():
    stuck = bouncing_ball.simulate(0.6, restitution=0.2, impacts=50)
    assert type(stuck.impacts) is int and stuck.impacts < 50
    assert repr(stuck).startswith(f"ImpactSequence: {stuck.impacts} impacts, then permanent")
    both = bouncing_ball.simulate(0.6, restitution=[0.2, 0.8], impacts=50)
    assert f"{stuck.impacts} to 50 impacts of each of 2 balls" in repr(both)


@pytest.mark.parametrize(
    "given",
    [
        CONTACT,
        {"restitution": 0.85},
        pytest.param(
            {"restitution": 0.85, "law": "tsuji", "duration": 0.1}, marks=pytest.mark.long
        ),
    ],
)
def test_arrays_give_labelled_orbits_and_limits(given):
    orbits = bouncing_ball.orbit([1, 2], [0.2, 1.0], **given)
    assert orbits.phase.dims == ("n", "amplitude")
    # Below the saddle-node of both families.
    assert orbits.phase.sel(amplitude=0.2).isnull().all()
    assert not orbits.stable.sel(amplitude=0.2).any()
    ends = bouncing_ball.limits([1, 2], **given)
    one = bouncing_ball.orbit(2, 1.0, **given)
    for name in ("phase", "max_height", "contact_duration"):
        assert orbits[name].sel(n=2, amplitude=1.0) == pytest.approx(getattr(one, name), 1e-12)
    node = bouncing_ball.limits(2, **given).saddle_node
    assert ends.saddle_node_amplitude.sel(n=2) == pytest.approx(node.amplitude, rel=1e-9)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda: bouncing_ball.orbit(1, [0.5, 1.0], index=1, **CONTACT),
            "is for one orbit and does not",
        ),
        (lambda: bouncing_ball.orbit(1, [0.5, 1.0], side="all", **CONTACT), "side all is for one"),
        (lambda: bouncing_ball.orbit(1, 1.0, side="up", **CONTACT), "one of stable, unstable, all"),
        (lambda: bouncing_ball.model(0.85).orbit(1, 1.0, "up"), "one of stable, unstable"),
        (
            lambda: bouncing_ball.model(0.85, 10.0, "glue"),
            "'glue' is not one of displacement, force",
        ),
        (
            lambda: bouncing_ball.model(0.85, model="rigid"),
            "one of restitution, spring-damper, corr",
        ),
        (lambda: bouncing_ball.orbit(1, "a", restitution=0.85), "amplitude = 'a' is not a number"),
        # A text of the user is shown as it is, and is no placeholder of a message.
        (lambda: bouncing_ball.orbit(1, "{law} {}", restitution=0.85), "= '{law} {}' is not a num"),
        (lambda: bouncing_ball.orbit(1, 1.0, **{"{n}": 1}), "unknown parameter '{n}': choose from"),
        (
            lambda: bouncing_ball.model(law="tsuji", parameters={"{x}": 1.0}),
            "unknown parameter '{x}' of tsuji",
        ),
        (lambda: bouncing_ball.design(frequency="{mass} Hz"), "frequency = '{mass} Hz' does not"),
    ],
)
def test_wrong_values_are_refused_with_the_allowed_ones(call, says, refusal):
    with refusal(bouncing_ball.ModelError, says):
        call()
