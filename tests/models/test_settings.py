"""Tables of several harmonics, drag and springs: against a second code, and in their limits."""

from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest
from scipy.special import lambertw
from settings_by_quadrature import impacts, on_a_spring, table_of, with_drag
from side_by_side import VELOCITY, checked_deviations

import bouncing_ball
from bouncing_ball import Drag, Spring, Waveform, rigid, spring_damper
from bouncing_ball.errors import ModelError
from bouncing_ball.models.as_text import model_of, text_of
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.flight import Flight
from bouncing_ball.models.laws.hertzian import Tsuji
from bouncing_ball.models.linear_flight import LinearFlight, Pressure
from bouncing_ball.models.restitution_by_speed import RestitutionLaw, RestitutionLawModel
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.sequence import Status
from bouncing_ball.models.setting import PAPER, GeneralSetting, setting_of
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.suspension import free_responses
from bouncing_ball.models.waveform import SINE

TWO = ([1.0, 0.3], [0.0, 0.2])
CASES = {
    "table": (TWO, Drag(0.0)),
    "drag": (([1.0], [0.0]), Drag(0.3)),
    "table and drag": (TWO, Drag(0.2)),
    "spring": (([1.0], [0.0]), Spring(0.6, 0.05)),
    "pressed spring": (([1.0, 0.0, 0.1], [0.0, 0.0, 0.0]), Spring(0.4, 0.1, -3.0)),
    "spring with a gap": (([1.0], [0.0]), Spring(0.35, 0.02, 1.0)),
    "stiff spring": (TWO, Spring(2.6, 0.3, -0.5)),
}


@dataclass(frozen=True, repr=False)
class ConstantRestitution(RestitutionLaw):
    """r(v) = r."""

    r: float

    def restitution(self, speed):
        return self.r + 0 * speed


def world_of(restitution, amplitude, harmonics, flight):
    table = table_of(amplitude, *harmonics)
    if isinstance(flight, Drag):
        return table, with_drag(restitution, table, flight.drag)
    spring = flight.spring_frequency, flight.spring_damping, flight.gap
    return table, on_a_spring(restitution, table, *spring)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("amplitude", [0.6, 1.7])
def test_impacts_are_those_of_a_second_code(case, amplitude):
    harmonics, flight = CASES[case]
    table, world = world_of(0.6, amplitude, harmonics, flight)
    ball = rigid(restitution=0.6, table=Waveform(*harmonics), flight=flight)
    found = ball.simulate(amplitude, 0.3, -4.0 + table(0.3, 1), 6)
    for k in range(5):
        # One flight after the other, because each of them multiplies the errors of those before.
        (_, passed), (_, closing) = impacts(world, found.phase[k], found.relative_velocity[k], 2)
        # The integrator takes some hundred steps with a tolerance of 1e-13, and the error of the
        # height is divided by the speed of the landing.
        slow = 1e-11 / abs(closing)
        assert abs(found.time[k + 1] - found.time[k] - passed) < slow
        assert abs(found.relative_velocity[k + 1] - closing) < 3 * slow
    of_table = np.array([table(0.3 + t, 1) for t in found.time])
    assert np.allclose(found.impact_velocity, found.relative_velocity + of_table, atol=1e-12)


def test_a_sine_of_one_harmonic_is_the_table_of_the_paper():
    start = np.linspace(-2.0, 2.0, 7), -4.0
    paper = rigid(restitution=0.7).simulate(1.4, *start, 12)
    # With a second harmonic below rounding, the motion is not computed in closed form.
    other = rigid(restitution=0.7, table=Waveform([1.0, 1e-300])).simulate(1.4, *start, 12)
    # 12 impacts multiply a rounding error by less than 10⁵.
    assert np.abs(paper.time - other.time).max() < 1e-10
    assert np.abs(paper.impact_velocity - other.impact_velocity).max() < 1e-10


