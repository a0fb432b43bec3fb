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
    "orbits": continuation.upper_orbits(1, 0.65, 1.0, SCAN)[:, 0],
}
RIGHT |= {"family": orbits.Family(1, RIGHT["contact"]), "y": RIGHT["orbits"]}
RIGHT |= {"points": 21, "largest_step": 0.2, "amplitude_max": 1.2, "tolerance": 0.05}
RIGHT["error"] = errors.Error(1 / RIGHT["ratios"], lambda ratio, below, curve: 1 / ratio)
ONE_CONTACT = orbits.Family(1, Contact.of_restitution(10.0, 0.65))
COLUMN = np.ones((1, 1))
ROW = orbits.Family(COLUMN, Contact(SCAN, 0.14 * COLUMN))
OTHERS = {
    "branch": {"family": ONE_CONTACT},
    "laid_ranges": {"family": ONE_CONTACT},
    "departure": {"amplitude": 1.2},
    "orbits_along": {"family": ROW, "amplitude": COLUMN},
    "enough_from": {
        "family": ROW,
        "orbits": errors.orbits_along(ROW, COLUMN),
        "r": 0.65 * COLUMN,
        "amplitude": COLUMN,
    },
    "permanent_contact_ratios": {"amplitude": 0.9},
}
"""Arguments that are right for one function only."""
WRONG = {
    "n": [0, -1, 1.5, np.nan],
    "r": [0, -0.1, 1.1, np.inf],
    "zeta": [-0.1, 1, np.inf],
    "damping_ratio": [-0.1, 1, [0.1, 1.5]],
    "ratio": [0, -1],
    "frequency_ratio": [0, -1, [10.0, -0.5]],
    "ratios": [0, [10.0, -0.5]],
    "release": ["sticky", "Force"],
    "kind": ["period_doubling", "grazing"],
    "quantities": ["max_height", ["max_height", "height"]],
    "duration": [0, -1, np.nan, np.inf],
    "points": [0, 1, 20.5, np.nan],
    "largest_step": [0, -0.1, np.nan, np.inf],
    "tolerance": [0, -0.1, np.nan, [0.1, -0.5]],
}
"""Values that are wrong in one way."""
SEARCHED = {
    "r": [np.nan],
    "ratios": [np.nan, np.inf, [10.0, np.nan]],
    "amplitude": [np.nan, np.inf],
    "amplitude_max": [np.nan, np.inf],
}
"""Values that closed forms return as NaN or as a limit, and for which no orbit can be found."""
SEARCHES = (
    *("upper_orbits", "stable_orbits", "branch", "errors", "orbits_along"),
    *("bifurcation_errors", "lowest_period_doublings"),
)


def calls():
    """The public functions that take one of these arguments, with arguments that are right."""
    for module in (restitution, spring_damper, orbits, continuation, errors):
        for name, function in vars(module).items():
            own = getattr(function, "__module__", "") == module.__name__
            public = own and callable(function) and not name.startswith("_")
            if not public or name == "NoOrbit":
                continue
            names = inspect.signature(function).parameters
            given = {
                argument: RIGHT[argument] for argument in names if argument in RIGHT
            } | OTHERS.get(name, {})
            needed = {argument for argument, one in names.items() if one.default is one.empty}
            if needed <= given.keys() and given.keys() & (WRONG | SEARCHED).keys():
                yield pytest.param(function, given, id=f"{module.__name__}.{name}")


CALLS = [*calls()]


@pytest.mark.parametrize(("function", "given"), CALLS)
def test_a_wrong_argument_is_refused_in_one_line_with_the_remedy(function, given):
    function(**given)
    searched = SEARCHED if function.__name__ in SEARCHES else {}
    for argument in given:
        for value in [*WRONG.get(argument, []), *searched.get(argument, [])]:
            with pytest.raises(ValueError, match=r"^.*: (give|it must be) .*$") as refused:
                function(**given | {argument: value})
            shown = value[-1] if isinstance(value, list) else value
            assert f" is {shown}: " in str(refused.value).replace("'", ""), (argument, value)


def test_the_table_of_wrong_arguments_has_its_functions():
    assert len(CALLS) > 30
    assert {*SEARCHES} <= {call.values[0].__name__ for call in CALLS}


@pytest.mark.parametrize("name", ["errors", "threshold", "lowest_period_doublings"])
@pytest.mark.parametrize("ratios", [[100.0, 10.0], [10.0, 10.0]])
def test_ratios_that_do_not_ascend_are_refused(name, ratios):
    function, given = next(
        call.values for call in CALLS if call.id == f"bouncing_ball.errors.{name}"
    )
    with pytest.raises(ValueError, match=r"^ϖ is 10: give finite ϖ > 0 in ascending order$"):
        function(**given | {"ratios": np.array(ratios)})


@pytest.mark.parametrize("release", spring_damper.RELEASES)
def test_limits_and_missing_contacts_have_their_values(release):
    """As ϖ tends to infinity, a ball at rest stays up to Λ = 1."""
    limits = spring_damper.permanent_contact(np.array([np.inf, 1e200, np.nan]), 0.1, release)
    np.testing.assert_array_equal(limits, [1, 1, np.nan])
    with pytest.raises(ValueError, match=r"^Λ is 1: give 0 <= Λ < 1$"):
        spring_damper.permanent_contact_ratios(1, 0.1)
    with pytest.raises(ValueError, match=r"^Λ is -1: give Λ >= 0$"):
        restitution.max_height(1, 0.65, [1, -1])
    with pytest.raises(ValueError, match=r"^ϖ is inf: give finite ϖ > 0$"):
        Contact([np.inf, np.nan], 0.1)
    with pytest.raises(ValueError, match=r"^r is 0\.1: with the force release, r must be above"):
        spring_damper.contact_of_duration(0.02, 0.1, "force")


@pytest.mark.parametrize("ratios", [100, 100.0, [100.0], np.array([100.0]), np.array(100)])
def test_frequency_ratios_are_a_number_a_list_or_an_array(ratios):
    by_quantity = errors.errors(["max_height"], 1, 0.65, 1.0, ratios, "displacement")
    assert by_quantity["max_height"].values == pytest.approx([0.0082170], abs=5e-7)
    contact = Contact(ratios, spring_damper.damping_ratio(0.65))
    node = continuation.bifurcations([1], "saddle-node", contact)[0]
    assert node == pytest.approx(np.array([[0.662401]]), abs=1e-6)
