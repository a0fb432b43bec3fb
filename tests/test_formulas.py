"""The formulas of the paper as printed, restored from its damaged text, against the package.

Each row is one equation, for random parameters. The text was restored by the physics of the model:
where a sign or a term is illegible, the equation is the one that follows from those before it.
"""

import numpy as np
import pytest
from tests import independent

from bouncing_ball import errors, restitution, spring_damper
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact

GRAVITY = 9.81


class Parameters:
    """Random parameters in the ranges of the paper, and an orbit of each model."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.n = n = int(rng.integers(1, 4))
        self.r = r = rng.uniform(0.3, 0.95)
        self.zeta = zeta = -np.log(r) / np.sqrt(np.pi**2 + np.log(r) ** 2)
        self.ratio = ratio = rng.uniform(1.5, 30)
        self.gamma = (ratio**2 - 1) ** 2 + (2 * zeta * ratio) ** 2
        # Table, gravity, mass, damping and stiffness in physical units.
        self.frequency = frequency = rng.uniform(5, 100)
        self.length = GRAVITY / frequency**2
        self.mass = mass = rng.uniform(0.1, 5)
        self.stiffness = mass * (ratio * frequency) ** 2
        self.damping = 2 * zeta * np.sqrt(self.stiffness * mass)
        # An orbit of the restitution model.
        self.table_speed = n * np.pi * (1 - r) / (1 + r)
        self.amplitude = self.table_speed * rng.uniform(1.05, 1.5) + 0.1
        self.phase = np.arccos(self.table_speed / self.amplitude)
        # One of the spring-damper model, its contact and the times of samples.
        duration = rng.uniform(0.99, 1.0) * np.pi / ratio / np.sqrt(1 - zeta**2)
        self.y = independent.orbit(n, ratio, zeta, "displacement", duration)
        self.family = Family(n, Contact(ratio, zeta))
        self.duration = duration
        self.contact_time = duration * rng.uniform(0, 1, 7)
        self.flight_time = duration + (2 * np.pi * n - duration) * rng.uniform(0, 1, 7)

    @property
    def start(self):
        """X, Y and u of the spring-damper orbit."""
        amplitude, phase, velocity, _ = self.y
        x = amplitude * np.cos(phase)
        return x, amplitude * np.sin(phase), velocity - x

    def coefficients(self):
        """a, b, c of Eqs. 12 and 13, and A and B for δ = 0 and z′ = z′_i at the start."""
        ratio = self.ratio
        zeta = self.zeta
        amplitude, phase, velocity, _ = self.y
        a = ratio * np.sqrt(1 - zeta**2)
        b = -2 * zeta * ratio / self.gamma
        c = ((2 * zeta * ratio) ** 2 + ratio**2 * (ratio**2 - 1)) / self.gamma
        steady = amplitude * (b * np.cos(phase) + c * np.sin(phase))
        speed = amplitude * (-b * np.sin(phase) + c * np.cos(phase))
        first = amplitude * np.sin(phase) + 1 / ratio**2 - steady
        second = (velocity - speed + zeta * ratio * first) / a
        return a, b, c, first, second

    def contact_height(self, s):
        """Eq. 12 as printed."""
        a, b, c, first, second = self.coefficients()
        amplitude, phase, *_ = self.y
        decay = np.exp(-self.zeta * self.ratio * s)
        transient = decay * (first * np.cos(a * s) + second * np.sin(a * s))
        steady = amplitude * (b * np.cos(s + phase) + c * np.sin(s + phase))
        return -1 / self.ratio**2 + transient + steady

    def contact_velocity(self, s):
        """Eq. 13 as printed."""
        a, b, c, first, second = self.coefficients()
        amplitude, phase, *_ = self.y
        ratio = self.ratio
        zeta = self.zeta
        transient = np.exp(-zeta * ratio * s) * (
            (-zeta * ratio * first + a * second) * np.cos(a * s)
            + (-a * first - zeta * ratio * second) * np.sin(a * s)
        )
        return transient + amplitude * (-b * np.sin(s + phase) + c * np.cos(s + phase))


def free_flight(p):
    """y = -g(t - t₀)²/2 + (t - t₀)ẏ₀ + y₀ and ẏ = -g(t - t₀) + ẏ₀."""
    impact_height = p.amplitude * np.sin(p.phase)
    t = p.flight_time / p.frequency
    start = impact_height * p.length
    speed = p.n * np.pi * p.length * p.frequency
    motion = [
        restitution.height(p.n, impact_height, p.flight_time) * p.length,
        restitution.velocity(p.n, p.flight_time) * p.length * p.frequency,
    ]
    return motion, [-GRAVITY * t**2 / 2 + t * speed + start, -GRAVITY * t + speed]


def impact_law(p):
    """ẏ⁺ - ẋ = -r(ẏ⁻ - ẋ)."""
    velocity = p.n * np.pi + 0.1
    time, after, _ = restitution.impact_map(p.r, p.amplitude, p.phase, velocity)
    table = p.amplitude * np.cos(time)
    before = velocity - (time - p.phase)
    return after - table, -p.r * (before - table)


def velocity_before_an_impact(p):
    """ẏ⁻(t₁) = -g(t₁ - t₀) + ẏ(t₀)."""
    flight = restitution.flight_time(p.amplitude, p.phase, p.n * np.pi)
    scale = p.length * p.frequency
    velocity = restitution.velocity(p.n, flight * (1 - 1e-15)) * scale
    return velocity, -GRAVITY * flight / p.frequency + p.n * np.pi * scale


def dimensionless_flight(p):
    """z = -(τ - τ₀)²/2 + (τ - τ₀)z₀′ + z₀ and z′ = -(τ - τ₀) + z₀′."""
    s = p.flight_time
    impact_height = p.amplitude * np.sin(p.phase)
    motion = [restitution.height(p.n, impact_height, s), restitution.velocity(p.n, s)]
    return motion, [-(s**2) / 2 + s * p.n * np.pi + impact_height, -s + p.n * np.pi]


def iterated_map(p):
    """Λ[sin(τ + Δ) - sin τ] = Δv - Δ²/2 and v₁ = -r(v - Δ) + (1 + r)Λ cos(τ + Δ)."""
    velocity = p.n * np.pi + 0.1
    time, after, _ = restitution.impact_map(p.r, p.amplitude, p.phase, velocity)
    flight = time - p.phase
    height = p.amplitude * (np.sin(p.phase + flight) - np.sin(p.phase))
    table = p.amplitude * np.cos(p.phase + flight)
    printed = [flight * velocity - flight**2 / 2, -p.r * (velocity - flight) + (1 + p.r) * table]
    return [height, after], printed


def fixed_points(p):
    """τ₁ = τ₀ + 2πn and v = -r(v - 2πn) + (1 + r)Λ cos(τ₀ + 2πn)."""
    velocity = restitution.bounce_velocity(p.n)
    phase = restitution.impact_phase(p.n, p.r, p.amplitude)
    turn = 2 * np.pi * p.n
    printed = -p.r * (velocity - turn) + (1 + p.r) * p.amplitude * np.cos(phase + turn)
    return [phase, velocity], [p.phase, printed]


def existence(p):
    """Λ ≥ nπ(1 - r)/(1 + r)."""
    return restitution.saddle_node(p.n, p.r), p.n * np.pi * (1 - p.r) / (1 + p.r)


def printed_period_doubling(p):
    """Λ = √(1 + n²π²[(1 - r)/(1 + r)]²)."""
    printed = np.sqrt(1 + p.n**2 * np.pi**2 * ((1 - p.r) / (1 + p.r)) ** 2)
    return restitution.holmes_period_doubling(p.n, p.r), printed


def resting_ball(p):
    """|w″| = Λ|sin τ| ≤ 1 for all τ, hence Λ ≤ 1."""
    return restitution.PERMANENT_CONTACT * np.abs(np.sin(np.linspace(0, 7, 100_001))).max(), 1


def gained(p, acceleration):
    """Integral over the contact of an acceleration that is a function of w, w′, δ and δ′.

    Sixty nodes of Gauss integrate less than a turn of sines and exponentials to rounding.
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)
    s = p.duration * (nodes + 1) / 2
    x, impact_height, u = p.start
    table = x * np.sin(s) + impact_height * np.cos(s), x * np.cos(s) - impact_height * np.sin(s)
    displacement, velocity, _ = p.family.contact.motion(s, u, x, impact_height)
    return p.duration / 2 * np.sum(weights * acceleration(*table, displacement, velocity))


