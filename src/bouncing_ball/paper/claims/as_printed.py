"""Equations in the form that the paper prints, right or wrong, as far as they are legible.

These are Eqs. 2-8, 10-17, 19, 21 and 22, 27, 31 and 33-38. There are no functions of the others:
Eqs. 1, 9, 28-30 and 32, and the conditions of Eqs. 18, 20 and 23-26, which say that two of these
functions are equal. Only the claims use these functions, to check them and to compare other results
with them; the figures and Table 1 are computed by the library. All quantities are dimensionless
except those of Eq. 10, and the functions broadcast.
"""

import numpy as np


def restitution_law(before, table, restitution):
    """Eq. 2: ẏ⁺ from ẏ⁻ and the table's velocity, ẏ⁺ - ẇ = -r (ẏ⁻ - ẇ).

    Examples
    --------
    >>> restitution_law(-3.0, 1.0, 0.5)
    3.0
    """
    return table - restitution * (before - table)


def free_flight(time, start, height, velocity):
    """Eq. 4, and Eq. 3 for the velocity: height and velocity in flight since τ₀, from z₀ and z′₀.

    Examples
    --------
    >>> free_flight(3.0, 1.0, 0.0, 4.0)
    (6.0, 2.0)
    """
    since = time - start
    return -(since**2) / 2 + since * velocity + height, -since + velocity


def landing_defect(phase, velocity, flight, amplitude):
    """First line of Eq. 5: Λ[sin(τ₀ + s) - sin τ₀] - (s v₀ - s²/2), which is zero at the landing.

    Examples
    --------
    >>> abs(float(landing_defect(0.0, 2.0, 4.0, 0.0)))
    0.0
    """
    rise = amplitude * (np.sin(phase + flight) - np.sin(phase))
    return rise - (flight * velocity - flight * flight / 2)


def bounced_velocity(phase, velocity, flight, amplitude, restitution):
    """Second line of Eq. 5: v₁ = -r (v₀ - s) + (1 + r) Λ cos(τ₀ + s).

    Examples
    --------
    >>> float(bounced_velocity(0.0, 2.0, 4.0, 0.0, 0.5))
    1.0
    """
    push = (1 + restitution) * amplitude * np.cos(phase + flight)
    return -restitution * (velocity - flight) + push


def fixed_point(n, restitution, amplitude):
    """The solution of Eq. 6: φ = arccos[nπ/Λ (1 - r)/(1 + r)] and v = nπ.

    Examples
    --------
    >>> phase, velocity = fixed_point(1, 1.0, 2.0)
    >>> float(phase) == np.pi / 2, float(velocity) == np.pi
    (True, True)
    """
    share = n * np.pi / amplitude * (1 - restitution) / (1 + restitution)
    return np.arccos(share), n * np.pi + 0 * share


def saddle_node(n, restitution):
    """Eq. 7: Λ = nπ (1 - r)/(1 + r).

    Examples
    --------
    >>> bool(np.isclose(saddle_node(1, 0.5), np.pi / 3))
    True
    """
    return n * np.pi * (1 - restitution) / (1 + restitution)


def period_doubling(n, restitution):
    """Eq. 8: Λ = √(1 + [nπ (1 - r)/(1 + r)]²), the period doubling of Holmes' map.

    Examples
    --------
    >>> float(period_doubling(3, 1.0))
    1.0
    """
    return np.sqrt(1 + saddle_node(n, restitution) ** 2)


def acceleration(rise, rate, frequency, damping_ratio, gravity=1.0):
    """Eq. 11: the absolute acceleration in contact, δ″ + w″ = -1 - 2ζϖ δ′ - ϖ² δ.

    With the frequency of the contact in rad/s and g in m/s² this is Eq. 10.

    Examples
    --------
    >>> acceleration(-0.25, 0.0, 2.0, 0.1)
    0.0
    """
    return -gravity - 2 * damping_ratio * frequency * rate - frequency**2 * rise


