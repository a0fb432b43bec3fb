"""MuJoCo's law keeps the contract of a law, has its closed forms, and refuses what it cannot be."""

import inspect
import runpy
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.errors import OF_ORBITS, paper_error
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.march import march
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact
from bouncing_ball_beyond.models.laws.sweeps import Start
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.law_at_orbit import orbit_of_law
from bouncing_ball_contacts.engines.impedance import Impedance

BEYOND = Path(__file__).parents[3] / "beyond" / "tests"
LAWS = {
    "constant": Impedance(10.0, 0.136),
    "weak": Impedance(3.0, 0.05, 0.5),
    "by depth": Impedance(10.0, 0.136, 0.95, 0.5, width=0.2),
    "by depth and deep": Impedance(
        10.0, 0.05, share=0.6, at_surface=0.2, width=0.05, midpoint=0.3, power=3.0
    ),
}
SELDOM = ("weak", "by depth and deep")
TESTS = runpy.run_path(str(BEYOND / "contracts" / "test_laws.py"))
CONTRACT = [
    name
    for name, test in TESTS.items()
    if TESTS["every_law"].mark in getattr(test, "pytestmark", [])
    and [*inspect.signature(test).parameters] == ["law"]
]
STEADY = runpy.run_path(str(BEYOND / "models" / "laws" / "test_steady_contact.py"))
# Those that a test of the contract makes stiffer.
STIFFENED = [
    LAWS["constant"],
    LAWS["by depth"],
    Impedance(10.0, 5e-5, 0.95, 0.5, width=0.2),
    Impedance(10.0, 0.0, 0.95, 0.5, width=0.2),
]
TWICE = "test_a_law_of_twice_the_stiffness_pushes_a_ball_at_rest_twice_as_hard"


@pytest.mark.parametrize(
    "name",
    [pytest.param(x, marks=[pytest.mark.long] if x in SELDOM else []) for x in LAWS],
)
@pytest.mark.parametrize("test", CONTRACT)
def test_the_contract_of_a_law_is_kept(test, name):
    TESTS[test](LAWS[name])


@pytest.mark.parametrize("law", STIFFENED)
def test_an_impedance_of_twice_the_stiffness_pushes_twice_as_hard(law):
    TESTS[TWICE](law)


def test_a_constant_impedance_is_a_law_with_nothing_but_its_force():
    least = runpy.run_path(str(BEYOND / "models" / "laws" / "test_loaded.py"))["LAW"]
    known = Impedance(3.0, 0.2, 0.6)
    # Some contacts end at the surface and some where the force vanishes.
    speed = np.linspace(0.02, 4.0, 40)
    phase = np.linspace(-3.0, 3.0, 40)
    found, expected = (contacts(law, speed, phase, 1.3) for law in (least, known))
    np.testing.assert_allclose(found.duration, expected.duration, rtol=1e-12)
    np.testing.assert_allclose(found.rate, expected.rate, rtol=1e-11)
    assert rest(known) == pytest.approx(rest(least), rel=1e-12)
    # Of the closed form, and of the search.
    assert permanent_contact(known) == pytest.approx(permanent_contact(least), rel=1e-10)


def test_a_steady_contact_has_the_threshold_of_its_closed_form():
    law = Impedance(5.0, 0.2, 0.3)
    assert STEADY["_touching"](law, True) == pytest.approx(permanent_contact(law), rel=1e-10)


def test_only_a_share_of_the_weight_acts_on_a_ball_at_rest():
    # p = (1 - d)/ϖ².
    assert rest(Impedance(0.5, 0.1, 0.75)) == pytest.approx(1.0, abs=1e-12)
    assert float(under(Impedance(2.0, 0.5, 0.75), 4.0).force(1.0, -2.0)) == 3.0


@pytest.mark.parametrize("width", [1e-9, 1e-5, 0.1])
def test_a_ball_at_rest_on_a_stiff_impedance_is_held_by_force_and_load(width):
    law = Impedance(3e4, 0.1, 0.9, 0.2, width=width)
    depth = np.array(rest(law))
    assert float(under(law, 1.0).force(depth, np.array(0.0))) == pytest.approx(1.0, abs=1e-14)


def test_contacts_of_a_ball_coming_to_rest_end_despite_rounding():
    zero = np.zeros(200)
    one = np.ones(200)
    start = Start(zero, np.geomspace(1e-6, 1e-4, 200), zero + 1.456, one, one)
    assert np.isfinite(march(Impedance(31.4, 0.1335, 0.95), start, 40).duration).all()
    # The load of nearly zero lets go of these after a long contact.
    start = start._replace(rate=np.linspace(8e-4, 9e-4, 200), phase=zero - 0.1135)
    law = Impedance(104.7, 0.0535, 0.95, 0.9, width=0.016)
    assert np.isfinite(march(law, start, 400).duration).all()


def test_a_varying_impedance_does_not_depend_on_its_neighbours_in_the_row():
    # At x = 1/4 of the width d is x²/c = 1/8 of the way up, with c = 1/2, if it varies.
    law = Impedance(2.0, 0.5, 0.75, np.array([0.25, 0.75]), width=4.0)
    assert law.has_kink and law.impedance(np.ones(2)).tolist() == [0.3125, 0.75]
    # Below both kinks, at p = 5, a ball that was above the midpoint has passed a kink.
    assert law.continued(np.zeros(2), np.ones(2)).kink(np.full(2, 5.0), 0.0).tolist() == [-3.0, 1.0]


def test_an_impedance_outside_its_range_is_refused():
    for wrong in ({"midpoint": 0.0}, {"midpoint": 1.0}, {"share": 1.0}, {"power": 0.9}):
        with pytest.raises(ModelError, match=f"= {max(wrong.values())} is not"):
            Impedance(2.0, 0.5, **wrong)


@pytest.mark.parametrize("value", ["x", "2.0", True, [[1.0], [2.0, 3.0]]])
def test_a_parameter_that_is_no_number_is_refused(value, refusal):
    first, second, *_ = Impedance.parameter_names()
    for parameters in ({first: value, second: 0.1}, {first: 2.0, second: value}):
        with refusal(ModelError, f"= {value!r} is not a"):
            Impedance(**parameters)


@pytest.mark.parametrize(("zeta", "angle"), [(1.0, 2.0), (1.25, 8 / 3 * np.log(2))])
def test_an_impedance_without_oscillation_releases_the_ball(zeta, angle):
    # ϖD = 2 arcosh ζ/√(ζ² - 1) and r = exp(-ζϖD), and σ_d as for ζ < 1.
    omega = 50.0
    d = 0.95
    r = np.exp(-zeta * angle)
    impact = Impedance(omega, zeta, d).signature(1.0)
    lag = 2 * zeta / omega
    load = (1 - r) * angle / omega - (2 - d) * lag * r
    expected = [r * (angle / omega + lag) / (1 + r), r, load, angle / omega]
    assert impact[:4] == pytest.approx(expected, rel=1e-12)


def test_the_corrected_model_leaves_errors_of_second_order():
    left = []
    for duration in (0.04, 0.02):
        law = orbit_of_law(Impedance, 0.65, duration, 1, 1.0).law
        exact, corrected = (
            n_t.require_orbit(model, 1, 1.0)
            for model in (ContactModel(law), CorrectedModel(Signature(law)))
        )
        pairs = [(getattr(exact, q), getattr(corrected, q)) for q in OF_ORBITS]
        left.append([paper_error(exact=one, simple=other) for one, other in pairs])
    ratio = np.abs(np.array(left[0]) / np.array(left[1]))
    assert np.all((ratio > 3) & (ratio < 5.5))