def contact_in_units(p):
    """mÿ + cẏ - cẋ + ky - kx = -mg."""

    def acceleration(table, table_velocity, displacement, velocity):
        speed = p.length * p.frequency
        x = table * p.length
        y = (table + displacement) * p.length
        x_rate = table_velocity * speed
        y_rate = (table_velocity + velocity) * speed
        forces = p.damping * (x_rate - y_rate) + p.stiffness * (x - y) - p.mass * GRAVITY
        return forces / p.mass

    # Its integral by t = τ/Ω, in units of velocity.
    gain = gained(p, acceleration) / p.frequency
    return (p.family.bounce_velocity(p.y) - p.y[2]) * p.length * p.frequency, gain


def contact_equation(p):
    """z″ + 2ζϖ(z′ - w′) + ϖ²(z - w) = -1."""
    damper = 2 * p.zeta * p.ratio

    def acceleration(w, w_rate, displacement, velocity):
        z = w + displacement
        z_rate = w_rate + velocity
        return -1 - damper * (z_rate - w_rate) - p.ratio**2 * (z - w)

    return p.family.bounce_velocity(p.y) - p.y[2], gained(p, acceleration)


def height_in_contact(p):
    height, _, touching = p.family.motion(p.y[:, np.newaxis], p.contact_time)
    assert touching.all()
    return height, p.contact_height(p.contact_time)