def contact(time, frequency_ratio, damping_ratio, amplitude, phase, a, b):
    """Eqs. 12 and 13: height and velocity of the ball in contact.

    ``z = e^{-ζϖτ}(A cos ϖ_d τ + B sin ϖ_d τ) - 1/ϖ² + βΛ cos(τ + φ) + χΛ sin(τ + φ)``
    with β = -2ζϖ/γ, χ = [(2ζϖ)² + ϖ²(ϖ² - 1)]/γ, γ = (ϖ² - 1)² + (2ζϖ)².

    Examples
    --------
    On a table at rest without oscillation the ball rests at -1/ϖ²:

    >>> height, velocity = contact(1.0, 2.0, 0.1, 0.0, 0.0, 0.0, 0.0)
    >>> float(height), float(velocity)
    (-0.25, 0.0)
    """
    omega = frequency_ratio
    zeta = damping_ratio
    loss = 2 * zeta * omega
    stiffness = omega**2
    damped = omega * np.sqrt(1 - zeta**2)
    gamma = (stiffness - 1) ** 2 + loss**2
    beta = -loss / gamma
    chi = (loss**2 + stiffness * (stiffness - 1)) / gamma
    decay = np.exp(-zeta * omega * time)
    cosine = np.cos(damped * time)
    sine = np.sin(damped * time)
    table_cosine = amplitude * np.cos(time + phase)
    table_sine = amplitude * np.sin(time + phase)
    height = decay * (a * cosine + b * sine) - 1 / stiffness + beta * table_cosine
    velocity = decay * (
        (-zeta * omega * a + damped * b) * cosine - (damped * a + zeta * omega * b) * sine
    )
    return height + chi * table_sine, velocity - beta * table_sine + chi * table_cosine


def contact_after_impact(time, frequency_ratio, damping_ratio, amplitude, phase, impact_velocity):
    """Eqs. 12 and 13 for a contact that starts with an impact: height and velocity, shape (2, ...).

    The constants A and B are linear in the height and velocity of the impact (Eqs. 21-22).

    Examples
    --------
    >>> contact_after_impact(0.0, 2.0, 0.0, 0.0, 0.0, -3.0).tolist()
    [0.0, -3.0]
    """
    zero, rate = contact(
        time=0.0,
        frequency_ratio=frequency_ratio,
        damping_ratio=damping_ratio,
        amplitude=amplitude,
        phase=phase,
        a=0.0,
        b=0.0,
    )
    a = amplitude * np.sin(phase) - zero
    damped = frequency_ratio * np.sqrt(1 - damping_ratio**2)
    b = (impact_velocity - rate + damping_ratio * frequency_ratio * a) / damped
    return np.array(
        contact(
            time=time,
            frequency_ratio=frequency_ratio,
            damping_ratio=damping_ratio,
            amplitude=amplitude,
            phase=phase,
            a=a,
            b=b,
        )
    )


def flight(time, release_time, bounce_velocity, amplitude, phase):
    """Eqs. 14 and 15: height and velocity of the ball in flight since τ_b.

    Examples
    --------
    >>> height, velocity = flight(2.0, 0.0, 2.0, 0.0, 0.0)
    >>> float(height), float(velocity)
    (2.0, 0.0)
    """
    height = amplitude * np.sin(release_time + phase)
    return free_flight(time, release_time, height, bounce_velocity)


def damping_ratio(restitution):
    """Eq. 16: ζ = -ln r/√(π² + ln² r).

    Examples
    --------
    >>> float(damping_ratio(np.exp(-np.pi))) == 2**-0.5
    True
    """
    loss = np.log(restitution)
    return -loss / np.sqrt(np.pi**2 + loss**2)


def apparent_restitution(bounce_velocity, table_at_bounce, impact_velocity, table_at_impact):
    """Eq. 17: r_a = -(z′_b - w′_b)/(z′_i - w′_i).

    Examples
    --------
    >>> apparent_restitution(1.0, 0.0, -2.0, 0.0)
    0.5
    """
    return -(bounce_velocity - table_at_bounce) / (impact_velocity - table_at_impact)