def test_gap_and_its_derivatives_are_those_of_the_paper_without_drag():
    phase = np.linspace(-3, 3, 20)
    v = np.linspace(0.1, 3, 20)
    time = np.geomspace(1e-7, 20, 20)
    lam = 1.3
    of_paper = Flight(0 * v, v, lam * np.cos(phase), lam * np.sin(phase), lam).gap(time)
    other = LinearFlight(0 * v, v, phase, lam, SINE, Drag(0.0)).gap(time)
    for a, b in zip(of_paper, other, strict=True):
        assert np.abs(a - b).max() < 1e-13 * (1 + time**2).max()
    # A short flight loses no digits.
    assert abs(other[0][0] / of_paper[0][0] - 1) < 1e-13


@pytest.mark.parametrize("case", CASES)
def test_derivatives_and_their_bounds(case):
    harmonics, flight = CASES[case]
    rng = np.random.default_rng(1)
    phase = rng.uniform(-3, 3, 50)
    path = LinearFlight(
        np.zeros(50), rng.uniform(0.1, 5, 50), phase, 1.2, Waveform(*harmonics), flight
    )
    start = rng.uniform(0, 8, 50)
    step = 1e-4
    low, middle, high = (path.gap(start + j * step) for j in (-1, 0, 1))
    for order in range(3):
        slope = (high[order] - low[order]) / (2 * step)
        size = 1 + np.abs(middle[order + 1]).max()
        # The central difference has an error of step² times the third derivative.
        assert np.abs(slope - middle[order + 1]).max() < 1e-6 * size
    bounds = path(start)
    for later in np.linspace(0, 30, 400):
        _, _, second, third = path.gap(start + later)
        assert np.all(-second <= bounds.second_bound * (1 + 1e-12))
        assert np.all(np.abs(third) <= bounds.third_bound * (1 + 1e-12))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_a_ball_is_aloft_before_its_earliest_landing(case, speed):
    """Also one that leaves from rest where the table already falls faster than the ball."""
    harmonics, flight = CASES[case]
    phase = np.linspace(-np.pi, np.pi, 400)
    none = np.zeros(phase.size)
    path = LinearFlight(none, none + speed, phase, 4.0, Waveform(*harmonics), flight)
    height, rate, second, _ = path.gap(none)
    leaves = (second >= 0) | (rate > 0)
    assert leaves.any() and not height.any()
    earliest = np.where(leaves, path.earliest_landing(), 0.0)
    for share in np.linspace(0, 1, 200):
        height, *_ = path.gap(share * earliest)
        # A bound that is the landing itself is so up to rounding.
        assert np.all(height >= -1e-13)


def test_responses_join_where_the_series_ends():
    for loss, stiffness in ((0.7, 0.0), (0.1, 1.0), (0.9, 0.25), (0.0, 4.0)):
        scale = max(np.sqrt(stiffness), loss)
        time = 0.5 / scale * (1 + np.array([-1e-9, 1e-9]))
        for values in free_responses(time, loss, stiffness)[:3]:
            assert abs(values[1] - values[0]) < 1e-8 * abs(values[0]) + 1e-8
        fine = np.linspace(0.0, 3.0 / scale, 2001)
        g, g_rate, step, _ = free_responses(fine, loss, stiffness)
        # The equation g″ + l g′ + q g = 0, once integrated.
        assert np.abs(g_rate + loss * g + stiffness * step - 1).max() < 1e-14
        assert np.abs(np.gradient(step, fine)[1:-1] - g[1:-1]).max() < 1e-5 / scale


@pytest.mark.parametrize("case", CASES)
def test_a_deviation_grows_as_side_by_side_balls_do(case):
    harmonics, flight = CASES[case]
    ball = rigid(restitution=0.6, table=Waveform(*harmonics), flight=flight)
    dynamics = ball.dynamics(1.7)
    start, leg, determinant = checked_deviations(dynamics)
    contraction = dynamics.contraction(start, leg.departure)[0]
    contraction *= dynamics.setting.contraction(leg.passed - leg.departure.duration)[()]
    expected = contraction * VELOCITY / leg.after.velocity
    assert abs(determinant - expected) < 1e-11 * (1 + abs(expected))


def test_time_of_flight_with_drag_is_that_of_lambert():
    c, v = 0.4, 3.0
    ball = rigid(restitution=0.5, flight=Drag(c))
    found = ball.simulate(0.0, 0.0, -v / 0.5, 2).time[1]
    big = 1 + c * v
    expected = (big + np.real(lambertw(-big * np.exp(-big)))) / c
    assert abs(found - expected) < 1e-14 * expected


