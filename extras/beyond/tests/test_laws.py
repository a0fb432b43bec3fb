"""Force laws by an integrator in plain time, by closed forms, and by the spring and damper."""

from collections.abc import Callable

import numpy as np
import pytest
from integrated import SINE, contact, touching
from own_laws import flores, hunt_crossley_linear, limited_damper, stepped_spring
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import gamma

from bouncing_ball_beyond.contacts import root_time
from bouncing_ball_beyond.contacts.balls import Corrected, H, Rigid, SpringDamper
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.contacts.named_laws import (
    adams_impact,
    hunt_crossley,
    kuwabara_kono,
    law_of_impact,
    linear,
    simscape_contact,
    tsuji,
)
from bouncing_ball_beyond.errors.error_law import error_thresholds, law_thresholds
from bouncing_ball_beyond.motions.long_term import motion_of
from bouncing_ball_beyond.periodic.continuation import follow as path_follow
from bouncing_ball_beyond.periodic.orbits import orbit
from bouncing_ball_beyond.tables.table import Table

# The integrator and the panels each have errors of some 1e-12 of the speed.
CLOSE = 1e-11


def at_event(rates, event, solution):
    """Time and state at an event, by a step that ends there.

    The interpolation of the last step is not smooth, because this step crosses a kink.
    """

    def reached(t):
        start, state = solution.t[-2], solution.y[:, -2]
        step = solve_ivp(rates, (start, t), state, "DOP853", rtol=3e-14, atol=1e-16)
        return step.y[:, -1]

    late = solution.t[-1]
    early = max(solution.t[-2], late - 1e-6)
    t = brentq(lambda t: event(t, reached(t)), early, late + 1e-6, xtol=1e-15)
    return t, reached(t)


def integrated(law, tau, u, amplitude, gravity=1.0, longest=10.0):
    """D, p and w of a contact by DOP853 in plain time, from kink to kink."""
    more = {"start_speed": u} if "start_speed" in law.needs else {}

    def rates(t, state):
        a = gravity - amplitude * np.sin(tau + t)
        load = {"load": a} if "load" in law.needs else {}
        p = max(state[0], 0.0)
        return [state[1], a - float(law.force(p, state[1], **law.values, **more, **load))]

    def end(t, state):
        if law.release == "displacement":
            return state[0]
        return float(law.force(max(state[0], 0.0), state[1], **law.values))

    def event_of(kink):
        return lambda t, state: float(kink(max(state[0], 0.0), state[1], **law.values))

    events = [end, *map(event_of, law.kinks)]
    for event in events:
        event.terminal = True
    end.direction = -1
    t, state = 0.0, np.array([0.0, u])
    while t < longest:
        solution = solve_ivp(
            rates,
            (t, longest),
            state,
            "DOP853",
            events=events,
            rtol=3e-14,
            atol=1e-16,
            first_step=1e-6,
            # The stepped spring pushes only in the last 1 % of an impact that lasts 0.12. A longer
            # step misses this push if none of its stages is in it.
            max_step=1e-3,
        )
        which = [i for i, times in enumerate(solution.t_events) if times.size]
        if not which:
            break
        t, state = at_event(rates, events[which[0]], solution)
        if which == [0]:
            return t, state[0], -state[1]
        # Past the kink.
        state = state + 1e-9 * np.array(rates(t, state))
        t += 1e-9
    raise AssertionError("no end")


def one_line(error):
    assert "\n" not in str(error.value)


NAMED = (linear, hunt_crossley, tsuji, kuwabara_kono, adams_impact, simscape_contact)
IMPACTS = {law.__name__: law(restitution=0.7, duration=0.12, speed=3.0) for law in NAMED}
IMPACTS["flores"] = law_of_impact(
    lambda g, P, v: flores(v**2 / P**2.5, 8 / (8 + 5 * g)), 0.7, 0.12, 3.0
)
IMPACTS["stepped spring"] = law_of_impact(
    lambda g, P, v: stepped_spring((v / P) ** 2, g * v / P, 0.1 * P), 0.7, 0.12, 3.0
)
IMPACTS["limited damper"] = law_of_impact(lambda g, P, v: limited_damper(v / P, g), 0.7, 0.12, 3.0)


def test_a_law_without_a_rebound_is_followed():
    """Its free impacts do not end, and are no guess of those on the table."""
    ball = tsuji(stiffness=1e3, damping=2.5)
    assert np.isnan(ball.free(3.0))
    branch = path_follow(orbit(ball, amplitude=3.0), to=2.8)
    assert branch.end == "amplitude = 2.8 is reached"
    tau, u, T, amplitude = branch.z[-1]
    duration, *_ = integrated(ball, tau, u, amplitude)
    assert abs(ball.contact(tau, u, T, amplitude).duration - duration) < 1e-8


def test_a_corrected_ball_needs_no_rebound_of_slow_impacts():
    law = ForceLaw(lambda p, v, k, c: k * p * p + c * v, {"k": 900.0, "c": 9.0})
    corrected, exact = (orbit(ball, amplitude=2.4) for ball in (Corrected(law), law))
    assert np.isnan(law.free(1.0)) and abs(corrected.max_height / exact.max_height - 1) < 1e-3


class TestPermanentContact:
    """Contacts in which balls are shaken for some periods before they leave, or stay."""

    @pytest.mark.parametrize(
        "law, amplitude",
        [
            (tsuji(restitution=0.6, duration=4.0, speed=3.0), 0.493),
            (hunt_crossley(restitution=0.95, duration=1.5, speed=3.0), 0.59),
        ],
    )
    def test_those_that_stay_do_not_leave_within_eight_periods(self, law, amplitude):
        phases = np.linspace(-3.0, 3.0, 13)
        _, impact = law.first_impact(phases, np.full(13, 0.02), amplitude)
        stays = np.isnan(impact.duration)
        assert 0 < stays.sum() < 13
        for tau in phases[stays][::3]:
            with pytest.raises(AssertionError, match="no end"):
                integrated(law, tau, 0.02, amplitude, longest=8 * 2 * np.pi)
        latest = np.nanargmax(impact.duration)
        end, *_ = integrated(law, phases[latest], 0.02, amplitude, longest=60.0)
        assert end > 4 * np.pi
        assert abs(impact.duration[latest] - end) < 1e-8

    @pytest.mark.parametrize(
        "law, amplitude, tau, u, harmonics",
        [
            (hunt_crossley(restitution=0.6, duration=1.5, speed=3.0), 0.719, 0.5, 0.02, SINE),
            (
                hunt_crossley(restitution=0.965, duration=0.45, speed=3.0),
                0.2164,
                0.54,
                0.0104,
                ((1, 1.0, 0.0), (3, 0.3, -0.17)),
            ),
        ],
    )
    def test_a_ball_may_leave_after_three_quiet_periods(self, law, amplitude, tau, u, harmonics):
        """From one period to the next, the place of the ball has hardly changed before."""
        table = Table(harmonics)
        _, impact = law.first_impact(np.array([tau]), np.array([u]), amplitude, table=table)
        end, *_ = contact(law, amplitude, tau, u, harmonics)
        assert end - tau > 3 * 2 * np.pi
        assert abs(impact.duration[0] - (end - tau)) < 1e-8

    def test_a_ball_that_oscillates_beside_its_place_need_not_come_to_rest(self):
        """Its oscillation halves in a period: thirty of them need the force 4200 times."""
        law = hunt_crossley(restitution=0.5, duration=0.1, speed=3.0)
        calls = []

        def force(p, v, stiffness, damping):
            calls.append(np.size(p))
            return law.force(p, v, stiffness, damping)

        counted = ForceLaw(force, law.values, root=2)
        calls.clear()
        assert np.isnan(counted.first_release(np.array([0.3]), np.array([0.01]), 0.2))
        assert len(calls) < 3300