def flight_time(n, duration):
    """Eqs. 18 and 19: the time of flight τ_2 - τ_b, where τ_2 = τ_i + 2πn and τ_i = 0.

    Examples
    --------
    >>> flight_time(1, np.pi) == np.pi
    True
    """
    return 2 * np.pi * n - duration


def bounce_velocity(impact_velocity, n, duration):
    """Eq. 27: z′_b = z′_i + 2πn - τ_b.

    Examples
    --------
    >>> bounce_velocity(-np.pi, 1, 0.0) == np.pi
    True
    """
    return impact_velocity + 2 * np.pi * n - duration


def steady_displacement(time, frequency_ratio, damping_ratio, amplitude):
    """Eq. 31: relative displacement in permanent contact, with τ + φ as the time::

        δ = z - w                                                                  (28)
        δ″ + 2ζϖ δ′ + ϖ² δ = -1 - w″                                               (29)
        δ = -1/ϖ² + χ₁Λ sin(τ + φ) + χ₂Λ cos(τ + φ)                                (30)
        δ = -1/ϖ² + Λ/γ [(ϖ² - 1) sin(τ + φ) - 2ζϖ cos(τ + φ)]                     (31)

    with χ₁ = (ϖ² - 1)/γ, χ₂ = -2ζϖ/γ and γ = (ϖ² - 1)² + (2ζϖ)².

    Examples
    --------
    >>> float(steady_displacement(0.0, 2.0, 0.0, 1.0))
    -0.25
    """
    detuning = frequency_ratio**2 - 1
    loss = 2 * damping_ratio * frequency_ratio
    gamma = detuning**2 + loss**2
    swing = amplitude / gamma * (detuning * np.sin(time) - loss * np.cos(time))
    return -1 / frequency_ratio**2 + swing


def permanent_contact_threshold(frequency_ratio, damping_ratio):
    """Eq. 33: Λ_SD = √(1 + (4ζ² - 2)/ϖ² + 1/ϖ⁴).

    Examples
    --------
    >>> float(permanent_contact_threshold(2.0, 0.0))
    0.75
    """
    return np.sqrt(1 + (4 * damping_ratio**2 - 2) / frequency_ratio**2 + frequency_ratio**-4.0)


def permanent_contact_frequency_ratio(threshold, damping_ratio, sign):
    """Eqs. 34 (sign +1) and 35 (sign -1): the ϖ at which Λ_SD has a given value.

    Examples
    --------
    >>> round(float(permanent_contact_frequency_ratio(0.75, 0.0, 1)), 12)
    2.0
    """
    centre = 1 - 2 * damping_ratio**2
    root = np.sqrt(centre**2 + threshold**2 - 1)
    return np.sqrt((centre + sign * root) / (1 - threshold**2))


def permanent_contact_minimum(damping_ratio):
    """Eq. 36: the lowest Λ_SD, 2ζ√(1 - ζ²).

    Examples
    --------
    >>> round(float(permanent_contact_minimum(0.6)), 15)
    0.96
    """
    return 2 * damping_ratio * np.sqrt(1 - damping_ratio**2)


def greatest_height(bounce_velocity, bounce_height):
    """The greatest height of Eq. 14, z_b + z′_b²/2, which Eq. 37 compares.

    Examples
    --------
    >>> greatest_height(2.0, 0.0)
    2.0
    """
    return free_flight(bounce_velocity, 0.0, bounce_height, bounce_velocity)[0]


def relative_error(spring_damper, restitution):
    """Eqs. 37 and 38: |q_SD - q_CR|/q_CR of the greatest height, or of the threshold.

    Examples
    --------
    >>> float(relative_error(1.5, 2.0))
    0.25
    """
    return np.abs(spring_damper - restitution) / restitution
