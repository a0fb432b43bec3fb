"""Where curves and branches of special orbits start and end, against references of their own."""

from functools import cache

import numpy as np
import pytest
from mpmath import findroot, mp, mpf, workdps
from second_code import defect_of, rates_of_release

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_period_doubling
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of

# Step of the central differences in 40 digits.
STEP = mpf("1e-13")


def elastic(name):
    if name == "rigid":
        return bouncing_ball_beyond.rigid(restitution=1.0)
    return bouncing_ball_beyond.spring_damper(restitution=1.0, frequency_ratio=10.0)


@pytest.mark.parametrize("name", ["rigid", "spring-damper"])
def test_a_curve_of_doublings_starts_without_dissipation(name):
    """Newton's method for the coefficient of the doublings left the range of r."""
    doubling = bouncing_ball_beyond.limits(elastic(name)).period_doubling
    found = bouncing_ball_beyond.follow(doubling, along=("amplitude", "restitution")).to_dataset()
    first, last = found.end_reason.values
    assert str(last) == "restitution = 1 is reached"
    assert f"restitution = {0 if name == 'rigid' else 1e-09:g}" in str(first)
    assert found.special_kind.values.tolist() == ["1:2 resonance"]
    r = found.restitution.values
    if name == "rigid":
        assert np.abs(restitution_period_doubling(1, r) - found.amplitude.values).max() < 1e-12
        return
    for k in range(len(r) // 2, len(r), 5):
        ball = bouncing_ball_beyond.spring_damper(restitution=float(r[k]), frequency_ratio=10.0)
        # The closed form of the branch.
        expected = bouncing_ball_beyond.limits(ball).period_doubling.amplitude
        assert float(found.amplitude[k]) == pytest.approx(expected, abs=1e-11)


def test_a_curve_without_dissipation_has_no_special_resonance_and_ends_in_permanent_contact():
    """All its doublings are 1:2 resonances. At ϖ = 1/2 the multipliers of permanent contact are
    exp(±2πiϖ) = -1, and without damping it ends at Λ = (1 - ϖ²)/ϖ² = 3.
    """
    ball = bouncing_ball_beyond.spring_damper(restitution=1.0, frequency_ratio=2.0)
    doubling = bouncing_ball_beyond.limits(ball).period_doubling
    found = bouncing_ball_beyond.follow(
        doubling, along=("amplitude", "frequency_ratio")
    ).to_dataset()
    assert found.sizes["special"] == 0
    ends = [str(reason) for reason in found.end_reason.values]
    merged = ends.index("the flight vanishes: the orbit merges with permanent contact")
    last = found.isel(point=[0, -1][merged])
    # The flight that is left.
    left = 2 * np.pi - float(last.contact_duration[0])
    assert left < 0.1
    assert abs(float(last.frequency_ratio) - 0.5) < left
    assert abs(float(last.amplitude) - 3.0) < 2 * left


def test_a_curve_of_orbits_on_a_resting_table_is_refused(refusal):
    fold = bouncing_ball_beyond.limits(elastic("rigid")).saddle_node
    with refusal(NoOrbitError, "the table rests at this orbit, where the phase has no meaning"):
        bouncing_ball_beyond.follow(fold, along=("amplitude", "restitution"))


class Contact:
    """A contact with r = 0.85 that is released at δ = 0, in closed form (Eqs. 12-13), and the
    flight after it.

    At such a release the acceleration of the contact differs from that of the flight by
    -2ζϖ ρ, with ρ = δ′ at the release. The time of the release varies by -∇δ/ρ, so that ρ cancels
    in the derivative of the return map, which is smooth where the release is lost, at ρ = 0.
    """

    def __init__(self, phase, velocity, duration, amplitude, ratio):
        self.state = (phase, velocity)
        self.duration = duration
        self.amplitude = amplitude
        self.ratio = ratio
        logarithm = mp.log(mpf("0.85"))
        self.damping = -logarithm / mp.sqrt(mp.pi**2 + logarithm**2)

    def release(self, phase, velocity):
        """δ and δ′ at the end of the contact."""
        w = self.ratio
        rate = self.damping * w
        inner = w * mp.sqrt(1 - self.damping**2)
        scale = (w * w - 1) ** 2 + (2 * rate) ** 2

        def steady(s):
            wave = (w * w - 1) * mp.sin(phase + s) - 2 * rate * mp.cos(phase + s)
            slope = (w * w - 1) * mp.cos(phase + s) + 2 * rate * mp.sin(phase + s)
            return self.amplitude * wave / scale - 1 / w**2, self.amplitude * slope / scale

        level, slope = steady(0)
        a = -level
        b = (velocity - slope + rate * a) / inner
        cosine = mp.cos(inner * self.duration)
        sine = mp.sin(inner * self.duration)
        shrunk = mp.exp(-rate * self.duration)
        level, slope = steady(self.duration)
        transient = a * cosine + b * sine
        turned = inner * (b * cosine - a * sine)
        return shrunk * transient + level, shrunk * (turned - rate * transient) + slope

    def landing(self, phase, velocity, push=0):
        """The phase and δ′ at the landing after 2π, with an additional velocity at the release."""
        gap, rate = self.release(phase, velocity)
        rate = rate + push
        left = phase + self.duration
        lam = self.amplitude

        def height(t):
            fall = mp.sin(left + t) - mp.sin(left) - t * mp.cos(left)
            return gap + rate * t - t * t / 2 - lam * fall

        def speed(t):
            return rate - t - lam * (mp.cos(left + t) - mp.cos(left))

        t = 2 * mp.pi - self.duration
        for _ in range(8):
            t -= height(t) / speed(t)
        return left + t, speed(t)

    def derivative(self, quantity, *direction):
        """The derivative of a function of the state and the additional velocity."""
        phase, velocity = self.state
        sides = []
        for sign in (1, -1):
            p, v, *push = (sign * STEP * each for each in direction)
            sides.append(quantity(phase + p, velocity + v, *push))
        return [(x - y) / (2 * STEP) for x, y in zip(*sides, strict=True)]

    def doubling(self):
        """det(M + 1)."""
        pushed = self.derivative(self.landing, 0, 0, 1)
        columns = []
        for direction in ((1, 0), (0, 1)):
            moved = self.derivative(self.landing, *direction, 0)
            opens = self.derivative(self.release, *direction)[0]
            later = 2 * self.damping * self.ratio * opens
            columns.append([x + later * y for x, y in zip(moved, pushed, strict=True)])
        (a, c), (b, d) = columns
        return (1 + a) * (1 + d) - b * c


def doubling_without_release(*unknowns):
    """The equations of a 1-T orbit at a period doubling whose release has no speed."""
    contact = Contact(*unknowns)
    phase, velocity = contact.state
    landing = contact.landing(phase, velocity)
    return [
        *contact.release(phase, velocity),
        landing[0] - phase - 2 * mp.pi,
        landing[1] - velocity,
        contact.doubling(),
    ]


@cache
def curve_of_a_doubling(number):
    """The curve in Λ and ϖ through one of the doublings of a compliant contact."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=2.0)
    states = bouncing_ball_beyond.branch(ball).special_states()
    doubling = [orbit for kind, orbit in states if kind == "period doubling"][number]
    along = ("amplitude", "frequency_ratio")
    return bouncing_ball_beyond.follow(doubling, along=along).to_dataset()


# The other doubling lies on the same curve: of its ends below, and of these weekly.
@pytest.mark.parametrize("number", [0, pytest.param(1, marks=pytest.mark.long)])
def test_a_curve_of_doublings_of_long_contacts_ends_where_the_release_is_lost(number):
    """It ended with "16 steps lead 8.0e-04"; the place in 40 digits, before which the steps get too
    short.
    """
    found = curve_of_a_doubling(number)
    top = [0, -1][int(np.argmax(found.frequency_ratio.values[[0, -1]]))]
    last = list(found.states())[top]
    start = [last.phase, last.relative_impact_velocity, last.contact_duration]
    with workdps(40):
        guess = [mpf(x) for x in (*start, *last.parameters.values())]
        *_, amplitude, ratio = findroot(doubling_without_release, guess, tol=1e-25)
    assert float(amplitude) == pytest.approx(1.45526, abs=1e-5)
    place = found.isel(point=top)
    assert float(place.amplitude) == pytest.approx(float(amplitude), abs=0.02)
    assert float(place.frequency_ratio) == pytest.approx(float(ratio), abs=0.02)
    # Both ends of the curve are of this kind.
    assert all("release without speed" in str(reason) for reason in found.end_reason.values)


@pytest.mark.parametrize("number", [0, pytest.param(1, marks=pytest.mark.long)])
def test_all_generalized_doublings_of_a_curve_are_found_from_either_side(number):
    """The coefficient of the normal form changes its sign there, and nowhere else."""
    found = curve_of_a_doubling(number)
    at = np.sort(found.special_frequency_ratio.values)
    assert at == pytest.approx([2.0065216, 2.2136510], abs=1e-6)
    inner = list(found.states())[2:-2:3]
    above = [bouncing_ball_beyond.normal_form(orbit).is_supercritical for orbit in inner]
    assert np.count_nonzero(np.diff(above)) == 2


@pytest.mark.parametrize("name", ["rigid", "spring-damper", "long contact"])
def test_doubled_orbits_are_followed_to_the_side_of_the_normal_form(name, refusal):
    if name == "rigid":
        doublings = [
            bouncing_ball_beyond.limits(bouncing_ball_beyond.rigid(restitution=0.5)).period_doubling
        ]
    else:
        ratio = {"spring-damper": 10.0, "long contact": 2.0}[name]
        ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=ratio)
        states = bouncing_ball_beyond.branch(ball).special_states()
        doublings = [orbit for kind, orbit in states if kind == "period doubling"]
    for doubling in doublings:
        upwards = bouncing_ball_beyond.normal_form(doubling).opens_upwards
        at = doubling.amplitude
        aside = 0.01 if upwards else -0.01
        found = bouncing_ball_beyond.follow(doubling, to=at + aside, points=40).to_dataset()
        assert np.sign(float(found.amplitude[1]) - at) == np.sign(aside)
        assert "period halving" not in found.special_kind.values[:1].tolist()
        where = "above" if upwards else "below"
        message = (
            f"to = {at - aside:g} is beyond the period doubling: the orbits of twice the period "
            f"exist next to it only for amplitude {where} {at:g}"
        )
        with refusal(NoOrbitError, message):
            bouncing_ball_beyond.follow(doubling, to=at - aside)


def test_a_doubled_branch_goes_away_from_its_start_if_no_value_is_given():
    """Of a subcritical doubling it went up, back to the start."""
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=2.0)
    states = bouncing_ball_beyond.branch(ball).special_states()
    doublings = [orbit for kind, orbit in states if kind == "period doubling"]
    down = [each for each in doublings if not bouncing_ball_beyond.normal_form(each).opens_upwards]
    assert down
    for doubling in down:
        found = bouncing_ball_beyond.follow(doubling, points=20).to_dataset()
        assert float(found.amplitude[1]) < doubling.amplitude
        assert found.sizes["point"] > 3


BALLS = {
    "rigid": bouncing_ball_beyond.rigid(restitution=0.85),
    "stiff": bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=1e4),
    "compliant": bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0),
    "law": bouncing_ball_beyond.contact_law("tsuji", restitution=0.85, duration=0.31),
}


@pytest.mark.parametrize("name", BALLS)
def test_a_branch_does_not_list_the_saddle_node_at_which_it_starts(name):
    for n in (1,) if name == "law" else (1, 3):
        ends = bouncing_ball_beyond.limits(BALLS[name], n=n)
        top = 1.1 * ends.period_doubling.amplitude
        found = bouncing_ball_beyond.follow(ends.saddle_node, to=top).to_dataset()
        # What the branch has, from the closed form or from the equations of the bifurcations.
        assert found.special_kind.values.tolist() == ["period doubling"]
        place = float(found.special_amplitude[0])
        assert place == pytest.approx(ends.period_doubling.amplitude, abs=1e-10)


@pytest.mark.parametrize(
    ("restitution", "ratio"), [(0.85, 2.0), pytest.param(0.3, 1.5, marks=pytest.mark.long)]
)
def test_branch_and_follow_name_permanent_contact_in_the_same_words(restitution, ratio):
    ball = bouncing_ball_beyond.spring_damper(restitution=restitution, frequency_ratio=ratio)
    whole = bouncing_ball_beyond.branch(ball)
    merged = "the flight vanishes: the orbit merges with permanent contact"
    assert str(whole.end_reason[0].values) == merged
    threshold = float(permanent_contact_threshold(ratio, damping_ratio(restitution)))
    # Λ is off by the square of the flight left.
    assert float(whole.amplitude[0]) == pytest.approx(threshold, abs=1e-6)
    inner = list(whole.states())[20]
    towards = threshold - 0.3 * np.sign(inner.amplitude - threshold)
    followed = bouncing_ball_beyond.follow(inner, to=float(towards)).to_dataset()
    assert str(followed.end_reason[1].values) == merged


def test_branch_and_follow_name_a_landing_without_speed_in_the_same_words():
    """After a release by force, the ball returns to the level of the table only just."""
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.2722, frequency_ratio=0.724, release="force"
    )
    whole = bouncing_ball_beyond.branch(ball, amplitude_max=3.0)
    first, *rest = whole.states()
    assert first.flight_time > 1.0
    assert abs(first.relative_impact_velocity) == pytest.approx(1e-4, rel=1e-6)
    inner = rest[40]
    to = first.amplitude - 0.3 * np.sign(inner.amplitude - first.amplitude)
    followed = bouncing_ball_beyond.follow(inner, to=float(to)).to_dataset()
    assert str(followed.end_reason[1].values) == str(whole.end_reason[0].values)
    assert str(whole.end_reason[0].values).startswith("grazing of an impact: ")
    assert float(followed.amplitude[-1]) == pytest.approx(first.amplitude, abs=1e-6)


def branch_to_a_lost_release_of_a_law():
    ball = bouncing_ball_beyond.contact_law("hunt-crossley", restitution=0.25, duration=0.4755)
    return bouncing_ball_beyond.branch(ball, amplitude_max=3.3, points=10)


LOST = "the orbit is next to a release without speed, where its equations are not smooth"


def test_a_branch_of_a_law_ends_where_the_release_is_lost():
    """The durations of its contacts are no unknowns, so that the place is not located."""
    whole = branch_to_a_lost_release_of_a_law()
    assert str(whole.end_reason[0].values) == LOST
    assert "release lost" not in whole.special_kind.values
    first = next(whole.states())
    # A second code agrees that the orbit closes, and that the ball hardly leaves the table.
    assert defect_of(first) < 1e-8
    assert 0 < rates_of_release(first)[0] < 1e-2 * abs(first.relative_impact_velocity)


@pytest.mark.long
def test_branch_and_follow_name_a_lost_release_of_a_law_in_the_same_words():
    first, inner, *_ = branch_to_a_lost_release_of_a_law().states()
    followed = bouncing_ball_beyond.follow(inner, to=1.1 * first.amplitude, points=30).to_dataset()
    assert str(followed.end_reason[1].values) == LOST
    assert "release lost" not in followed.special_kind.values
    assert float(followed.amplitude[-1]) == pytest.approx(first.amplitude, abs=1e-6)


def test_a_curve_of_grazings_ends_with_its_reason():
    """It ended with the words of the corrector, or at a corner of a map that has none."""
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.2519, frequency_ratio=24.19, release="force"
    )
    grazing = next(
        orbit
        for one in bouncing_ball_beyond.orbits(ball, n=1, amplitude=2.4413)
        for kind, orbit in bouncing_ball_beyond.follow(one, to=2.6).special_states()
        if kind == "grazing of a flight"
    )
    found = bouncing_ball_beyond.follow(
        grazing, along=("amplitude", "frequency_ratio")
    ).to_dataset()
    first, last = map(str, found.end_reason.values)
    assert first == (
        "where the flight touches the table, its minimum merges with a maximum, at about "
        "amplitude = 1.71, frequency ratio = 3.06"
    )
    assert last == "the points accumulate next to frequency ratio = 1e+08, the end of its range"
    assert float(found.amplitude[-1]) == pytest.approx(2.5435, abs=1e-4)
    # δ = δ′ = δ″ = 0 there, by the motion of a ball that leaves as the first orbit does.
    one = next(found.states())
    problem, y = equations_of(one, "amplitude")
    flight = problem.legs(y).departure.flight
    time = np.linspace(0.5, 1.1, 601)
    height, rate, second, _ = np.array([flight.gap(np.array([t])) for t in time])[..., 0].T
    at = np.argmin(np.abs(rate))
    assert abs(height[at]) < 1e-5 and abs(rate[at]) < 1e-5 and abs(second[at]) < 1e-2
    # The differences of the condition end before the range does.
    found = bouncing_ball_beyond.follow(grazing, along=("amplitude", "restitution")).to_dataset()
    for reason, end in zip(found.end_reason.values, ("1e-09", "1"), strict=True):
        assert str(reason) == (
            f"the points accumulate next to restitution = {end}, the end of its range"
        )


def test_a_curve_ends_where_an_impact_vanishes():
    """It went on with an impact from below the table, at δ′ up to 2.2, and to r = 0."""
    ball = bouncing_ball_beyond.rigid(restitution=0.85)
    found = bouncing_ball_beyond.orbits(ball, impacts=3, periods=3, amplitude=2.0)
    branches = [bouncing_ball_beyond.follow(one, to=(1.0, 4.0)) for one in found[:2]]
    ends = []
    for fold in (one for each in branches for one in each.special_states()):
        if fold[0] != "saddle-node":
            continue
        curve = bouncing_ball_beyond.follow(
            fold[1], along=("amplitude", "restitution")
        ).to_dataset()
        assert all(np.all(each.relative_impact_velocity < 0) for each in curve.states())
        ends += map(str, curve.end_reason.values)
    assert any("grazing of an impact" in end for end in ends)
