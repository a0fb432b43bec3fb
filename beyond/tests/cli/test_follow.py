"""``follow`` and ``curve``, from the command line and from Python."""

from dataclasses import replace

import numpy as np
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches import observables

RIGID = bouncing_ball_beyond.rigid(restitution=0.5)
ORBIT = ("follow", "--restitution", "0.5", "--amplitude", "1.4")
FOLLOW = (*ORBIT, "--to", "1.8")


def test_the_command_prints_the_special_orbits_and_the_reason_for_the_end(ask):
    answer = ask(*FOLLOW)
    (doubling,) = answer["orbits"]
    expected = bouncing_ball_beyond.limits(RIGID).period_doubling.amplitude
    assert doubling["kind"] == "period doubling"
    assert doubling["amplitude"] == pytest.approx(expected, abs=1e-12)
    assert answer["end"] == "amplitude = 1.8 is reached" and answer["impacts"] == 1


def test_the_command_follows_the_doubled_orbit_and_that_of_a_simulated_ball(ask):
    doubled = ask(*FOLLOW, "--doublings", "1")
    motion = ("follow", "--restitution", "0.5", "--amplitude", "1.6", "--to", "1.8")
    simulated = ask(*motion, "--phase", "1", "--velocity", "-3")
    places = [answer["orbits"][0]["amplitude"] for answer in (doubled, simulated)]
    assert doubled["impacts"] == simulated["impacts"] == 2
    assert places[0] == pytest.approx(places[1], abs=1e-12)


def test_the_command_follows_a_curve_up_to_its_resonance(ask):
    command = ("curve", *FOLLOW[1:], "--kind", "period-doubling")
    between = ("--low", "0.4", "--high", "1")
    command = (*command, "--across", "restitution", *between)
    answer = ask(*command)
    (resonance,) = answer["orbits"]
    assert resonance["kind"] == "1:2 resonance"
    assert resonance["amplitude"] == pytest.approx(1.0, abs=1e-8)


@pytest.mark.parametrize(("options", "words"), [
    (("--to", "1.8", "--along", "stiffness"), "these orbits have no 'stiffness': one of"),
    (("--to", "-1"), "to = -1.0 is not a number in"),
])  # fmt: skip
def test_a_mistake_is_one_line(refused, options, words):
    command = (*ORBIT, *options)
    _, line = refused(*command)
    assert words.replace("to =", "--to =") in line


@pytest.mark.parametrize(("window", "words"), [
    (("--low", "0.6", "--high", "0.9"), "0.6 to 0.9 does not contain restitution = 0.5"),
    (("--low", "0.9", "--high", "0.1"), "restitution = (0.9, 0.1) is not two numbers of which"),
    (("--low", "0.4"), "--low and --high are needed together"),
    (("--along-low", "2", "--along-high", "3"), "2 to 3 does not contain amplitude = 1.52682"),
    (("--along-high", "3"), "--along-low and --along-high are needed together"),
])  # fmt: skip
def test_a_curve_starts_between_its_limits(refused, window, words):
    kind = ("--kind", "period-doubling", "--across", "restitution")
    command = ("curve", *FOLLOW[1:], *kind)
    command += window
    status, line = refused(*command)
    assert status == 2 and words in line


def test_results_are_labelled_and_drawn_and_iterated(tmp_path, described):
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    found = bouncing_ball_beyond.follow(one, to=1.8).to_dataset()
    described(found)
    assert found.phase.dims == ("point", "impact") and found.attrs["restitution"] == 0.5
    states = list(found.states())
    assert len(states) == found.sizes["point"]
    assert np.allclose([each.parameters["amplitude"] for each in states], found.amplitude)
    found.plot(tmp_path / "branch.png")
    doubling = found.first("period doubling")
    ranges = {"restitution": (0.4, 0.6)}
    curve = bouncing_ball_beyond.follow(doubling, along=("amplitude", "restitution"), ranges=ranges)
    described(curve.to_dataset())
    curve.plot(tmp_path / "curve.png")
    assert {path.name for path in tmp_path.iterdir()} == {"branch.png", "curve.png"}


def test_mistakes_in_python_are_one_line(refusal):
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    found = bouncing_ball_beyond.follow(one, to=1.5)
    with refusal(ModelError, "follow needs an orbit of bouncing_ball_beyond, not float"):
        bouncing_ball_beyond.follow(1.4)
    with refusal(ModelError, "kind = 'fold' is not one of saddle-node"):
        found.first("fold")
    with refusal(NoOrbitError, "the branch has no saddle-node; it ends because amplitude = 1.5"):
        found.first("saddle-node")
    start = next(found.states())
    with refusal(ModelError, "along = ('amplitude', 'amplitude') is not one parameter or two dif"):
        bouncing_ball_beyond.follow(start, along=("amplitude", "amplitude"))
    outside = "the range 0.6 to 0.9 does not contain restitution = 0.5, the value at the start"
    with refusal(ModelError, outside):
        special = replace(start, kind="saddle-node")
        ranges = {"restitution": (0.6, 0.9)}
        bouncing_ball_beyond.follow(special, along=("amplitude", "restitution"), ranges=ranges)
    with refusal(NoOrbitError, "an ordinary orbit has no curve in two parameters"):
        bouncing_ball_beyond.follow(start, along=("amplitude", "restitution"))
    with refusal(ModelError, "to is the end of a branch: a curve in two parameters has ranges"):
        bouncing_ball_beyond.follow(start, along=("amplitude", "restitution"), to=1.5)
    with refusal(ModelError, "ranges are those of a curve in two parameters: a branch has to"):
        bouncing_ball_beyond.follow(start, to=1.5, ranges={"amplitude": (1.0, 2.0)})