POWERS = [(0.5, 2), (0.75, 4), (1, 1), (1, 2), (1.25, 4), (1.5, 2), (1.5, 4)]
POWERS += [(2, 1), (2, 2), (2.5, 2), (3, 1), (3.5, 2), (4, 1)]
"""Powers with which a force begins, each with its root."""

DAMPED = {"elastic": (0, 0.0), "as the spring": (0, 0.3), "stronger": (0, 1.5), "deep": (1, 0.5)}
DAMPED |= {"shallow": (-0.5, 0.3), "linear": (None, 0.01)}
"""Power of the damping above the power of the spring, None for a damper of the power 0, and its
share of the force at the depth 0.1 and the speed 3.8."""


def power_law(power, root, damped, release):
    """f = K p^a + C p^b p′. A free impact with the speed 3.8 on the spring alone is 0.1 deep."""
    more, share = DAMPED[damped]
    other = 0 if more is None else max(power + (more if root > 1 else np.trunc(2 * more)), 0)
    if root == 4 and more == -0.5:
        other = power - 0.25

    def force(p, v, stiffness, damping):
        return stiffness * p**power + damping * p**other * v

    stiffness = (power + 1) * 3.8**2 / (2 * 0.1 ** (power + 1))
    damping = share * stiffness * 0.1 ** (power - other) / 3.8
    values = {"stiffness": stiffness, "damping": damping}
    return ForceLaw(force, values, root=root, release=release)


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("damped", DAMPED)
@pytest.mark.parametrize(("power", "root"), POWERS)
def test_a_contact_ends_where_its_force_ends(power, root, damped, release):
    law = power_law(power, root, damped, release)
    for tau, u, amplitude, gravity in [(0, 3.8, 0, 0), (0, 0.2, 0, 0), (1, 2.5, 1.1, 1)]:
        impact = law.first_impact(tau, u, amplitude, gravity)[1]
        end, gap, speed, _ = touching(law, amplitude, tau, u, gravity=gravity)
        # The integrator has errors of up to 2e-10.
        np.testing.assert_allclose(impact[:3], [end - tau, gap, speed], rtol=0, atol=1e-9)


class TestByIntegration:
    @pytest.mark.parametrize("name", IMPACTS)
    def test_free_impact(self, name):
        law = IMPACTS[name]
        _, _, w = integrated(law, 0.0, 3.0, 0.0, gravity=0.0)
        impact = law.first_impact(0.0, 3.0, 0.0, gravity=0.0)[1]
        assert abs(impact.speed - w) < 3 * CLOSE
        signature = law.signature(3.0)
        assert abs(signature.restitution - 0.7) < CLOSE
        assert abs(signature.duration - 0.12) < CLOSE

    @pytest.mark.parametrize("name", IMPACTS)
    def test_impact_on_the_table(self, name):
        law = IMPACTS[name]
        duration, depth, w = integrated(law, 1.0, 2.5, 0.9)
        T, impact = law.first_impact(1.0, 2.5, 0.9)
        assert abs(impact.duration - duration) < CLOSE
        assert abs(impact.gap + depth) < CLOSE
        assert abs(impact.speed - w) < 3 * CLOSE
        again = law.contact(1.0, 2.5, T, 0.9)
        np.testing.assert_allclose(again, impact, rtol=0, atol=CLOSE)
        assert law.first_release(1.0, 2.5, 0.9) == T

    def test_force_that_carries_a_share_of_the_load(self):
        def force(p, v, stiffness, share, load):
            return stiffness * p * np.sqrt(p) * (1 + 0.1 * v) + share * load

        law = ForceLaw(force, {"stiffness": 40.0, "share": 0.5}, root=2, needs=("load",))
        duration, _, w = integrated(law, 1.0, 2.5, 0.9)
        impact = law.first_impact(1.0 + 1j * H, 2.5, 0.9)[1]
        np.testing.assert_allclose([impact.duration.real, impact.speed.real], [duration, w], CLOSE)
        sides = [law.first_impact(1.0 + k * 1e-3, 2.5, 0.9)[1].speed for k in (-2, -1, 1, 2)]
        difference = (sides[0] - 8 * sides[1] + 8 * sides[2] - sides[3]) / 12e-3
        assert abs(impact.speed.imag / H - difference) < 1e-10


def test_parameters_may_be_lists():
    def spring(p, v, stiffness):
        return stiffness * p

    signature = ForceLaw(spring, {"stiffness": [400.0, 500.0]}).signature(2.0)
    np.testing.assert_allclose(signature.duration, np.pi / np.sqrt([400.0, 500.0]), 1e-11)


class TestClosedForms:
    @pytest.mark.parametrize("release", ["displacement", "force"])
    def test_linear_is_the_spring_and_damper(self, release):
        law = linear(20.0, 0.13, release=release)
        ball = SpringDamper(20.0, damping_ratio=0.13, release=release)
        steps = 1j * H * np.eye(4)[:, :, np.newaxis]
        tau, u, T, amplitude = np.array([1.0, 4.0]), np.array([3.0, 0.7]), 0.12, 0.9
        impact = law.contact(tau + steps[0], u + steps[1], T + steps[2], amplitude + steps[3])
        exact = ball.contact(
            tau + steps[0], u + steps[1], 20 * (T + steps[2]), amplitude + steps[3]
        )
        for quantity, other in zip(impact[:3], exact[:3], strict=True):
            np.testing.assert_allclose(quantity.real, other.real, rtol=0, atol=1e-13)
            np.testing.assert_allclose(quantity.imag / H, other.imag / H, rtol=0, atol=1e-11)
        for quantity, other in zip(law.signature(3.0), ball.signature(3.0), strict=True):
            assert abs(quantity - other) < CLOSE * max(other, 0.1)

    def test_resumed_contact_of_linear(self):
        law = linear(20.0, 0.13, release="force")
        ball = SpringDamper(20.0, damping_ratio=0.13, release="force")
        u = -0.2 + 1j * H
        impact, exact = law.contact(1.0, u, 0.05, 0.9), ball.contact(1.0, u, 20 * 0.05, 0.9)
        for quantity, other in zip(impact[:3], exact[:3], strict=True):
            assert abs(quantity.real - other.real) < 1e-13
            assert abs(quantity.imag - other.imag) < 1e-11 * H

    def test_damper_on_approach_only(self):
        zeta = 0.3
        root = np.sqrt(1 - zeta * zeta)
        restitution = np.exp(-zeta * np.arccos(zeta) / root)
        signature = linear(20.0, zeta, release="approach").signature(2.0)
        assert abs(signature.restitution - restitution) < CLOSE
        assert abs(signature.duration - (np.arccos(zeta) / root + np.pi / 2) / 20) < CLOSE

    def test_duration_of_hertz(self):
        K, u = 1000.0, 3.0
        depth = (5 * u * u / (4 * K)) ** 0.4
        duration = 2 * depth / u * np.sqrt(np.pi) * gamma(1.4) / gamma(0.9)
        for law in (hunt_crossley(K, 0.0), tsuji(K, 0.0), kuwabara_kono(K, 0.0)):
            impact = law.signature(u)
            assert abs(impact.duration - duration) < CLOSE
            assert abs(impact.restitution - 1) < CLOSE

    def test_tsuji_by_its_linear_equation(self):
        C = 0.7
        omega = np.sqrt(5 - C * C)
        r = tsuji(3000.0, C).signature(np.array([0.01, 1.0, 30.0])).restitution
        np.testing.assert_allclose(r, np.exp(-C * np.pi / omega), rtol=CLOSE)

    @pytest.mark.parametrize(
        ("law", "factor"),
        [
            (flores(2000.0, 0.5), 8 * 0.5 / 2.5),
            (hunt_crossley(2000.0, 0.3), 0.3),
            (hunt_crossley_linear(2000.0, 0.3), 0.3),
        ],
    )
    def test_energy_of_hysteresis_damping(self, law, factor):
        r = law.signature(1.0).restitution
        assert abs(factor * (1 + r) - np.log((1 + factor) / (1 - r * factor))) < CLOSE

    def test_fast_impacts_with_strong_damping_end(self):
        """A ball leaves such a contact with nearly the constant speed 1/C, without a force."""
        u, damping = np.geomspace(10.0, 2000.0, 60), 0.5
        w = hunt_crossley(1e3, damping).first_impact(0.0, u, 0.0, 0.0)[1].speed
        energy = np.log1p(damping * u) - damping * (u + w)
        np.testing.assert_allclose(1 - damping * w, np.exp(energy), rtol=0, atol=CLOSE)

    def test_same_restitution_at_all_speeds(self):
        for law in (flores(2000.0, 0.5), limited_damper(20.0, 0.2), linear(20.0, 0.2)):
            r = law.computed_signature(np.array([1e-3, 1.0, 50.0])).restitution
            np.testing.assert_allclose(r, r[1], rtol=CLOSE)

    @pytest.mark.parametrize(
        ("law", "power"),
        [
            (kuwabara_kono(1000.0, 1e-4), 0.2),
            (hunt_crossley(1000.0, 1e-4), 1.0),
            (adams_impact(1000.0, 1e-3, 10.0), 1.4),
            (stepped_spring(1000.0, 1e-3, 10.0), 2.0),
            (simscape_contact(1000.0, 1e-3, 10.0), 0.5),
        ],
    )
    def test_weak_losses_are_powers_of_the_speed(self, law, power):
        slow, fast = 1 - law.computed_signature(np.array([0.05, 0.1])).restitution
        # The next power of the loss, and the next term of the step, are of the order of 1 %.
        assert abs(np.log2(fast / slow) - power) < 0.01