def test_chattering_with_drag_ends_where_many_bounces_do():
    for flight in (Drag(0.5), Spring(0.5, 0.3, -4.0)):
        ball = rigid(restitution=0.5, flight=flight)
        dynamics = ball.dynamics(0.3)
        start = dynamics.start(np.array([0.3]), np.array([-1e-6]))
        summed = dynamics.depart(start).settling[0]
        # The same bounces, one by one, until they last for less than a rounding error.
        time = 0.0
        phase, speed = 0.3, 1e-6
        for _ in range(40):
            flown, speed = _first_landing(phase, 0.5 * speed, flight)
            time += flown
            phase += flown
        # The terms with g′ and l, which change the sum by 1e-13, are in it. The next ones are of
        # the order of T³ = 1e-17, and rounding errors of a landing are 1e-16 over its speed times
        # its time, some 1e-15.
        assert summed > 0 and abs(summed - time) < 1e-14


def _first_landing(phase, velocity, flight):
    """The time and the speed of a short flight from the table, by Newton's method."""
    path = LinearFlight(np.zeros(1), np.array([velocity]), np.array([phase]), 0.3, SINE, flight)
    time = -2 * velocity / path.gap(np.zeros(1))[2]
    for _ in range(4):
        gap, rate, _, _ = path.gap(time)
        time = time - gap / rate
    return float(time[0]), -float(path.gap(time)[1][0])


def test_lift_off_is_where_the_pressure_ends():
    setting = GeneralSetting(Waveform(*TWO), Drag(0.2))
    threshold = float(setting.threshold())
    phase = np.linspace(-np.pi, np.pi, 200_001)
    push = Pressure(phase, 1.0, setting.form, setting.suspension)(np.zeros(phase.size))
    assert abs(threshold - 1 / (1 + push.value.max())) < 1e-9
    lam = np.full(3, 2.0)
    starts = np.array([-0.6, -1.0, 2.5])
    held = setting.at_rest(starts, (None, None), lam)[1] < 1
    assert held.all()
    found = setting.lift_off(starts, lam)
    assert not found.never.any() and setting.lifts_at(found.phase, lam).all()
    for begin, wait in zip(starts, found.wait, strict=True):
        before = begin + wait * np.linspace(0, 1, 1000)[:-1]
        assert np.all(setting.at_rest(before, (None, None), np.full(999, 2.0))[1] < 1)
    assert setting.lift_off(starts, 0.99 * threshold * np.ones(3)).never.all()


def test_every_model_of_instantaneous_impacts_has_the_threshold_of_its_table():
    table = Waveform([1.0, 0.5])
    phase = np.linspace(-np.pi, np.pi, 200_001)
    # A ball at rest leaves where the downward acceleration Λ (sin τ + 2 sin 2τ) exceeds gravity.
    expected = 1 / np.max(np.sin(phase) + 2 * np.sin(2 * phase))
    by_speed = RestitutionLawModel(ConstantRestitution(0.7), setting_of(table, None))
    for ball in (by_speed, rigid(restitution=0.7, table=table)):
        # A sample is within π/200,000 of the maximum, whose curvature is at most 1 + 2³: the
        # greatest of them is lower by less than 1.2e-9, and the threshold higher by 1.6e-10.
        assert abs(bouncing_ball.permanent_contact(ball) - expected) < 1e-9


def test_a_mass_that_misses_its_stop_is_aloft():
    # The steady oscillation of amplitude Λ/|1 - ν²| = 0.53 does not reach the stop at 1.
    ball = rigid(restitution=0.8, flight=Spring(0.5, 0.1, 1.0))
    found = ball.simulate(0.4, 0.0, -3.0, 20)
    assert found.status == Status.ALOFT and 1 < found.impacts < 20
    motion = bouncing_ball.motion_of(ball, amplitude=0.4, velocity=-3.0)
    assert motion.kind.item() == "aloft" and motion.periods.item() == 1
    later = bouncing_ball.history(ball, amplitude=0.4, velocity=-3.0, periods=40)
    end = later.ball[-400:] - later.table[-400:]
    assert float(end.min()) > 0 and abs(float(end.max() - end.min()) - 2 * 0.4 / 0.7566) < 0.01


