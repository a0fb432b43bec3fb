"""Parameters of an engine that contain its time step: the range of r at this step."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import RUN, Trial
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.cli.design_text import design_lines
from bouncing_ball_contacts.engines.engine import filled, text_to_paste

M = 0.5
PYBULLET = {"contactStiffness": 2e5, "contactDamping": 20.0}
DRAKE = {"point_contact_stiffness": 2e5, "relaxation_time": 1e-4}
CASES = [("pybullet", PYBULLET, 0.0041667), ("pybullet", PYBULLET, 1e-3), ("drake", DRAKE, 2e-3)]


def at_its_step(name, parameters, step):
    given = {"mass": M, "from_engine": name, "parameters": parameters | {"time_step": step}}
    return answered(**given).at_step


def implicit_euler(k, c, h, fraction):
    """r of a ball that meets the wall so many steps before the first one in contact."""
    x = -fraction * h
    v = -1.0
    while x < 0:
        # m (v⁺ - v)/h = -k x⁺ - c v⁺, where x⁺ = x + h v⁺, unless the wall would pull.
        v = max((v - h * k / M * x) / (1 + h * c / M + h * h * k / M), v)
        x += h * v
    return v


@pytest.mark.parametrize(("name", "parameters", "step"), CASES)
def test_the_range_is_that_of_the_steps(name, parameters, step):
    at = at_its_step(name, parameters, step)
    stiff, lossy = parameters.values()
    c = 2 * lossy if name == "pybullet" else stiff * lossy
    many = [implicit_euler(stiff / 2, c, step, f) for f in np.linspace(1e-6, 1, 2001)]
    # Instants 5e-4 apart; r changes by less than 2 over one step.
    assert (at.least, at.most) == pytest.approx((min(many), max(many)), abs=1e-3)
    assert at.mean == pytest.approx(np.mean(many), abs=1e-3)
    assert at.is_of_parameters and not at.is_within
    # In place of the r of small steps, by ζ = c/(2√(km)).
    zeta = c / (2 * np.sqrt(stiff / 2 * M))
    angle = np.pi - 2 * np.arcsin(zeta)
    assert at.restitution == pytest.approx(np.exp(-zeta * angle / np.sqrt(1 - zeta**2)))


def test_the_text_has_the_range_in_place_of_a_number(said):
    options = ["--from=pybullet", "--mass=0.5", "--set=time_step=0.0041667"]
    options += [f"--set={name}={value}" for name, value in PYBULLET.items()]
    text = said("design", "--all", *options)
    (row,) = [line for line in text.splitlines() if line.startswith("restitution of a free")]
    assert row.split(maxsplit=5)[5] == "0.1071 to 0.5145 at this step"
    assert "Note: all numbers but r are those of the contact whose positions these steps" in text
    assert "restitution of a free" not in said("design", *options)
    options += ["--frequency=20 Hz", "--acceleration=0.8 g"]
    text = said("design", *options)
    assert "Note: motion, verdict and orbits are those of the contact whose positions these" in text


def test_another_contact_has_no_step_among_its_parameters(refusal):
    with refusal(ModelError, "lammps has no 'time_step'", "given by --time-step"):
        at_its_step("lammps", {"kn": 1e5, "gamma_n": 1.0}, 1e-3)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("name", "parameters", "step"), CASES)
def test_the_engine_itself_has_this_range(name, parameters, step):
    only_if_installed(name)
    numbers = {"time_step": step, "mass": M, "stiffness": 0, "damping": 0, **parameters}
    snippet = filled(text_to_paste(name), {key: repr(value) for key, value in numbers.items()})
    settings = SimpleNamespace(snippet=snippet, time_step=step)
    steps = round(0.05 / step) + 10
    found = []
    for fraction in np.linspace(0.001, 0.999, 101):
        away, _ = RUN[name](Trial(settings, M, fraction * step, -1.0, steps))
        found.append((away[-1] - away[-2]) / step)
    at = at_its_step(name, parameters, step)
    # Instants 0.01 steps apart, at a slope of r of up to 1 in a step.
    assert (at.least, at.most) == pytest.approx((min(found), max(found)), abs=0.01)
    assert at.least - 1e-3 <= min(found) and max(found) <= at.most + 1e-3


def test_a_retuned_contact_is_said_in_parameters_that_have_its_r():
    """PyBullet's steps damp, so that its parameters have less damping than the contact."""
    parameters = {"contactStiffness": 1e5, "contactDamping": 50.0}
    given = {"mass": M, "from_engine": "pybullet", "parameters": parameters}
    answer = answered(**given, time_step=1e-3)
    text = "\n".join(design_lines(answer))
    found = re.search(
        r"the mean r is \S+ at this step, written as contactStiffness = (\S+) and "
        r"contactDamping = (\S+)\.",
        text,
    )
    assert found
    stiff, lossy = map(float, found.groups())
    many = [implicit_euler(stiff / 2, 2 * lossy, 1e-3, f) for f in np.linspace(1e-6, 1, 2001)]
    # The instants are those above, and the parameters have six digits.
    assert np.mean(many) == pytest.approx(answer.at_step.restitution, abs=1e-3)
    # The parameters that were given lose more.
    before = [implicit_euler(5e4, 100.0, 1e-3, f) for f in np.linspace(1e-6, 1, 201)]
    assert np.mean(before) < answer.at_step.restitution - 0.02