class TestDerivatives:
    @pytest.mark.parametrize("name", ["tsuji", "kuwabara_kono", "flores", "simscape_contact"])
    def test_complex_steps_are_differences(self, name):
        law = IMPACTS[name]
        T = 0.9 * law.first_release(1.0, 2.5, 0.9)
        values = {"tau": 1.0, "u": 2.5, "T": T, "amplitude": 0.9}
        names = [*values, *law.values]

        def state(**changed):
            ball = law.at(
                **{argument: x for argument, x in changed.items() if argument in law.values}
            )
            arguments = values | {
                argument: x for argument, x in changed.items() if argument in values
            }
            end = ball.contact(**arguments)
            first = ball.first_impact(**{k: x for k, x in arguments.items() if k != "T"})[1]
            return np.array([end.duration, end.gap, end.speed, end.release, *first[:3]])

        for argument in names:
            at = (values | law.values)[argument]
            step = 1e-4 * at
            by_step = state(**{argument: at + 1j * H}).imag / H
            sides = [state(**{argument: at + k * step}) for k in (-2, -1, 1, 2)]
            difference = (sides[0] - 8 * sides[1] + 8 * sides[2] - sides[3]) / (12 * step)
            scale = np.abs(state()) / at
            assert np.all(np.abs(by_step - difference) < 1e-8 * (1 + scale)), argument

    def test_interpolated_signature(self):
        law = kuwabara_kono(1000.0, 0.01)
        u = np.array([0.03, 1.0, 2.7, 40.0]) * (1 + 1j * H)
        for quantity, other in zip(law.signature(u), law.computed_signature(u), strict=True):
            # The differences of σ have rounding errors of 1e-12 of the duration.
            np.testing.assert_allclose(quantity.real, other.real, rtol=CLOSE, atol=1e-12)
            np.testing.assert_allclose(quantity.imag / H, other.imag / H, rtol=1e-9, atol=1e-12)

    def test_signature_of_a_row_of_laws(self):
        law = tsuji(np.array([500.0, 2000.0]), 0.4)
        signature = law.signature(np.array([3.0, 2.0]))
        single = tsuji(2000.0, 0.4).signature(2.0)
        np.testing.assert_allclose([quantity[1] for quantity in signature], single, rtol=1e-10)


def bilinear(p, v, soft, hard, depth, damping):
    stiffness = np.where(np.real(p) < np.real(depth), soft * p, soft * depth + hard * (p - depth))
    return stiffness + damping * v


def at_depth(p, v, soft, hard, depth, damping):
    return p - depth


SOFT_AND_HARD = {"soft": 20.0, "hard": 400.0, "depth": 0.3, "damping": 0.0}


class TestKinks:
    def test_undeclared_kink_is_refused(self):
        with pytest.raises(ValueError, match=r"kink near p = 0\.3, v") as error:
            ForceLaw(bilinear, SOFT_AND_HARD)
        one_line(error)

    def test_elastic_impact_in_closed_form(self):
        law = ForceLaw(bilinear, SOFT_AND_HARD, kinks=(at_depth,))
        u, soft, hard = 3.0, np.sqrt(20.0), np.sqrt(400.0)
        first = np.arcsin(0.3 * soft / u) / soft
        inside = np.sqrt(u * u - 20 * 0.3**2)
        # Beyond the kink p oscillates about a place above it, where hard (p - depth) + 6 = 0.
        second = (np.pi / 2 - np.arctan2(6 / hard, inside)) / hard
        signature = law.computed_signature(u)
        assert abs(signature.duration - 2 * (first + second)) < CLOSE
        assert abs(signature.restitution - 1) < CLOSE
        # An impact that does not reach the kink.
        assert abs(law.computed_signature(1.0).duration - np.pi / soft) < CLOSE

    @pytest.mark.parametrize("u", [1.2, 3.3, 6.0])
    def test_bounce_speed(self, u):
        law = ForceLaw(bilinear, SOFT_AND_HARD | {"damping": 1.0}, kinks=(at_depth,))
        duration, _, w = integrated(law, 1.0, u, 0.9)
        impact = law.first_impact(1.0, u, 0.9)[1]
        assert abs(impact.speed - w) < CLOSE
        assert abs(impact.duration - duration) < CLOSE

    def test_derivatives_pass_through_the_kink(self):
        law = ForceLaw(bilinear, SOFT_AND_HARD | {"damping": 1.0}, kinks=(at_depth,))
        for name, step in (("depth", 1e-4), ("hard", 0.1)):
            at = law.values[name]
            by_step = law.at(**{name: at + 1j * H}).first_impact(1.0, 3.3, 0.9)[1].speed.imag / H
            sides = [
                law.at(**{name: at + k * step}).first_impact(1.0, 3.3, 0.9)[1].speed
                for k in (-2, -1, 1, 2)
            ]
            difference = (sides[0] - 8 * sides[1] + 8 * sides[2] - sides[3]) / (12 * step)
            assert abs(by_step - difference) < 1e-9

    def test_kinks_that_nearly_coincide(self):
        # Here the damper reaches its full depth when it begins to pull.
        law = law_of_impact(
            lambda g, P, v: stepped_spring((v / P) ** 2, g * v / P, 0.1 * P), 0.7, 0.1, 3.8
        )
        duration, _, w = integrated(law, 0.169860250995284, 2.1297017566396343, 1.7)
        impact = law.first_impact(0.169860250995284, 2.1297017566396343, 1.7)[1]
        np.testing.assert_allclose([impact.duration, impact.speed], [duration, w], rtol=CLOSE)

    def test_kink_at_the_release(self, monkeypatch):
        # An impact takes about six panels.
        monkeypatch.setattr(root_time, "MOST_PANELS", 20)
        signature = limited_damper(20.0, 0.0).computed_signature(3.0)
        assert abs(signature.duration - np.pi / 20) < CLOSE


