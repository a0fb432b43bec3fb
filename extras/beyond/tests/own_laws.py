"""Laws that are a line of force each, as a user writes them: kinks, a damper that is limited, and
damping by the speed at the start of a contact."""

import numpy as np

from bouncing_ball_beyond.contacts.laws import ForceLaw


def hunt_crossley_linear(stiffness, damping):
    """f = K p (1 + C p′)."""

    def force(p, v, stiffness, damping):
        return stiffness * p * (1 + damping * v)

    return ForceLaw(force, {"stiffness": stiffness, "damping": damping})


def flores(stiffness, nominal):
    """f = K p^{3/2} (1 + c p′/v₀), c = 8(1 - e)/(5e)."""

    def force(p, v, stiffness, factor, start_speed):
        return stiffness * p * np.sqrt(p) * (1 + factor * v / start_speed)

    values = {"stiffness": stiffness, "factor": 8 * (1 - nominal) / (5 * nominal)}
    return ForceLaw(force, values, root=2, needs=("start_speed",))


def limited_damper(frequency_ratio, damping_ratio):
    """f = ϖ²p + 2ζϖp′, the damping force at most ϖ²p."""

    def force(p, v, frequency_ratio, damping_ratio):
        damped = 2 * damping_ratio / frequency_ratio * v
        limited = np.where(np.real(damped) < np.real(p), damped, p)
        return frequency_ratio * frequency_ratio * (p + limited)

    def equal_forces(p, v, frequency_ratio, damping_ratio):
        return p - 2 * damping_ratio / frequency_ratio * v

    return ForceLaw(
        force,
        {"frequency_ratio": frequency_ratio, "damping_ratio": damping_ratio},
        release="force",
        lag=lambda frequency_ratio, damping_ratio: 2 * damping_ratio / frequency_ratio,
        kinks=(equal_forces,),
    )


def stepped_spring(stiffness, damping, depth):
    """f = max(0, K p + C s p′) with the cubic step s of the depth d."""

    def step(p, depth):
        x = p / depth
        return np.where(np.real(x) < 1, x * x * (3 - 2 * x), 1.0)

    def force(p, v, stiffness, damping, depth):
        whole = stiffness * p + damping * step(p, depth) * v
        return np.where(np.real(whole) > 0, whole, 0.0)

    def full_depth(p, v, stiffness, damping, depth):
        return p - depth

    def pulls(p, v, stiffness, damping, depth):
        # The force over p, where it is not limited.
        inside = p * (3 - 2 * p / depth) / (depth * depth)
        over = np.where(np.real(p) < np.real(depth), inside, 1 / np.maximum(p, depth))
        return stiffness + damping * over * v

    values = {"stiffness": stiffness, "damping": damping, "depth": depth}
    return ForceLaw(force, values, kinks=(full_depth, pulls))
