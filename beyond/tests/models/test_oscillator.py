"""The oscillator's responses against their formulas in 130 digits.

The reference adds 1e-45 to a and to q, so that the quotient for h is never 0/0, which leaves
more than 30 correct digits.
"""

import mpmath
import numpy as np
import pytest

from bouncing_ball_beyond.models.oscillator import responses

EPS = np.finfo(float).eps
NUDGE = mpmath.mpf(10) ** -45


def free(s, a, q):
    root = mpmath.sqrt(mpmath.mpc(q - a * a))
    decay = mpmath.exp(-a * s)
    c = mpmath.re(mpmath.cos(root * s))
    sn = mpmath.re(s * mpmath.sinc(root * s))
    return decay * sn, decay * (c - a * sn)


def forced(nu):
    def response(s, a, q, nu=nu):
        g, rate = free(s, a, q)
        h = (mpmath.exp(nu * s) - rate - (nu + 2 * a) * g) / (nu * nu + 2 * a * nu + q)
        return h, nu * h + g

    return response


def exact(function, s, omega, zeta):
    """The fields of a Response, in order, in 130 digits."""
    with mpmath.workdps(130):
        s, omega, zeta = (mpmath.mpf(x) for x in (s, omega, zeta))
        a = zeta * omega + NUDGE
        q = omega * omega + NUDGE / 3
        return np.array([complex(x) for x in function(s, a, q)])


def sizes(name, s, omega, g):
    """Natural sizes of the fields, to which the rounding of the phase is relative.

    ``m`` is the shorter of the time and 1/ϖ, for the impulse times the remaining amplitude of the
    free oscillation.
    """
    if name == "impulse":
        return np.hypot(abs(g[1]), omega * abs(g[0])) * np.array([min(s, 1 / omega), 1])
    m = min(s, 1 / omega) if name == "gravity" else min(s, 1 / max(omega, 1))
    return np.array([m * m, m])


def random_contacts():
    """s, ϖ, ζ: every kind of damping, and the resonance within 1e-9."""
    rng = np.random.default_rng(20110828)
    count = 300
    kinds = [
        np.zeros(count),
        np.ones(count),
        1 + rng.uniform(-1e-9, 1e-9, count),
        rng.uniform(1, 5, count),
        10 ** rng.uniform(-6, 0, count),
        rng.uniform(0, 1, count),
    ]
    zeta = np.choose(rng.integers(0, 6, count), kinds)
    omega = 10 ** rng.uniform(-2, 4, count)
    s = 10 ** rng.uniform(-6, 1, count)
    resonant = np.arange(count) < 60
    near = np.choose(rng.integers(0, 4, count), [1.0, 1 + 1e-9, 1 - 1e-9, 1 + 3e-10])
    omega = np.where(resonant, near, omega)
    zeta = np.where(resonant, np.choose(rng.integers(0, 3, count), [0.0, 1e-9, 1e-5]), zeta)
    s = np.where(resonant, 10 ** rng.uniform(-3, 1, count), s)
    return s, omega, zeta


@pytest.mark.parametrize(
    ("name", "function"),
    [
        ("impulse", free),
        ("gravity", forced(mpmath.mpf(0))),
        ("table", forced(mpmath.mpc(0, 1))),
    ],
)
def test_every_response_agrees_with_130_digits(name, function):
    s, omega, zeta = random_contacts()
    computed = np.atleast_2d(getattr(responses(s, omega, zeta), name))
    for k in range(len(s)):
        expected = exact(function, s[k], omega[k], zeta[k])
        g = expected if name == "impulse" else exact(free, s[k], omega[k], zeta[k])
        size = np.abs(expected) + sizes(name, s[k], omega[k], g) + 1e-290  # underflow
        # The rounding of ϖ s shifts the phase: (1 + ϖ s) eps. The formulas add
        # a few roundings of their own; 20000 random contacts needed 4.5.
        error = np.abs(computed[:, k] - expected) / size
        assert np.all(error <= 8 * EPS * (1 + omega[k] * s[k])), (s[k], omega[k], zeta[k])


@pytest.mark.parametrize("zeta", [10.1, 101.3, 701.9588247134583])
def test_strong_damping_keeps_the_digits_of_the_slow_decay(zeta):
    # The slow exponent q/(κ + a) is well conditioned: it needs no digits of ζ².
    s, omega = 2.91, 190.32903466920538
    expected = exact(free, s, omega, zeta)[0].real
    computed = float(responses(s, omega, zeta).impulse.value)
    assert abs(computed / expected - 1) <= 8 * EPS * (1 + omega * s)


def test_at_the_start_only_the_impulse_has_a_rate():
    for omega, zeta in ((0.5, 0.0), (3.0, 0.2), (3.0, 1.0), (3.0, 2.0)):
        g, gravity, table = responses(0.0, omega, zeta)
        assert (float(g.value), float(g.rate)) == (0.0, 1.0)
        assert not np.any([*gravity, *table])