def random_impacts(number, slowest, strongest):
    """Times, speeds and amplitudes of impacts; in slow ones p oscillates near zero."""
    rng = np.random.default_rng(11)
    u = 10 ** rng.uniform(slowest, 1, number)
    return rng.uniform(0, 2 * np.pi, number), u, rng.uniform(0, strongest, number)


def stepped_releases(law, tau, u, amplitude, end, step=5e-4):
    """First releases at δ = 0 of contacts that begin together, by Runge and Kutta's method.

    Also the least |p| of the minima of p between the steps before.
    """

    def rates(t, p, v):
        force = law.force(np.maximum(p, 0.0), v, **law.values)
        return np.array([v, 1 - amplitude * np.sin(tau + t) - force])

    state = np.array([0 * u, u])
    release = np.full(u.shape, np.inf)
    margin = np.full(u.shape, np.inf)
    depths = [0 * u - 1, 0 * u]
    for t in step * np.arange(round(end / step)):
        first = rates(t, *state)
        second = rates(t + step / 2, *(state + step / 2 * first))
        third = rates(t + step / 2, *(state + step / 2 * second))
        fourth = rates(t + step, *(state + step * third))
        state = state + step / 6 * (first + 2 * second + 2 * third + fourth)
        inside = np.isinf(release)
        turns = inside & (depths[1] <= depths[0]) & (depths[1] <= state[0])
        margin[turns] = np.fmin(margin, np.abs(depths[1]))[turns]
        depths = [depths[1], state[0]]
        release[inside & (state[0] < 0)] = t + step
    return release, margin


class TestNoReleaseIsPassed:
    """Releases where p barely falls below zero, for a short time."""

    def test_linear_by_the_closed_form(self):
        impacts = random_impacts(3000, -4, 3)
        exact = SpringDamper(20.0, damping_ratio=0.003).first_release(*impacts)
        T = linear(20.0, 0.003).first_release(*impacts)
        np.testing.assert_allclose(T, exact / 20, rtol=0, atol=CLOSE)

    @pytest.mark.parametrize(
        "law", [hunt_crossley_linear(400.0, 0.01), hunt_crossley(1000.0, 1e-3)], ids=repr
    )
    def test_weak_damping_by_small_steps(self, law):
        impacts = random_impacts(3000, -3, 3)
        duration = law.first_impact(*impacts)[1].duration
        end, margin = stepped_releases(law, *impacts, 8.0)
        # The others end after the last step, or stay.
        duration = np.where(duration < 7.9, duration, np.inf)
        end = np.where(end < 7.9, end, np.inf)
        same = (duration == end) | (np.abs(np.fmin(duration, 9) - np.fmin(end, 9)) < 1e-3)
        # The steps are wrong by 1e-7, and between two of them p may fall by as much.
        clear = margin > 1e-6
        assert clear.sum() > 2950
        assert same[clear].all()


class TestLastingContacts:
    def test_random_contacts_of_linear(self):
        rng = np.random.default_rng(7)
        u = 10 ** rng.uniform(-5, 1, 150)
        tau, amplitude = rng.uniform(0, 2 * np.pi, 150), rng.uniform(0.1, 3, 150)
        ball = SpringDamper(20.0, damping_ratio=0.1)
        exact = ball.first_release(tau, u, amplitude)
        T, impact = linear(20.0, 0.1).first_impact(tau, u, amplitude)
        stays = np.isnan(exact)
        assert 10 < stays.sum() < 140
        assert np.array_equal(np.isnan(T), stays)
        np.testing.assert_allclose(T[~stays], exact[~stays] / 20, rtol=0, atol=CLOSE)
        w = ball.contact(tau, u, exact, amplitude).speed
        np.testing.assert_allclose(impact.speed[~stays], w[~stays], rtol=0, atol=CLOSE)

    def test_damping_by_the_speed_of_a_slow_start(self):
        law = flores(2000.0, 0.5)
        duration, _, w = integrated(law, 1.0, 1e-2, 1.5)
        impact = law.first_impact(1.0, 1e-2, 1.5)[1]
        np.testing.assert_allclose([impact.duration, impact.speed], [duration, w], rtol=1e-9)

    def test_ball_without_a_speed(self):
        law = tsuji(1000.0, 0.3)
        assert np.isnan(law.first_release(0.0, 0.0, 0.5))
        # The table leaves the ball where its acceleration is above that of gravity.
        assert law.first_impact(1.2, 0.0, 1.5)[1].duration < 1e-9

    def test_strong_damping(self):
        assert np.isnan(tsuji(1000.0, 2.3).free(3.0))
        assert np.isnan(linear(20.0, 1.1).signature(3.0).restitution)
        with pytest.raises(ValueError, match="its free impacts do not end") as error:
            Corrected(tsuji(1000.0, 2.3))
        one_line(error)


class TestGivenByAnImpact:
    def test_row_of_laws(self):
        r, v = np.array([0.5, 0.7]), np.array([3.0, 4.0])
        law = kuwabara_kono(restitution=r, duration=0.1, speed=v)
        signature = law.signature(v)
        np.testing.assert_allclose(signature.restitution, r, rtol=CLOSE)
        np.testing.assert_allclose(signature.duration, 0.1, rtol=CLOSE)

    def test_own_law(self):
        def bumper(p, v, stiffness, hardening, damping):
            return stiffness * p * (1 + hardening * p * p) * (1 + damping * v)

        def law_of(g, P, v):
            values = {"stiffness": (v / P) ** 2, "hardening": 1 / P**2, "damping": g / v}
            return ForceLaw(bumper, values)

        signature = law_of_impact(law_of, 0.8, 0.1, 3.5).signature(3.5)
        assert abs(signature.restitution - 0.8) < CLOSE
        assert abs(signature.duration - 0.1) < CLOSE

    def test_no_loss(self):
        assert linear(restitution=1, duration=0.1, speed=3.0).values["damping_ratio"] == 0

    @pytest.mark.parametrize(
        ("make", "reason"),
        [
            (
                # As that of Lankarani and Nikravesh: c = 3(1 - e²)/4 is at most 0.75.
                lambda: law_of_impact(
                    lambda g, P, v: flores(v**2 / P**2.5, 8 / (8 + 5 * np.minimum(g, 0.75))),
                    0.5,
                    0.1,
                    3.0,
                ),
                "this law has no value between 0 and 0.663",
            ),
            (lambda: tsuji(restitution=0.5, duration=0.1), "given: restitution, duration"),
            (lambda: tsuji(1000.0), "stiffness and damping"),
            (lambda: tsuji(-1.0, 0.3), "stiffness = -1"),
            (lambda: linear(20.0, 0.1, release="never"), "release = 'never'"),
        ],
    )
    def test_mistakes(self, make, reason):
        with pytest.raises(ValueError, match=reason) as error:
            make()
        one_line(error)


