"""The threshold of permanent contact, against Eq. 33 and against contacts that are integrated."""

import numpy as np
import pytest
from integrated import waveform
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import bouncing_ball_beyond as bb
from bouncing_ball.spring_damper import permanent_contact as closed_form
from bouncing_ball_beyond import permanent_contact

# On three tones the weakest grip of Tsuji's law comes at another phase from some Λ on.
WAVES = {
    "sine": ((1, 1.0, 0.0),),
    "two tones": ((1, 1.0, 0.0), (3, 0.05, -1.1)),
    "three tones": ((1, 0.9, 0.2), (2, 0.2, 1.9), (5, 0.01, -0.4)),
}
TABLES = {name: bb.Table(list(harmonics)) for name, harmonics in WAVES.items()}


def own_force(p, v, stiffness, damping):
    return stiffness * p * (1 + 3 * p) + damping * v * (1 + p)


def soft_surface(p, v, stiffness, damping):
    return stiffness * p**2 * np.sqrt(p) + damping * p * v


LAWS = {
    "hunt-crossley": bb.hunt_crossley(stiffness=60.0, damping=0.2),
    "tsuji": bb.tsuji(restitution=0.65, duration=0.5, speed=3.8),
    "own": bb.ForceLaw(own_force, {"stiffness": 30.0, "damping": 2.0}),
    "own without pull": bb.ForceLaw(
        own_force, {"stiffness": 30.0, "damping": 2.0}, release="force"
    ),
    "soft surface": bb.ForceLaw(
        soft_surface, {"stiffness": 2200.0, "damping": 95.0}, root=2, release="force"
    ),
}


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("ratio", [0.2, 1.0, 2.0, 10.0, 1000.0])
def test_a_spring_and_a_damper_have_the_threshold_of_the_closed_form(ratio, release):
    ball = bb.SpringDamper(ratio, damping_ratio=0.1359, release=release)
    expected = closed_form(ratio, 0.1359, release)
    # The relative error that the docstring promises.
    assert permanent_contact(ball) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("table", TABLES.values(), ids=TABLES)
def test_a_rigid_ball_stays_until_the_table_falls_faster(table):
    assert permanent_contact(bb.Rigid(0.5), table=table) == 1 / table.lift


def motion(law, amplitude, harmonics):
    """p′ and p″ of a ball in contact, as a function of τ and (p, p′)."""

    def rates(t, y):
        load = 1 + amplitude * waveform(harmonics, t, 2)
        return [y[1], load - law.force(max(y[0], 0.0), y[1], **law.values)]

    return rates


def follow(law, amplitude, harmonics, start, phase=0.0):
    """A period in contact from (p, p′) at a phase of the table."""
    span = phase, phase + 2 * np.pi
    tight = {"rtol": 1e-11, "atol": 1e-13, "dense_output": True}
    return solve_ivp(motion(law, amplitude, harmonics), span, start, "DOP853", **tight)


def weakest(law, solution):
    """Time, p and p′ of the weakest grip."""
    times = np.linspace(0, 2 * np.pi, 20001)
    p, v = solution.sol(times)
    grip = p if law.release == "displacement" else law.force(p, v, **law.values)
    at = grip.argmin()
    return times[at], p[at], v[at]


@pytest.mark.parametrize("wave", WAVES)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_an_integrated_contact_loses_its_grip_at_the_threshold(law, wave):
    """The motion is followed from rest, and then until its grip only just vanishes."""
    threshold = permanent_contact(law, table=TABLES[wave])
    harmonics = WAVES[wave]
    start = [fsolve(lambda p: law.force(p, 0.0, **law.values) - 1, 0.05)[0], 0.0]
    for share in (0.3, 0.6, 0.8, 0.9, 0.99):
        amplitude = share * threshold

        def after(y, amplitude=amplitude):
            return follow(law, amplitude, harmonics, y).y[:, -1] - y

        start = fsolve(after, start, xtol=1e-8, epsfcn=1e-10)
    phase, p, v = weakest(law, follow(law, amplitude, harmonics, start))
    assert p > 0

    def touching(unknown):
        p, v, phase, amplitude = unknown
        end = follow(law, amplitude, harmonics, [p, v], phase).y[:, -1]
        if law.release == "displacement":
            return [*(end - [p, v]), p, v]
        # The rate of the force, by a central difference along the motion.
        step = 1e-5
        slope = np.array(motion(law, amplitude, harmonics)(phase, [p, v]))
        beside = [law.force(*([p, v] + h * slope), **law.values) for h in (-step, step)]
        return [*(end - [p, v]), sum(beside) / 2, (beside[1] - beside[0]) / (2 * step)]

    *_, own = fsolve(touching, [p, v, phase, amplitude], xtol=1e-11)
    assert threshold == pytest.approx(own, rel=1e-7)


def test_a_contact_that_has_no_threshold_is_refused():
    """Λ of the soft law rises to 0.3283, and its grip vanishes at 0.3279 on the way back."""
    steep = bb.ForceLaw(lambda p, v: 60 * p**0.75 + v, {}, root=4)
    two = bb.ForceLaw(own_force, {"stiffness": [30.0, 40.0], "damping": 2.0})
    soft = bb.hunt_crossley(20.0, 0.2)
    for words, law in [("one ball", two), ("motion in contact ends", soft), ("below 1", steep)]:
        with pytest.raises(ValueError, match=words):
            permanent_contact(law, table=TABLES["two tones"])


def test_a_contact_that_has_no_start_is_refused():
    def flores(p, v, stiffness, start_speed):
        return stiffness * p * (1 + 0.5 * v / start_speed)

    law = bb.ForceLaw(flores, {"stiffness": 400.0}, needs=("start_speed",))
    with pytest.raises(ValueError, match="no start"):
        permanent_contact(law)