def velocity_in_contact(p):
    _, velocity, _ = p.family.motion(p.y[:, np.newaxis], p.contact_time)
    return velocity, p.contact_velocity(p.contact_time)


def height_in_flight(p):
    """z = -(τ - τ_b)²/2 + (τ - τ_b)z′_b + Λ sin(τ_b + φ)."""
    height, _, touching = p.family.motion(p.y[:, np.newaxis], p.flight_time)
    assert not touching.any()
    since = p.flight_time - p.duration
    bounce = p.contact_velocity(p.duration)
    return height, -(since**2) / 2 + since * bounce + p.y[0] * np.sin(p.duration + p.y[1])


def velocity_in_flight(p):
    """z′ = -(τ - τ_b) + z′_b."""
    _, velocity, _ = p.family.motion(p.y[:, np.newaxis], p.flight_time)
    return velocity, -(p.flight_time - p.duration) + p.contact_velocity(p.duration)


def damping_ratio(p):
    """ζ = -ln r/√(π² + ln² r)."""
    printed = -np.log(p.r) / np.sqrt(np.pi**2 + np.log(p.r) ** 2)
    return spring_damper.damping_ratio(p.r), printed


def apparent_restitution(p):
    """r_a = -(z′_b - w′_b)/(z′_i - w′_i)."""
    amplitude, phase, velocity, _ = p.y
    bounce = p.contact_velocity(p.duration) - amplitude * np.cos(phase + p.duration)
    impact = velocity - amplitude * np.cos(phase)
    return p.family.apparent_restitution(p.y), -bounce / impact


def time_origin(p):
    """τ_i = 0."""
    height, velocity, touching = p.family.motion(p.y, np.array(0.0))
    assert touching
    return [height, velocity], [p.y[0] * np.sin(p.y[1]), p.y[2]]


def periodic_time(p):
    """τ₂ = τ_i + 2πn."""
    end = p.family.contact_end(p.y)
    return [p.family.period, end.duration + end.flight], [2 * np.pi * p.n] * 2


def periodic_velocity(p):
    """z′₂ = z′_i."""
    return p.family.motion(p.y, np.array(p.family.period))[1], p.y[2]


def contact_begins_at_the_table(p):
    """z_c(τ_i) = Λ sin φ."""
    return p.family.motion(p.y, np.array(0.0))[0], p.contact_height(0.0)


def contact_begins_with_the_impact(p):
    """z′_c(τ_i) = z′_i."""
    return p.family.motion(p.y, np.array(0.0))[1], p.contact_velocity(0.0)


def contact_ends_at_the_table(p):
    """z_c(τ_b) = Λ sin(τ_b + φ)."""
    table = p.y[0] * np.sin(p.duration + p.y[1])
    end = p.family.contact_end(p.y)
    return [end.table_height + end.gap, end.table_height], [p.contact_height(p.duration), table]