class TestUnits:
    def test_parameters_follow_the_frequency(self):
        # K = k√g/(mΩ³), and C is a number.
        assert tsuji(1000.0, 0.3).frequency_powers == {"stiffness": -3.0}
        assert linear(20.0, 0.1).frequency_powers == {"frequency_ratio": -1}

    def test_in_si(self):
        mass, g, Omega = 0.02, 9.81, 200.0
        k, lam = 1e7, 0.4
        law = hunt_crossley(k * np.sqrt(g) / (mass * Omega**3), lam * g / Omega)
        si = law.in_si(mass=mass, length=g / Omega**2, time=1 / Omega)
        np.testing.assert_allclose([si["stiffness"], si["damping"]], [k, lam], rtol=1e-14)

    def test_a_law_of_one_s_own_needs_units_where_parameters_change_together(self):
        """With them it is the law of the library that has the same force; without, it is none."""

        def force(p, v, k, c):
            return k * p * np.sqrt(p) * (1 + c * v)

        values = {"k": 1000.0, "c": 0.08}
        units = {"k": (1, -0.5, -2), "c": (0, -1, 1)}
        with_units = ForceLaw(force, values, root=2, units=units)
        named = hunt_crossley(1000.0, 0.08)
        assert with_units.frequency_powers == {"k": -3, "c": -1}
        both = [law_thresholds(law, amplitude=1.0)["max_height"] for law in (named, with_units)]
        assert both[0] == pytest.approx(both[1], rel=1e-12)
        without = ForceLaw(force, values, root=2)
        one = orbit(without, amplitude=1.0)
        corrected = orbit(Corrected(without), amplitude=1.0)
        for question in (
            lambda: law_thresholds(without, amplitude=1.0),
            lambda: error_thresholds(without, amplitude=1.0),
            lambda: path_follow(one, along="frequency", to=1.1),
            lambda: path_follow(corrected, along="frequency", to=1.1),
            lambda: without.in_si(mass=1.0, length=1.0, time=1.0),
        ):
            with pytest.raises(ValueError, match="units: needed here") as error:
                question()
            one_line(error)
        with pytest.raises(ValueError, match="units: kk is not a parameter") as error:
            ForceLaw(force, values, units={"kk": (1, 0, -2)})
        one_line(error)

    def test_r_of_the_speed_does_not_follow_the_frequency(self):
        one = orbit(Rigid(lambda u: 0.7 / (1 + 0.02 * u)), amplitude=1.0)
        with pytest.raises(ValueError, match="a contact law with units") as error:
            path_follow(one, along="frequency", to=1.1)
        one_line(error)


def on_the_way_out(p, v, k, share):
    return np.where(np.real(v) > 0, k * p, share * k * p)


def dropped(p, v, k, drop):
    return np.where(np.real(p) < 0.05, k * p, k * p - drop)


def oblique(p, v, k, rise):
    return np.where(np.real(p - 0.1 * v) < 0.1, k * p, k * p + rise)


class TestJumps:
    """A ball may slide along the surface of a jump, and no derivative passes it without a term."""

    @pytest.mark.parametrize("declared", [True, False])
    @pytest.mark.parametrize(
        ("force", "surface", "size"),
        [
            (on_the_way_out, lambda p, v, k, size: v, 0.4),
            (dropped, lambda p, v, k, size: p - 0.05, 10.0),
            (oblique, lambda p, v, k, size: p - 0.1 * v - 0.1, 10.0),
            (dropped, lambda p, v, k, size: p - 0.05, 1e-3),
        ],
    )
    def test_a_force_with_a_jump_is_refused(self, force, surface, size, declared):
        values = {"k": 400.0, force.__code__.co_varnames[3]: size}
        kinks = (lambda p, v, **values: surface(p, v, *values.values()),) if declared else ()
        with pytest.raises(ValueError, match=r"jumps by .*must be continuous; replace") as error:
            ForceLaw(force, values, kinks=kinks)
        one_line(error)
        if force is not on_the_way_out:
            assert f"jumps by {size:.3g} near" in str(error.value)

    def test_a_jump_of_the_size_of_an_error_is_a_kink(self):
        """It changes the force by half a millionth, and the multipliers by as much."""
        kinks = (lambda p, v, k, drop: p - 0.05,)
        ForceLaw(dropped, {"k": 400.0, "drop": 1e-5}, kinks=kinks)
        with pytest.raises(ValueError, match=r"has a kink near p = 0\.05"):
            ForceLaw(dropped, {"k": 400.0, "drop": 1e-5})

    def test_a_smooth_step_in_its_place_conserves_the_product_of_the_multipliers(self):
        """An elastic ball with a force that drops by 10 within a small range of depth."""

        def force(p, v, k, drop, width):
            return k * p - drop * (1 + np.tanh((p - 0.05) / width)) / 2

        law = ForceLaw(force, {"k": 400.0, "drop": 10.0, "width": 1e-3})
        one = orbit(law, amplitude=0.3)
        # Panels are accepted if the last coefficients of v are below 1e-7.
        assert abs(np.prod(one.multipliers) - 1) < 1e-7

    def test_the_answers_with_smooth_steps_tend_to_that_with_the_jump(self):
        """r to the root of the share of the force, as the work of both springs is equal."""

        def force(p, v, k, share, width):
            return k * p * (share + (1 - share) * (1 + np.tanh(v / width)) / 2)

        widths = np.array([0.02, 0.01])
        law = ForceLaw(force, {"k": 400.0, "share": 0.4, "width": widths})
        wide, narrow = law.signature(3.0).restitution - np.sqrt(0.4)
        # The error is of the second order in the width.
        assert 3.0 < wide / narrow < 5.0

    def test_a_row_is_not_one_law_because_the_force_is_equal_at_most_points(self):
        """The widths of a row of steps are not lost, nor is a stiffness that acts at a depth."""

        def force(p, v, k, width):
            return k * p * (1.4 + 0.6 * np.tanh(v / width)) / 2

        def deep(p, v, k, more):
            return k * p + more * p * np.exp(-((p / 0.15 - 1) ** 2) * 200)

        for law, name in ((force, "width"), (deep, "more")):
            values = {"k": 400.0, name: np.array([0.02, 0.4])}
            row = ForceLaw(law, values).signature(3.0)
            for i in range(2):
                one = ForceLaw(law, values | {name: values[name][i]}).signature(3.0)
                np.testing.assert_allclose([x[i] for x in row], one, rtol=1e-10, atol=1e-11)

    def test_the_signature_of_a_law_with_a_step_is_that_of_its_free_impacts(self):
        """As a function of the speed it has no polynomial of a low degree."""

        def force(p, v, k, more, width):
            return k * p * (1 + more * np.tanh((p - 0.1) / width))

        law = ForceLaw(force, {"k": 400.0, "more": 0.5, "width": 5e-3})
        for u in (1.5, 2.1, 3.0):
            duration, _, _ = integrated(law, 0.0, u, 0.0, gravity=0.0)
            assert abs(law.signature(u).duration - duration) < CLOSE


def hard_core(p, v, k, c, h, d):
    """Spring, damper and a force that tends to infinity at the depth d."""
    return k * p + c * v + h * (p / (d - p)) ** 3


def poeschel(p, v, k, a):
    """Hertz' contact with the damping of Brilliantov and Pöschel."""
    return k * (p * np.sqrt(p) + a * v * np.sqrt(p))


def smooth_sphere(p, v, k, c):
    """Hunt and Crossley's contact with steps by tanh. It underflows where the ball flies off."""
    hertz = k * (p * p + 1e-5) ** 0.75 * (1 + np.tanh(300 * p)) / 2
    return hertz * (1 + 1.5 * c * v) * (1 + np.tanh(50 * (v + 2 / (3 * c)))) / 2


class Deepest:
    """A force that unloads by the largest depth so far, as plastic contacts do."""

    depth = 0.0

    def __call__(self, p, v, k):
        self.depth = max(self.depth, np.max(p.real))
        return np.where(v.real > 0, k * p, k * p * p / self.depth)


