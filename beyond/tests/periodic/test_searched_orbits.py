"""The search for orbits along a branch: which one is taken, and how far the branch is followed."""

import numpy as np
import pytest
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import corrected_branch, n_t
from bouncing_ball_beyond.periodic.one_impact.searched_orbits import (
    SearchedOrbits,
    special_on_branch,
)
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import orbits_on_branch
from bouncing_ball_beyond.periodic.one_impact.whole_branch import whole_branch

# The branch of the compliant contact has saddle-nodes at Λ = 0.188 and 1.176 and a second stable
# side; that of the other one ends at Λ = 2.004, where the ball no longer leaves the table.
COMPLIANT = ContactModel(SpringDamper.from_restitution(0.85, 2.0))
SHORT = ContactModel(SpringDamper.from_restitution(0.65, 3.0))


@pytest.fixture
def along_the_branch(monkeypatch):
    """Newton's method finds no orbit on this side: the branch is followed from its fold."""

    def found(model, amplitude, side):
        # The signs of the sides are exchanged in the first guess, which is then refused.
        other = Side.UNSTABLE if side is Side.STABLE else Side.STABLE
        phase = "bouncing_ball_beyond.periodic.one_impact.corrected_branch.instant_phase"
        original = corrected_branch.instant_phase
        with monkeypatch.context() as patch:
            seen = []

            def wrong_first(n, instant, amplitude, stable_side=True):
                seen.append(stable_side)
                side_taken = (other is Side.STABLE) if len(seen) == 1 else stable_side
                return original(n, instant, amplitude, side_taken)

            patch.setattr(phase, wrong_first)
            return SearchedOrbits(model).orbit(1, amplitude, side)

    return found


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("amplitude", [0.4, 0.9, 1.15])
def test_the_orbit_on_the_branch_is_the_one_next_to_the_fold(along_the_branch, amplitude, side):
    """Beyond the second saddle-node there is a third orbit at each of these Λ but the first."""
    found = along_the_branch(COMPLIANT, amplitude, side)
    assert float(found.distance(n_t.orbit(COMPLIANT, 1, amplitude, side))) < 1e-10


def test_a_side_that_does_not_reach_an_amplitude_has_no_orbit_there():
    search = SearchedOrbits(COMPLIANT)
    assert not search.orbit(1, 3.0, Side.UNSTABLE).exists
    assert search.orbit(1, 3.0, Side.STABLE).exists


@pytest.mark.parametrize(
    ("amplitude", "farther", "most"),
    [
        # A multiple of Λ, of 1, and at least beyond the start, which is at 1.3 Λ.
        (1.05, 1.8, 1.8 * 1.05),
        (0.9, 1.8, 1.8),
        (0.9, 1.3, 1.3 * 1.3 * 0.9),
    ],
)
def test_a_branch_is_followed_up_to_a_multiple_of_the_amplitude(amplitude, farther, most):
    special = special_on_branch(SHORT, 1, amplitude, farther=farther)
    assert special[-1].name == "bound"
    assert float(np.sinh(special[-1].point[-1])) == pytest.approx(most, rel=1e-12)


def test_by_default_a_branch_is_followed_to_its_end():
    special = special_on_branch(SHORT, 1, 0.9)
    assert special[-1].name == "release lost"
    assert [each.name for each in special].count(Bifurcation.SADDLE_NODE) == 1


@pytest.mark.parametrize(
    ("restitution", "ratio", "release"), [(0.65, 3.0, "displacement"), (0.85, 10.0, "force")]
)
def test_the_end_of_a_branch_at_a_lost_release_is_that_of_its_closed_form(
    restitution, ratio, release
):
    """On the explicit branch δ′ + κ δ″ at the release vanishes there."""
    model = ContactModel(SpringDamper.from_restitution(restitution, ratio, release))
    law = model.impact_law
    end = whole_branch(model, 1, 20.0).special[0]
    assert end.kind == "release lost"

    def rise(excess):
        orbit = orbits_on_branch(excess, law, 1)
        acceleration = orbit.amplitude * np.sin(orbit.release_phase) - 1
        return float(orbit.relative_bounce_velocity + law.lag * acceleration)

    first = float(orbits_on_branch(0.0, law, 1).contact_duration)
    near = (end.contact_duration - first) * law.damped_frequency
    excess = brentq(rise, near - 1e-2, near + 1e-2, xtol=1e-15)
    orbit = orbits_on_branch(excess, law, 1)
    assert end.amplitude == pytest.approx(orbit.amplitude, rel=1e-12)
    # Beside a double zero the duration changes with the root of the time.
    assert end.contact_duration == pytest.approx(orbit.contact_duration, abs=1e-11)