def contact_ends_with_the_bounce(p):
    """z′_c(τ_b) = z′_b."""
    return p.family.bounce_velocity(p.y), p.contact_velocity(p.duration)


def flight_ends_at_the_table(p):
    """z_f(τ₂) = Λ sin(τ₂ + φ)."""
    height = p.family.motion(p.y, np.array(p.family.period))[0]
    return height, p.y[0] * np.sin(2 * np.pi * p.n + p.y[1])


def flight_ends_with_the_impact(p):
    """z′_f(τ₂) = z′₂."""
    flight = 2 * np.pi * p.n - p.duration
    velocity = p.family.motion(p.y, np.array(p.family.period))[1]
    return velocity, p.contact_velocity(p.duration) - flight


def bounce_from_the_impact(p):
    """z′_b = z′_i + 2πn - τ_b."""
    return p.family.bounce_velocity(p.y), p.y[2] + 2 * np.pi * p.n - p.duration


def relative_motion(p):
    """δ = z - w."""
    x, impact_height, u = p.start
    s = p.contact_time
    displacement = p.family.contact.motion(s, u, x, impact_height).displacement
    return displacement, p.contact_height(s) - p.y[0] * np.sin(s + p.y[1])


def relative_equation(p):
    """δ″ + 2ζϖδ′ + ϖ²δ = -1 - w″."""

    def acceleration(w, w_rate, displacement, velocity):
        return -1 + w - 2 * p.zeta * p.ratio * velocity - p.ratio**2 * displacement

    return p.family.contact_end(p.y).gap_velocity - p.start[2], gained(p, acceleration)


def steady_motion(p, sine, cosine):
    """The motion of the package from δ = 0 on the steady motion, and the steady motion as printed.

    The amplitude is larger than that of permanent contact, so that δ vanishes at some time.
    """
    amplitude = 1.3 * np.sqrt(p.gamma) / p.ratio**2
    rest = 1 / p.ratio**2 / amplitude
    begin = np.arcsin(rest / np.hypot(sine, cosine)) - np.arctan2(cosine, sine)
    s = np.linspace(0, 5, 11)
    speed = amplitude * (sine * np.cos(begin) - cosine * np.sin(begin))
    start = amplitude * np.cos(begin), amplitude * np.sin(begin)
    displacement = p.family.contact.motion(s, speed, *start).displacement
    time = begin + s
    return displacement, -1 / p.ratio**2 + amplitude * (sine * np.sin(time) + cosine * np.cos(time))


def steady_coefficients(p):
    """δ = -1/ϖ² + Λ[α₁ sin(τ + φ) + α₂ cos(τ + φ)], α₁ = (ϖ² - 1)/γ, α₂ = -2ζϖ/γ."""
    return steady_motion(p, (p.ratio**2 - 1) / p.gamma, -2 * p.zeta * p.ratio / p.gamma)


def steady_bracket(p):
    """δ = -1/ϖ² + (Λ/γ)[(ϖ² - 1) sin(τ + φ) - 2ζϖ cos(τ + φ)], and the bracket is at most √γ."""
    sine = p.ratio**2 - 1
    cosine = -2 * p.zeta * p.ratio
    turn = np.linspace(0, 2 * np.pi, 100_001)
    largest = np.max(sine * np.sin(turn) + cosine * np.cos(turn))
    displacement, printed = steady_motion(p, sine / p.gamma, cosine / p.gamma)
    # Samples miss the largest value by the square of their distance, 1e-9.
    assert largest == pytest.approx(np.sqrt(p.gamma), rel=1e-8)
    return displacement, printed


def greatest_displacement(p):
    """-1/ϖ² + Λ/√γ ≤ 0."""
    threshold = spring_damper.permanent_contact(p.ratio, p.zeta)
    return threshold / np.sqrt(p.gamma), 1 / p.ratio**2


def permanent_contact(p):
    """Λ ≤ √(1 + (4ζ² - 2)/ϖ² + 1/ϖ⁴)."""
    printed = np.sqrt(1 + (4 * p.zeta**2 - 2) / p.ratio**2 + 1 / p.ratio**4)
    return spring_damper.permanent_contact(p.ratio, p.zeta), printed