def test_a_range_is_right_although_a_faster_ball_is_not():
    """Below the depth d the damping opposes the rate; by another integrator r(12) = 0.893500149."""
    values = {"k": 80.0, "c": 1.0, "d": 1.5}
    law = ForceLaw(lambda p, v, k, c, d: k * p + c * v * (1 - p / d), values)
    assert float(law.signature(12.0).restitution) == pytest.approx(0.893500149, abs=1e-9)
    with pytest.raises(ValueError, match="adds energy"):
        law.signature(40.0)


TABLE = np.polynomial.Polynomial([0.0, 150.0, 900.0, -400.0, 3000.0])

# Laws as they are written in particle codes, engines and notebooks, with their arguments.
WRITTEN = {
    "hard core": (hard_core, {"k": 20.0, "c": 0.5, "h": 5.0, "d": 0.3}, {}),
    "even pole": (
        lambda p, v, k, h, d: k * p + h * (p / (d - p)) ** 2,
        {"k": 20.0, "h": 2.0, "d": 0.3},
        {},
    ),
    "extensible chain": (
        lambda p, v, k, d: k * p / (1 - (p / d) ** 2),
        {"k": 400.0, "d": 0.2},
        {},
    ),
    "wall of Lennard and Jones": (
        lambda p, v, e, d: e * ((1 - p / d) ** -13 - 1),
        {"e": 1.0, "d": 0.3},
        {},
    ),
    "steep exponential": (lambda p, v, k: k * (np.exp(200 * p) - 1), {"k": 2.0}, {}),
    "exponential": (lambda p, v, k: k * np.exp(8 * p), {"k": 3.0}, {}),
    "exponential spring of Simbody": (
        lambda p, v, k, b, c: k * np.exp(b * p) * (1 + c * v),
        {"k": 0.5, "b": 100.0, "c": 0.1},
        {},
    ),
    "logarithmic force": (
        lambda p, v, k, d: -k * np.log(1 - p / d),
        {"k": 300.0, "d": 0.2},
        {},
    ),
    "logarithmic barrier": (
        lambda p, v, k, d: k * (-2 * p * np.log(1 - p / d) + p * p / (d - p)),
        {"k": 100.0, "d": 0.2},
        {},
    ),
    "no tension": (
        lambda p, v, k, c: k * p + c * v,
        {"k": 400.0, "c": 4.0},
        {"release": "force"},
    ),
    "no tension of Hertz' contact": (
        poeschel,
        {"k": 1000.0, "a": 0.01},
        {"root": 2, "release": "force", "lag": lambda k, a: a},
    ),
    "damping of the penetration": (lambda p, v, k, c: (k + c * v) * p, {"k": 1e3, "c": 100.0}, {}),
    "damping of its square": (
        lambda p, v, k, c: k * p + c * p**2 * v,
        {"k": 400.0, "c": 500.0},
        {},
    ),
    "quadratic damping": (
        lambda p, v, k, c: k * p + c * p * np.where(v.real > 0, v * v, -v * v),
        {"k": 400.0, "c": 20.0},
        {"kinks": (lambda p, v, k, c: v,)},
    ),
    "measured, as a polynomial": (lambda p, v: TABLE(p) + 0 * v, {}, {}),
    "saturating": (
        lambda p, v, k: k * np.tanh(30 * p) * (1 + 0.05 * v),
        {"k": 100.0},
        {},
    ),
    "sine": (lambda p, v, k: k * np.sin(p), {"k": 100.0}, {}),
    "adhesion": (lambda p, v, k, a: k * p - a * np.sqrt(p), {"k": 400.0, "a": 1.0}, {"root": 2}),
    "fifth power": (lambda p, v, k: k * p**5, {"k": 1e4}, {}),
    "smooth sphere of OpenSim": (smooth_sphere, {"k": 1e4, "c": 0.1}, {}),
    "any power": (lambda p, v, k: k * p**1.31, {"k": 400.0}, {"root": 6}),
    "a drop": (
        lambda p, v, k, d, c: k * p / np.log(d / (p + 1e-300)) * (1 + c * v),
        {"k": 400.0, "d": 30.0, "c": 0.05},
        {"root": 6},
    ),
}

NO_TENSION = 'write the force without this limit and give release="force"'
REFUSED = {
    "no tension by maximum": (
        lambda p, v, k, c: np.maximum(0, k * p + c * v),
        {"k": 400.0, "c": 4.0},
        {},
        NO_TENSION,
    ),
    "no tension by where": (
        lambda p, v, k, a: np.where(poeschel(p, v, k, a).real > 0, poeschel(p, v, k, a), 0),
        {"k": 1000.0, "a": 0.01},
        {"root": 2},
        NO_TENSION,
    ),
    "limited damper": (
        lambda p, v, k, c: k * p + np.clip(c * v, -1, 1),
        {"k": 400.0, "c": 4.0},
        {},
        r"kink near p = .*, v = .*; give kinks=\(kink,\)",
    ),
    "dry friction": (
        lambda p, v, k, m: k * p + m * np.sign(v.real),
        {"k": 400.0, "m": 2.0},
        {},
        "jumps by 4 near p = .*, v = 0, but must be continuous",
    ),
    "table": (
        lambda p, v: np.interp(p, [0, 0.1, 0.2], [0, 30, 100]),
        {},
        {},
        "a polynomial instead of a table",
    ),
    "a third of a power": (lambda p, v, k: k * p ** (4 / 3), {"k": 300.0}, {}, "give root=6"),
    "sign of the damping": (
        lambda p, v, k: k * p - 5 * v,
        {"k": 400.0},
        {},
        "adds energy: a ball with the closing speed .* leaves with .*: check the sign",
    ),
    "damping of van der Pol": (
        lambda p, v, k, c: k * p + c * v * (1 - v * v / 9),
        {"k": 400.0, "c": 4.0},
        {},
        "a ball with the closing speed 4.24 leaves with 5.681: check the sign of the damping",
    ),
    "start speeds at which it drives": (
        lambda p, v, k, c, start_speed: k * p + c * (2 - start_speed) * v,
        {"k": 400.0, "c": 2.0},
        {"needs": ("start_speed",)},
        "adds energy: a ball with the closing speed 2.12",
    ),
    "memory": (
        Deepest(),
        {"k": 400.0},
        {},
        "has another value when it is asked again, but must not remember",
    ),
    "attraction": (
        lambda p, v, k, c, a, g: k * p + c * v - a / (g + p) ** 2,
        {"k": 400.0, "c": 3.0, "a": 0.02, "g": 0.15},
        {"release": "force"},
        r"pulls with .* at p = .* and v = 0, but .* or give release='displacement'",
    ),
    "constant attraction": (
        lambda p, v, k, c: k * p + c * v - 1,
        {"k": 400.0, "c": 4.0},
        {"release": "force"},
        "pulls with 1 at p = 0 and v = 0",
    ),
    "squeezed film": (
        lambda p, v, k, c, g: k * p + c * v / (1 - p / g) ** 3,
        {"k": 400.0, "c": 4.0, "g": 0.1},
        {},
        r"tends to infinity or changes too fast near p = 0\.1, v = .* give the damping no pole",
    ),
    "any power": (
        lambda p, v, k: k * p**1.31,
        {"k": 400.0},
        {},
        "polynomials in p do not converge to it at p = 0; give root=6",
    ),
    "list": (lambda p, v, k: [k * x for x in p], {"k": 1.0}, {}, r"shape of p and v, \(4,\), not"),
    "first entry": (lambda p, v, k: k * p[0], {"k": 1.0}, {}, r"shape of p and v, \(4,\), not"),
    "pole that nothing feels": (
        lambda p, v, k, h, d: k * p + h * (p / (d - p)) ** 2,
        {"k": 20.0, "h": 1e-3, "d": 0.3},
        {},
        r"tends to infinity or changes too fast near p = 0\.3, v = .*: make a narrow pole",
    ),
    "one kink": (lambda p, v, k: k * p, {"k": 1.0}, {"kinks": np.sign}, r"kinks=\(kink,\), not"),
    "a maximum besides the release": (
        lambda p, v, k, c: np.maximum(0, k * p + c * v),
        {"k": 400.0, "c": 4.0},
        {"release": "force", "kinks": (lambda p, v, k, c: k * p + c * v,)},
        "is zero on a part of the contact",
    ),
    "jump of the load": (
        lambda p, v, k, load: k * p * np.where(load.real > 0.5, 1.0, 0.8),
        {"k": 400.0},
        {"needs": ("load",)},
        r"jumps by .* near p = .*, v = .*, load = 0\.5",
    ),
    "text": (lambda p, v, k, load: k * p, {"k": 1.0}, {"needs": "load"}, "needs = 'load': must be"),
    "no values": (lambda p, v, k: k * p, [400.0], {}, r"values = \[400.0\]: must be a dict"),
    "no number": (lambda p, v, k: k * p, {"k": np.nan}, {}, "k = nan: must be in"),
    "no lag": (lambda p, v, k: k * p, {"k": 1.0}, {"lag": 0.1}, "lag = 0.1: must be a function"),
    "lag of another release": (
        lambda p, v, k: k * p + v,
        {"k": 9.0},
        {"lag": lambda k: 1 / k},
        "must be a function, with release='force'",
    ),
    "wrong lag": (
        lambda p, v, k: k * p + v,
        {"k": 9.0},
        {"lag": lambda k: 2 / k, "release": "force"},
        "lag: must return κ of the line p",
    ),
    "wrong kink": (
        lambda p, v, k: k * p,
        {"k": 1.0},
        {"kinks": (lambda p, v: p,)},
        r"kinks\[0\]: must accept its parameters by name",
    ),
}