def test_permanent_contact_of_a_pressed_spring():
    ball = rigid(restitution=0.5, flight=Spring(0.35, 0.02, -1.0))
    assert abs(bouncing_ball.permanent_contact(ball) - 0.35**2) < 1e-15
    assert bouncing_ball.motion_of(ball, amplitude=0.12).kind.item() == "permanent contact"
    assert bouncing_ball.motion_of(ball, amplitude=0.13).kind.item() != "permanent contact"


def test_samples_of_a_table_are_its_harmonics():
    phase = 2 * np.pi * np.arange(64) / 64
    given = 3.0 + 0.7 * np.sin(phase) - 0.2 * np.cos(3 * phase)
    found = Waveform.of_samples(given)
    assert found == Waveform([0.7, 0.0, 0.0], [0.0, 0.0, -0.2])
    assert np.abs(found.height(phase) + 3.0 - given).max() < 1e-14
    assert hash(found) == hash(Waveform([0.7, 0.0, 0.0], [0.0, 0.0, -0.2]))
    # Three samples have one harmonic.
    fewest = Waveform.of_samples(np.sin(2 * np.pi * np.arange(3) / 3))
    assert np.abs(fewest.height(phase) - np.sin(phase)).max() < 1e-15


@pytest.mark.parametrize(
    "wrong, says",
    [
        (lambda: Waveform([]), "all zero"),
        (lambda: Waveform(["a"]), "row of numbers"),
        (lambda: Waveform([np.inf]), "finite"),
        (lambda: Waveform.of_samples([1.0, 2.0]), "three samples"),
        (lambda: Waveform.of_samples(np.arange(9.0), harmonics=5), "from 1 to 4"),
        (lambda: Drag(-0.1), "drag"),
        (lambda: Spring(0.0), "spring_frequency"),
        (lambda: Spring(0.5, 1.0), "spring_damping"),
        (lambda: Spring(0.5, gap=np.nan), "gap"),
        (lambda: rigid(restitution=0.5, flight=Spring(1.0)), "resonance"),
        (lambda: rigid(restitution=0.5, flight=Drag(np.array([0.1, 0.2]))), "single number"),
        (lambda: rigid(restitution=0.5, table="sine"), "Waveform"),
        (lambda: rigid(restitution=0.5, flight=0.1), "neither Drag nor Spring"),
        (lambda: bouncing_ball.limits(rigid(restitution=0.5, flight=Drag(0.1))), "limits"),
        (lambda: bouncing_ball.branch(rigid(restitution=0.5, flight=Drag(0.1))), "branch"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(wrong, says):
    with pytest.raises(ModelError) as caught:
        wrong()
    assert says in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("off", [0.9, 1.1])
def test_a_resonance_is_as_near_to_each_harmonic(off):
    """An undamped spring with |ν² - k²| below 1e-8 k² is refused, at k = 2 as at k = 1."""
    table = Waveform([1.0, 0.2])
    for harmonic in (1, 2):
        frequency = harmonic * np.sqrt(1 + off * 1e-8)
        if off < 1:
            with pytest.raises(ModelError, match="resonance"):
                rigid(restitution=0.5, table=table, flight=Spring(frequency))
        else:
            rigid(restitution=0.5, table=table, flight=Spring(frequency))


@pytest.mark.parametrize(
    ("waveform", "flight", "is_paper"),
    [
        (Waveform([1.0]), None, True),
        (Waveform([1.0, 0.0], [0.0, -0.0]), None, True),
        (None, Drag(0.0), True),
        (Waveform([1.0]), Drag(0), True),
        (None, Drag(1e-300), False),
        (None, Drag(np.zeros(2)), False),
        (None, Drag(np.array([0.0, 0.1])), False),
        # Its stiffness ν² is below the range of doubles, but no weight acts on it.
        (None, Spring(1e-200), False),
        (Waveform([2.0]), None, False),
        (Waveform([-1.0]), None, False),
        (Waveform([0.0], [1.0]), None, False),
        (Waveform([1.0, 1e-300]), None, False),
        (Waveform([0.0, 1.0]), None, False),
    ],
)
def test_the_setting_of_the_paper_is_known_by_its_values(waveform, flight, is_paper):
    setting = setting_of(waveform, flight)
    assert setting.is_paper == is_paper
    model = RestitutionModel(0.5, setting)
    assert (model.place is PAPER) == is_paper
    assert model.shape == setting.shape == np.shape(getattr(flight, "drag", 0.0))


def test_balls_with_the_values_of_the_paper_are_those_of_the_paper():
    for make, numbers in (
        (rigid, {"restitution": 0.5}),
        (spring_damper, {"restitution": 0.5, "frequency_ratio": 10.0}),
    ):
        paper = make(**numbers)
        for where in ({"table": Waveform([1.0])}, {"flight": Drag(0.0)}):
            other = make(**numbers, **where)
            balls = paper, other
            limits = [bouncing_ball.limits(ball) for ball in balls]
            for name in ("saddle_node", "period_doubling"):
                one, two = (getattr(each, name) for each in limits)
                assert (one.amplitude, one.phase) == (two.amplitude, two.phase)
            one, two = (bouncing_ball.branch(ball, amplitude_max=1.4) for ball in balls)
            assert np.array_equal(one.amplitude, two.amplitude)
            one, two = (bouncing_ball.simulate(ball, amplitude=1.5, impacts=9) for ball in balls)
            assert np.array_equal(one.time, two.time)
    free = spring_damper(restitution=0.5, frequency_ratio=10.0, flight=Drag(0.0))
    assert bouncing_ball.corrected(free) == bouncing_ball.corrected(paper)


@pytest.mark.parametrize("maker", [rigid, partial(spring_damper, frequency_ratio=20.0)])
def test_an_orbit_without_drag_is_followed_along_the_drag(maker):
    start = bouncing_ball.orbit(maker(restitution=0.5, flight=Drag(0.0)), amplitude=1.4)
    along = bouncing_ball.follow(start, along="drag", to=0.1)
    end = bouncing_ball.orbit(maker(restitution=0.5, flight=Drag(0.1)), amplitude=1.4)
    assert float(along.drag[0]) == 0 and abs(float(along.drag[-1]) - 0.1) < 1e-12
    assert abs(along.phase.isel(point=-1).item() - end.phase) < 1e-9


def test_settings_with_their_older_names_are_read():
    for ball in (rigid(restitution=0.5), rigid(restitution=0.5, table=Waveform(*TWO))):
        text, arrays = text_of(ball)
        older = text.replace("PaperSetting", "Setting").replace("GeneralSetting", "OtherSetting")
        assert older != text and model_of(older, arrays) == ball


def test_models_with_their_older_names_are_read():
    spring = spring_damper(restitution=0.5, frequency_ratio=10.0)
    text, arrays = text_of(spring)
    older = text.replace('ContactModel", "law"', 'SpringDamperModel", "contact"')
    assert older != text and model_of(older, arrays) == spring
    hertzian = bouncing_ball.contact_law("hunt-crossley", stiffness=1000.0, damping=0.08)
    text, arrays = text_of(hertzian)
    older = text.replace("ContactModel", "LawModel")
    assert older != text and model_of(older, arrays) == hertzian


def test_an_array_of_drags_is_a_row_of_balls():
    drags = np.array([0.0, 0.1, 0.4])
    model = RestitutionModel(0.5, GeneralSetting(SINE, Drag(drags)))
    assert model.shape == (3,)
    found = model.simulate(1.5, 0.2, -4.0, 5)
    for k, drag in enumerate(drags):
        alone = rigid(restitution=0.5, flight=Drag(float(drag))).simulate(1.5, 0.2, -4.0, 5)
        assert np.abs(found.time[:, k] - alone.time).max() < 1e-13


@pytest.mark.parametrize(
    "model",
    [
        lambda setting: RestitutionModel(0.5, setting),
        lambda setting: ContactModel(SpringDamper(10.0, 0.1), setting),
        lambda setting: ContactModel(Tsuji(900.0, 0.1), setting),
    ],
)
def test_what_is_no_setting_is_refused_in_one_line(model, refusal):
    with refusal(ModelError, "setting = 3 is not a Setting"):
        model(3)