@pytest.mark.parametrize(("options", "words"), [
    ({"along": 3}, "along = 3 is not the name of a parameter or two"),
    ({"along": (1, 2)}, "along = (1, 2) is not the name of a parameter or two"),
    ({"ranges": (0.5, 0.9)}, 'ranges = (0.5, 0.9) is not a range by name, such as {"amplitude"'),
    ({"ranges": {"restitution": 0.9}}, "the range of restitution = 0.9 is not two numbers"),
])  # fmt: skip
def test_arguments_of_a_wrong_type_are_named(refusal, options, words):
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    doubling = bouncing_ball_beyond.follow(one, to=1.8).first("period doubling")
    with refusal(ModelError, words):
        bouncing_ball_beyond.follow(doubling, **{"along": ("amplitude", "restitution")} | options)


def test_a_part_of_a_branch_has_its_orbits(refusal):
    found = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit(RIGID, amplitude=1.4), to=1.5
    ).to_dataset()
    part = found.isel(point=0)
    assert [*part.states()] == [*found.states()][:1]
    with refusal(NoOrbitError, "the branch has no period doubling; it ends because amplitude"):
        part.first("period doubling")
    with refusal(ModelError, "without the dimension 'point' has no figure"):
        part.plot()
    with refusal(ModelError, "the dataset has no orbits: it lacks ball_model"):
        found.drop_vars("ball_model").states()
    assert found.isel(point=slice(3)).plot().axes


def test_a_contact_in_place_of_a_ball_is_told_its_model(refusal):
    contact = SpringDamper(10.0, 0.1)
    with refusal(ModelError, "contact_law, corrected or ContactModel(law)"):
        bouncing_ball_beyond.orbit(contact, amplitude=1.0)
    assert bouncing_ball_beyond.orbit(ContactModel(contact), amplitude=1.0).impacts == 1
    with refusal(ModelError, "law = 10.0 is not a law of a contact"):
        ContactModel(10.0)


def test_a_special_orbit_is_followed_as_its_kind_says():
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    doubling = bouncing_ball_beyond.follow(one, to=1.8).first("period doubling")
    doubled = bouncing_ball_beyond.follow(doubling, to=1.8).to_dataset()
    assert (doubled.attrs["impacts"], doubled.attrs["periods"]) == (2, 2)
    ranges = {"restitution": (0.4, 0.6)}
    curve = bouncing_ball_beyond.follow(
        doubling, along=("amplitude", "restitution"), ranges=ranges
    ).to_dataset()
    assert curve.attrs["curve_kind"] == "period doubling"
    # From a saddle-node the branch on which it lies is followed, along the parameter it came from.
    fold = bouncing_ball_beyond.follow(one, to=0.5).first("saddle-node")
    again = bouncing_ball_beyond.follow(fold).to_dataset()
    assert again.attrs["impacts"] == 1 and float(again.amplitude[-1]) > fold.amplitude


STIFF = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)


@pytest.mark.parametrize(("ball", "start", "along", "there", "beyond", "at"), [
    (RIGID, 1.4, "amplitude", 1.3, 0.5, 1.0472),
    (RIGID, 1.4, "restitution", 0.6, 0.3, 0.5),
    (STIFF, 1.0, "amplitude", 0.5, 0.1, 0.239988),
    (STIFF, 1.0, "frequency_ratio", 5.0, 20.0, 10),
])  # fmt: skip
def test_from_a_saddle_node_the_stable_side_is_followed(ball, start, along, there, beyond, at):
    one = bouncing_ball_beyond.orbit(ball, amplitude=start)
    fold = bouncing_ball_beyond.follow(one, to=0.1).first("saddle-node")
    found = bouncing_ball_beyond.follow(fold, along=along, to=there).to_dataset()
    assert found[along].values[-1] == pytest.approx(there) and found.stable[1:10].all()
    # There are no orbits on the other side: the same branch is followed, and its end says so.
    same = bouncing_ball_beyond.follow(fold, along=along, to=beyond).to_dataset()
    assert np.sign(same[along].values[3] - at) == np.sign(there - at) and same.stable[1:4].all()
    name = along.replace("_", " ")
    end = str(same.end_reason.values[1])
    assert end.endswith(f"; {name} = {beyond:g} is beyond the saddle-node at {at:g}")
    # The other side comes behind the saddle-node.
    behind = bouncing_ball_beyond.follow(
        list(found.states())[3], along=along, to=beyond
    ).to_dataset()
    assert behind.special_kind[0] == "saddle-node"
    assert not behind.stable[int(behind.special_point[0]) + 2]