@pytest.mark.filterwarnings("error")
class TestLawsAsTheyAreWritten:
    @pytest.mark.parametrize("name", WRITTEN)
    @pytest.mark.parametrize("u", [0.4, 2.5, 6.0])
    def test_accepted(self, name, u):
        """The ball leaves when and as fast as by an integrator in plain time."""
        force, values, more = WRITTEN[name]
        law = ForceLaw(force, values, **more)
        impact = law.first_impact(1.0, u, 0.9)[1]
        duration, _, w = integrated(law, 1.0, u, 0.9)
        # Next to a wall the force changes by a factor in the rounding errors of the depth.
        assert abs(impact.duration - duration) < CLOSE
        assert abs(impact.speed - w) < 100 * CLOSE

    @pytest.mark.parametrize("name", REFUSED)
    def test_refused(self, name):
        force, values, more, reason = REFUSED[name]
        with pytest.raises(ValueError, match=reason) as error:
            ForceLaw(force, values, **more)
        one_line(error)

    def test_a_ball_that_is_not_stopped_is_refused_at_once(self):
        law = ForceLaw(lambda p, v, k: k * np.sin(p), {"k": 100.0})
        assert abs(law.signature(19.0).restitution - 1) < CLOSE
        for question in (
            lambda: law.signature(100.0),
            lambda: motion_of(law, amplitude=1.0, velocity=-100.0),
        ):
            with pytest.raises(ValueError, match="stops balls with closing speeds up to 20 "):
                question()
        assert np.isnan(law.first_release(0.0, 100.0, 1.0))

    def test_a_soft_chain_is_a_law_for_balls_that_keep_their_distance(self):
        """Its energy grows with the logarithm of the distance from its full length."""
        law = ForceLaw(WRITTEN["extensible chain"][0], {"k": 9.0, "d": 0.2})
        duration, _, w = integrated(law, 1.0, 1.0, 0.9)
        np.testing.assert_allclose(law.first_impact(1.0, 1.0, 0.9)[1][::2], [duration, w], 1e-10)
        with pytest.raises(
            ValueError, match=r"up to 2\.64 \(followed to the depth 0\.2\), but this ball has 4"
        ):
            law.signature(4.0)

    def test_a_force_is_checked_where_faster_balls_come(self):
        """A spring with a kink at a depth that no ball reaches at first."""
        law = ForceLaw(
            lambda p, v, k: np.where(p.real < 9, k * p, 9 * k + 2 * k * (p - 9)), {"k": 4.0}
        )
        assert abs(law.first_impact(0.0, 2.0, 0.0, 0.0)[1].speed - 2) < CLOSE
        with pytest.raises(ValueError, match="has a kink near p = 9, v"):
            law.first_impact(0.0, 19.0, 0.0)
        with pytest.raises(ValueError, match="has a kink near p = 9, v"):
            law.first_impact(0.0, 19.0, 0.0)

    def test_a_law_that_stops_slow_balls_only_is_a_law_for_them(self):
        law = ForceLaw(lambda p, v, k, d: k * p * np.exp(-p / d), {"k": 40.0, "d": 0.2})
        duration, _, w = integrated(law, 1.0, 0.4, 0.1)
        np.testing.assert_allclose(law.first_impact(1.0, 0.4, 0.1)[1][::2], [duration, w], 1e-10)
        with pytest.raises(ValueError, match=r"up to 1\.79 .*, but this ball has 2"):
            law.signature(2.0)

    @pytest.mark.parametrize("width", [1e-3, 1e-5])
    def test_steep_steps_are_accepted_and_right(self, width):
        """r is the root of the ratio of the stiffnesses, but for the range of the step."""
        law = ForceLaw(
            lambda p, v, k, m, w: k * p * (1 + m * np.tanh(v / w)),
            {"k": 400.0, "m": 0.3, "w": width},
        )
        r = law.first_impact(0.0, 3.0, 0.0, 0.0)[1].speed / 3
        assert abs(r - np.sqrt(0.7 / 1.3)) < 0.04 * width
        with pytest.raises(ValueError, match=r"a smooth step must be wider than .* in v"):
            ForceLaw(law.force, {**law.values, "w": 1e-7})

    def test_signatures_are_of_approaching_balls(self):
        law = ForceLaw(lambda p, v, k: k * p, {"k": 400.0})
        r = law.signature(np.array([-1.0, 0.0, 2.0])).restitution
        np.testing.assert_allclose(r, [np.nan, np.nan, 1.0], rtol=CLOSE)

    def test_depth_is_that_of_the_energy(self):
        law = ForceLaw(WRITTEN["steep exponential"][0], {"k": np.array([2.0, 7.0])})
        u = np.array([[0.3], [4.0]])
        depth = law.depth(u)
        assert depth.shape == (2, 2)
        energy = law.values["k"] * (np.expm1(200 * depth) / 200 - depth)
        # Steps are a tenth of the depth, or half of f/f′.
        np.testing.assert_allclose(np.sqrt(2 * energy), np.broadcast_to(u, (2, 2)), rtol=0.2)
        assert np.isnan(ForceLaw(WRITTEN["sine"][0], {"k": 100.0}).depth(21.0))


SPLINE = CubicSpline(np.linspace(0, 3, 20), np.linspace(0, 3, 20) ** 2)


