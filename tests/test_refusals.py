"""What the public functions refuse: each function with each argument that is wrong in one way."""

import inspect

import numpy as np
import pytest

from bouncing_ball import continuation, errors, orbits, restitution, spring_damper
from bouncing_ball.spring_damper import Contact

SCAN = [10.0, 100.0]
RIGHT = {
    "n": 1,
    "r": 0.65,
    "amplitude": 0.9,
    "impact_height": 0.5,
    "time": 1.0,
    "velocity": 4.0,
    "impacts": 8,
    "zeta": 0.1,
    "damping_ratio": 0.1,
    "ratio": 10.0,
    "frequency_ratio": 10.0,
    "ratios": np.array(SCAN),
    "duration": 0.03,
    "release": "displacement",
    "kind": "saddle-node",
    "contact": Contact(SCAN, spring_damper.damping_ratio(0.65)),
    "quantities": ["max_height", "saddle_node", "permanent_contact"],
    "orbits": continuation.stable_orbits(1, 0.65, 1.0, SCAN)[:, 0],
}
RIGHT |= {"family": orbits.Family(1, RIGHT["contact"]), "y": RIGHT["orbits"]}
WRONG = {
    "n": [0, -1, 1.5],
    "r": [0, -0.1, 1.1],
    "zeta": [-0.1, 1],
    "damping_ratio": [-0.1, 1, [0.1, 1.5]],
    "ratio": [0, -1],
    "frequency_ratio": [0, -1, [10.0, -0.5]],
    "ratios": [0, [10.0, -0.5]],
    "release": ["sticky", "Force"],
    "kind": ["period_doubling", "grazing"],
    "quantities": [["max_height", "height"]],
}
"""Values that are wrong in one way. `errors.threshold` takes any ratios."""


def calls():
    """The public functions that take one of these arguments, with arguments that are right."""
    for module in (restitution, spring_damper, orbits, continuation, errors):
        for name, function in vars(module).items():
            own = getattr(function, "__module__", "") == module.__name__
            public = own and callable(function) and not name.startswith("_")
            if not public or name == "NoOrbit":
                continue
            names = inspect.signature(function).parameters
            given = {each: RIGHT[each] for each in names if each in RIGHT}
            needed = {each for each, one in names.items() if one.default is one.empty}
            if needed <= given.keys() and given.keys() & WRONG.keys():
                yield pytest.param(function, given, id=f"{module.__name__}.{name}")


CALLS = [*calls()]


@pytest.mark.parametrize(("function", "given"), CALLS)
def test_a_wrong_argument_is_refused_in_one_line_with_the_remedy(function, given):
    function(**given)
    for argument in given.keys() & WRONG.keys():
        for value in WRONG[argument]:
            with pytest.raises(ValueError, match=r"^.*: (give|it must be) .*$") as refused:
                function(**given | {argument: value})
            shown = value[-1] if isinstance(value, list) else value
            assert f" is {shown}: " in str(refused.value).replace("'", ""), (argument, value)


def test_the_table_of_wrong_arguments_has_its_functions():
    assert len(CALLS) > 30


@pytest.mark.parametrize("ratios", [100, 100.0, [100.0], np.array([100.0]), np.array(100)])
def test_frequency_ratios_are_a_number_a_list_or_an_array(ratios):
    found = errors.errors(["max_height"], 1, 0.65, 1.0, ratios, "displacement")
    assert found["max_height"].values == pytest.approx([0.0082170], abs=5e-7)
    contact = Contact(ratios, spring_damper.damping_ratio(0.65))
    node = continuation.bifurcations([1], "saddle-node", contact)[0]
    assert node == pytest.approx(np.array([[0.662401]]), abs=1e-6)