def threshold_ratio(p, sign):
    """ϖ± = √([1 - 2ζ² ± √((1 - 2ζ²)² + Λ² - 1)]/(1 - Λ²)); the first, printed as Eq. 34, is ϖ₊."""
    lowest = 2 * p.zeta * np.sqrt(1 - p.zeta**2)
    amplitude = (1 + lowest) / 2
    middle = 1 - 2 * p.zeta**2
    root = np.sqrt(middle**2 + amplitude**2 - 1)
    ratio = spring_damper.permanent_contact_ratios(amplitude, p.zeta)[1 if sign > 0 else 0]
    return ratio, np.sqrt((middle + sign * root) / (1 - amplitude**2))


def larger_threshold_ratio(p):
    return threshold_ratio(p, 1)


def smaller_threshold_ratio(p):
    return threshold_ratio(p, -1)


def lowest_threshold(p):
    """Λ ≤ 2ζ√(1 - ζ²) for all ϖ."""
    _, amplitude = spring_damper.lowest_permanent_contact(p.zeta)
    return amplitude, 2 * p.zeta * np.sqrt(1 - p.zeta**2)


def error_of_the_height(p):
    """|max z_SD(ϖ_h) - max z_CR|/max z_CR = 0.01."""
    ratios = np.array([20.0, 60.0, 180.0, 540.0])
    reference = restitution.max_height(1, 0.65, 1.0)
    error = errors.errors(["max_height"], 1, 0.65, 1.0, ratios, "displacement")["max_height"]
    ratio = errors.threshold(ratios, error, 0.01).ratio
    zeta = independent.restitution_to_damping(0.65)
    (angle,) = independent.roots(
        lambda angle: independent.orbit(1, ratio, zeta, "displacement", angle / ratio)[0] - 1,
        np.array([3.1, 3.18]),
    )
    height = independent.cycle(
        ratio,
        zeta,
        "displacement",
        *independent.orbit(1, ratio, zeta, "displacement", angle / ratio)[:3],
    ).greatest_height()
    return 0.01, abs(height - reference) / reference


def error_of_permanent_contact(p):
    """|Λ_SD(ϖ_PC) - Λ_CR|/Λ_CR = 0.01."""
    ratios = np.geomspace(3, 300, 7)
    error = errors.permanent_contact_error(ratios, p.zeta, "displacement")
    ratio = errors.threshold(ratios, error, 0.01).ratio
    printed = np.sqrt(1 + (4 * p.zeta**2 - 2) / ratio**2 + 1 / ratio**4)
    return 0.01, abs(printed - 1)


EQUATIONS = {
    1: free_flight,
    2: impact_law,
    3: velocity_before_an_impact,
    4: dimensionless_flight,
    5: iterated_map,
    6: fixed_points,
    7: existence,
    8: printed_period_doubling,
    9: resting_ball,
    10: contact_in_units,
    11: contact_equation,
    12: height_in_contact,
    13: velocity_in_contact,
    14: height_in_flight,
    15: velocity_in_flight,
    16: damping_ratio,
    17: apparent_restitution,
    18: time_origin,
    19: periodic_time,
    20: periodic_velocity,
    21: contact_begins_at_the_table,
    22: contact_begins_with_the_impact,
    23: contact_ends_at_the_table,
    24: contact_ends_with_the_bounce,
    25: flight_ends_at_the_table,
    26: flight_ends_with_the_impact,
    27: bounce_from_the_impact,
    28: relative_motion,
    29: relative_equation,
    30: steady_coefficients,
    31: steady_bracket,
    32: greatest_displacement,
    33: permanent_contact,
    34: larger_threshold_ratio,
    35: smaller_threshold_ratio,
    36: lowest_threshold,
    37: error_of_the_height,
    38: error_of_permanent_contact,
}


@pytest.mark.parametrize(
    "equation", EQUATIONS.values(), ids=[f"Eq. {number}" for number in EQUATIONS]
)
def test_the_printed_formula_is_that_of_the_package(equation):
    for seed in range(3):
        computed, printed = equation(Parameters(seed))
        # Some hundred roundings of 1e-16, of terms that are a hundred times larger than the result
        # at most.
        np.testing.assert_allclose(computed, printed, rtol=1e-11, atol=1e-12)