class TestRefusedForces:
    @pytest.mark.parametrize(
        ("force", "reason"),
        [
            (lambda p, v, k: k * p * (1 + 0.1 * np.abs(v)), "not analytic in v"),
            (lambda p, v, k: k * np.real(p) + 0 * v, "not analytic in p"),
            (lambda p, v, k: k * p + 3 * np.maximum(v, 0), r"kink near p = .*, v = 0; give kinks"),
            (
                lambda p, v, k: np.maximum(0, k * p + 9 * v),
                'write the force without this limit and give release="force"',
            ),
            (lambda p, v, k: k * p**1.5, "give root=2"),
            (lambda p, v, k: k * p**1.5 + p**0.25 * v, "give root=4"),
            (lambda p, v, k: k * float(p), "arrays of complex numbers: write np.where"),
            (lambda p, v, k: k * SPLINE(p) + v, "a polynomial instead of a table or a spline"),
            (lambda p, v, k: k * p + np.where(v.real > -3, v, np.nan), "the force is NaN during"),
            (lambda p, v, k: 3.0, "shape of p and v"),
            (lambda p, v, k: -k * p, "stops no ball"),
            (lambda p, v, k: k * p if p > 0 else 0 * p, r"np\.where\(...\) instead of 'if'"),
        ],
    )
    def test_reason(self, force, reason):
        with pytest.raises(ValueError, match=reason) as error:
            ForceLaw(force, {"k": 1000.0})
        one_line(error)

    def test_analytic_forces_are_accepted(self):
        ForceLaw(lambda p, v, k: k * np.expm1(5 * p) * (1 + 0.3 * np.tanh(v)), {"k": 100.0})
        ForceLaw(lambda p, v, k: k * p ** (4 / 3), {"k": 100.0}, root=6)

    def test_other_arguments(self):
        for more in ({"root": 3}, {"release": "never"}):
            with pytest.raises(ValueError, match=next(iter(more))) as error:
                ForceLaw(lambda p, v, k: k * p, {"k": 1.0}, **more)
            one_line(error)
        with pytest.raises(ValueError, match="tau: is a reserved name"):
            ForceLaw(lambda p, v, tau: tau * p, {"tau": 1.0})
        with pytest.raises(ValueError, match=r"units: k = \(1, 0\): must be the powers of mass"):
            ForceLaw(lambda p, v, k: k * p, {"k": 1.0}, units={"k": (1, 0)})
        with pytest.raises(ValueError, match=r"k has \(2,\), c has \(3,\)"):
            ForceLaw(lambda p, v, k, c: k * p + c * v, {"k": [1.0, 2.0], "c": [1.0, 2.0, 3.0]})

    def test_a_row_is_checked_where_its_parameters_are_extreme(self):
        with pytest.raises(ValueError, match="give root=6"):
            ForceLaw(lambda p, v, m: 1000 * p**m, {"m": np.array([1.5, 1.2])}, root=2)
        ForceLaw(lambda p, v: 1000 * p, {})
        with pytest.raises(ValueError, match="depth: no parameter"):
            tsuji(1000.0, 0.3).at(depth=1.0)


@pytest.mark.parametrize("release", ["displacement", "approach"])
def test_few_contacts_are_as_many(release):
    """Newton's and Picard's sweeps find the same motion of nearly linear contacts."""
    law = linear(20.0, 0.13, release=release)
    tau = np.linspace(0, 6, root_time.FEW_CONTACTS + 10)
    u = np.linspace(0.5, 3, tau.size)
    many = law.first_impact(tau, u, 1.5)
    few = law.first_impact(tau[:3], u[:3], 1.5)
    np.testing.assert_allclose(few[0], many[0][:3], rtol=CLOSE)
    np.testing.assert_allclose(few[1].speed, many[1].speed[:3], rtol=CLOSE)


@pytest.mark.parametrize("law", [tsuji, hunt_crossley, kuwabara_kono])
def test_contacts_in_one_panel_are_those_in_many(law: Callable) -> None:
    """States and derivatives of contacts that are guessed from free impacts, without the guess."""
    ball = law(restitution=0.6, duration=0.2, speed=3.0)
    u = np.array([1.0, 2.0, 3.0, 7.0])
    tau = np.array([0.3, 2.0, 4.0, 6.0])
    T = ball.first_release(tau, u, 1.2)
    steps = 1j * H * np.eye(4)[..., np.newaxis]
    given = tau + steps[0], u + steps[1], 1.2 + steps[2], 1.0, T * (1 + 0.01 * steps[3])
    impacts = (ball._followed(*given, guessed=guess)[1] for guess in (True, False))
    # The gap is zero but for rounding, as the fourth power of the release function.
    guessed, alone = (np.array([x.duration, x.speed, x.release]) for x in impacts)
    assert not np.array_equal(guessed, alone)
    np.testing.assert_allclose(guessed.real, alone.real, rtol=1e-12, atol=1e-13)
    size = np.abs(alone.imag).max(axis=(1, 2), keepdims=True)
    assert np.all(np.abs(guessed.imag - alone.imag) <= 1e-11 * size)


def test_derivatives_in_one_panel_are_those_of_differences() -> None:
    """Derivatives by the time, the speed, Λ and a parameter beside central differences."""
    ball = tsuji(restitution=0.6, duration=0.2, speed=3.0)
    stiffness = ball.values["stiffness"]
    x = np.array([2.0, 3.0, 1.2, stiffness])
    T = ball.first_release(x[0], x[1], x[2])

    def end(x: np.ndarray) -> np.ndarray:
        return np.array(ball.at(stiffness=x[3]).contact(x[0], x[1], T, x[2])[:3])

    for i, step in enumerate(1e-4 * x):
        nudge = np.eye(4)[i]
        along = end(x + 1j * H * nudge).imag / H
        slopes = [(end(x + h * nudge) - end(x - h * nudge)) / (2 * h) for h in (step, step / 2)]
        np.testing.assert_allclose(along, (4 * slopes[1] - slopes[0]) / 3, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize(
    ("law", "scale"),
    [
        (adams_impact, lambda stiffness, v: (v**2 / stiffness) ** 0.4),
        (simscape_contact, lambda stiffness, v: v / stiffness**0.5),
    ],
)
def test_a_law_of_an_impact_has_its_full_damping_at_a_tenth_of_the_depth(law, scale):
    """The depth that the page on laws names, for one who copies it into a multibody program."""
    parameters = law(restitution=0.7, duration=0.2, speed=3.5).parameters
    assert parameters["depth"] == pytest.approx(
        0.1 * scale(parameters["stiffness"], 3.5), rel=1e-12
    )


@pytest.mark.parametrize(
    ("ball", "tau", "u", "T", "amplitude"),
    [
        (kuwabara_kono(stiffness=3000.0, damping=0.3), -3.1026, 0.4024, 28.0, 1.1496),
        (hunt_crossley_linear(30.0, 0.5), 2.0, 0.5, 4.0, 0.9),
        (limited_damper(8.0, 0.4), 2.0, 0.5, 3.0, 0.9),
    ],
)
def test_slopes_in_long_contacts_are_those_of_contacts_of_each_length(ball, tau, u, T, amplitude):
    """The first column is a contact of one panel, the second one of many."""
    tau, u, T = np.array([1.0, tau]), np.array([3.0, u]), np.array([0.1, T])
    places = np.linspace(0.0, 1.0, 9)
    slopes = ball.release_slopes(tau, u, T, places, amplitude)
    lengths = np.multiply.outer(places, T) + 1j * H
    exact = ball.contact(tau, u, lengths, amplitude).release.imag.T / H
    np.testing.assert_allclose(slopes, exact, rtol=0, atol=1e-7 * np.abs(exact).max())