def test_from_a_period_halving_the_branch_of_half_the_period_is_followed():
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    branch = bouncing_ball_beyond.follow(one, to=1.8)
    for expected in ((1, 1), (2, 2)):
        doubling = branch.first("period doubling")
        doubled = bouncing_ball_beyond.follow(doubling, to=1.8)
        back = bouncing_ball_beyond.follow(list(doubled.states())[3], to=1.3)
        half = bouncing_ball_beyond.follow(back.first("period halving"), to=1.55).to_dataset()
        assert (half.attrs["impacts"], half.attrs["periods"]) == expected
        assert float(half.amplitude[0]) == pytest.approx(doubling.amplitude, abs=1e-12)
        assert half.sizes["point"] > 1 and float(half.amplitude[-1]) == pytest.approx(1.55)
        branch = doubled


def test_a_branch_that_ends_at_a_special_orbit_is_not_followed_from_there(refusal):
    """At the grazing of an impact there is one impact less beyond it."""
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    last = replace(one, kind="grazing of an impact")
    with refusal(NoOrbitError, "the branch ends at the grazing of an impact"):
        bouncing_ball_beyond.follow(last, to=1.8)


def test_lines_change_from_solid_to_dashed_at_the_period_doubling():
    one = bouncing_ball_beyond.orbit(RIGID, amplitude=1.4)
    found = bouncing_ball_beyond.follow(one, to=1.8).to_dataset()
    place = float(found.special_amplitude[0])
    after = int(found.special_point[0])
    assert found.amplitude[after] < place < found.amplitude[after + 1]
    solid, dashed = (line for line in found.plot().axes[0].lines if line.get_linestyle() != "None")
    assert (solid.get_linestyle(), dashed.get_linestyle()) == ("-", "--")
    assert solid.get_xdata()[-1] == dashed.get_xdata()[0] == place


DRAWN = {
    "rigid": RIGID,
    "spring and damper": bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0),
    "corrected": bouncing_ball_beyond.corrected(
        bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    ),
    "law": bouncing_ball_beyond.contact_law("tsuji", stiffness=500.0, damping=0.1),
}


@pytest.mark.parametrize("name", DRAWN)
def test_a_branch_is_drawn_along_each_parameter(name):
    """On the axis is the parameter that varies, and each point of the branch is a point there."""
    one = bouncing_ball_beyond.orbit(DRAWN[name], amplitude=1.4)
    for along, value in {"amplitude": 1.4, **one.model.numbers()}.items():
        found = bouncing_ball_beyond.follow(
            one, along=along, to=1.002 * value, points=10
        ).to_dataset()
        (axes,) = found.plot().axes
        drawn = np.concatenate([line.get_xdata() for line in axes.lines])
        values = found[along].values
        assert np.isin(values, drawn).all() and values[0] != values[-1]


@pytest.mark.parametrize("along", ["restitution", "damping_ratio"])
def test_no_coefficient_that_varies_along_a_branch_is_called_constant(along):
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    one = bouncing_ball_beyond.orbit(ball, amplitude=1.0)
    start = float(one.law.damping_ratio) if along == "damping_ratio" else 0.85
    found = bouncing_ball_beyond.follow(one, along=along, to=1.01 * start).to_dataset()
    assert "frequency_ratio" in found.attrs
    assert not {"restitution", "damping_ratio"} & set(found.attrs)


SPRING = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
LAW = bouncing_ball_beyond.contact_law("tsuji", restitution=0.85, duration=0.3)


@pytest.mark.parametrize("ball", [RIGID, SPRING, bouncing_ball_beyond.corrected(SPRING), LAW])
def test_a_branch_has_the_observables_of_its_orbits_under_their_names(ball):
    orbit = bouncing_ball_beyond.orbit(ball, amplitude=1.2)
    found = bouncing_ball_beyond.follow(orbit, to=1.25).to_dataset().isel(point=0, impact=0)
    for name in observables.OBSERVED:
        # Newton's method moves the first point by rounding errors only.
        assert float(found[name]) == pytest.approx(getattr(orbit, name), abs=1e-14), name


@pytest.mark.parametrize("ratio", [2.0, 10.0])
def test_a_branch_starts_at_a_saddle_node_itself(ratio):
    """There Newton's method with a fixed amplitude is singular."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=ratio)
    fold = bouncing_ball_beyond.limits(ball).saddle_node
    found = bouncing_ball_beyond.follow(fold, to=0.5).to_dataset()
    assert float(found.amplitude[0]) == pytest.approx(fold.amplitude, abs=1e-12)
    assert str(found.end_reason[1].values) == "amplitude = 0.5 is reached"
