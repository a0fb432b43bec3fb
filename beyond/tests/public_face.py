"""Tests of the names that users import from a house with calls about balls.

A house's test class has its package as ``bb``.
"""

import ast
import inspect
from operator import attrgetter
from types import ModuleType

import numpy as np
import pytest
from surveys_of_balls import contact, rigid

from bouncing_ball_beyond.inherited.errors import ModelError

WRONG = [
    (
        lambda bb: bb.orbits(contact(bb), amplitude=[0.5, 1.0]),
        "amplitude must be a single number",
    ),
    (lambda bb: bb.orbit(rigid(bb), n=2.5, amplitude=1.0), "n = 2.5 is not a whole number"),
    (
        lambda bb: bb.orbit(rigid(bb), n=np.array([True]), amplitude=1.0),
        "n = True is not a whole",
    ),
    (
        lambda bb: bb.orbit(0.85, amplitude=1.0),
        "the ball = 0.85 is not a ball: it is not made by rigid",
    ),
    (lambda bb: bb.rigid(restitution=[[0.5]]), "restitution has several axes without names"),
    (
        lambda bb: bb.rigid(restitution=np.array([0.5, np.nan])),
        "restitution = nan is not a number",
    ),
    (
        lambda bb: bb.spring_damper(restitution=0.85, frequency_ratio=10.0, release="glue"),
        "release = 'glue' is not one of displacement, force",
    ),
    (
        lambda bb: bb.spring_damper(frequency_ratio=10.0),
        "one of the arguments restitution damping_ratio measured_restitution is required",
    ),
    (
        lambda bb: bb.spring_damper(frequency_ratio=1.0, restitution=0.5, damping_ratio=0.1),
        "argument damping_ratio: not allowed with argument restitution",
    ),
    (
        lambda bb: bb.spring_damper(frequency_ratio=None, damping_ratio=0),
        "frequency_ratio is missing",
    ),
    # A text of the user is shown as it is, and is no placeholder of a message.
    (
        lambda bb: bb.orbit(rigid(bb), amplitude="{law} {}"),
        "amplitude = '{law} {}' is not a num",
    ),
    (
        lambda bb: bb.error_thresholds(contact(bb), amplitude=1.0),
        "error_thresholds needs a ball made by rigid",
    ),
    (
        lambda bb: bb.error_thresholds(rigid(bb), amplitude=1.0, quantities=["mass"]),
        "quantities = 'mass' is not one of max_height",
    ),
    (
        lambda bb: bb.simulate(rigid(bb), amplitude=1.0, impacts=None),
        "impacts is missing",
    ),
]
"""Calls with a value that is wrong, and what the message says."""

WITHOUT_DIGITS = [
    lambda bb: bb.history(rigid(bb), amplitude=1e-300),
    lambda bb: bb.simulate(rigid(bb), amplitude=1.0, velocity=-1e300),
    lambda bb: bb.drop(rigid(bb), height=1e12),
]


class PublicFace:
    """The tests of a house, which has ``bb``."""

    bb: ModuleType

    def test_every_public_name_is_there_and_documented(self):
        for name in self.bb.__all__:
            assert getattr(self.bb, name).__doc__, name
        assert set(self.bb.__all__) <= set(dir(self.bb))

    def test_every_public_name_that_editors_see_is_one_that_is_imported(self):
        statements = ast.walk(ast.parse(inspect.getsource(self.bb)))
        shown = [each for each in statements if isinstance(each, ast.ImportFrom)]
        seen = {name.asname: each.module for each in shown for name in each.names if name.asname}
        package = self.bb.__name__
        assert seen == {name: f"{package}.{x}" for name, x in self.bb._MODULES.items()}
        with pytest.raises(AttributeError, match="no attribute 'model'"):
            attrgetter("model")(self.bb)

    def test_a_threshold_of_permanent_contact_is_a_number_or_has_named_axes(self):
        balls = self.bb.spring_damper(damping_ratio=[0.0, 0.1], frequency_ratio=[2.0, 4.0, 8.0])
        found = self.bb.permanent_contact(balls)
        assert dict(found.threshold_amplitude.sizes) == {"damping_ratio": 2, "frequency_ratio": 3}
        assert float(found.threshold_amplitude[0, 1]) == 1 - 1 / 16
        assert self.bb.permanent_contact(rigid(self.bb)) == 1.0

    def test_a_misspelt_parameter_is_named_with_its_function(self):
        with pytest.raises(TypeError, match=r"^orbit\(\) got an unexpected keyword .*'amplitud'"):
            self.bb.orbit(rigid(self.bb), amplitud=1.0)
        with pytest.raises(TypeError, match=r"^spring_damper\(\) missing .*'frequency_ratio'"):
            self.bb.spring_damper(restitution=0.5)

    @pytest.mark.parametrize(("call", "says"), WRONG)
    def test_wrong_values_are_refused_with_the_allowed_ones(self, call, says, refusal):
        with refusal(ModelError, says):
            call(self.bb)

    @pytest.mark.parametrize("ask", WITHOUT_DIGITS)
    def test_numbers_whose_squares_have_no_digits_are_refused(self, ask):
        with pytest.raises(ModelError, match=r"is not (0 or )?a number in \["):
            ask(self.bb)

    def test_a_table_at_rest_is_allowed(self):
        found = self.bb.simulate(rigid(self.bb), amplitude=[0.0, 1e-12], impacts=3)
        assert found.time.shape == (2, 3)

    @pytest.mark.parametrize("amplitude_max", [pytest.param(400.0, marks=pytest.mark.long), 1e4])
    def test_a_branch_is_followed_to_large_amplitudes(self, amplitude_max):
        ball = contact(self.bb)
        found = self.bb.branch(ball, amplitude_max=amplitude_max, points=20)
        assert float(found.amplitude[-1]) == pytest.approx(amplitude_max, rel=1e-12)
        # Beyond them the unstable side has more.
        kinds = ("saddle-node", "period doubling")
        for kind, limit in zip(kinds, self.bb.limits(ball), strict=True):
            located = found.special_amplitude.values[found.special_kind.values == kind]
            assert np.abs(located - limit.amplitude).min() < 1e-11
