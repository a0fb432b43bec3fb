"""Stage: one contact, its force, its ends, and the flights before and after it."""

import numpy as np
import xarray as xr

from bouncing_ball_beyond.contacts.balls import Impact, SpringDamper, damping_of
from bouncing_ball_beyond.periodic.orbits import orbit

RELEASES = ["displacement", "force"]


def force(ball: SpringDamper, impact: Impact) -> np.ndarray:
    """The force of a contact per mass, -2ζϖδ′ - ϖ²δ (Eq. 11)."""
    ratio = ball.frequency_ratio
    return -2 * ball.zeta * ratio * impact.speed - ratio**2 * impact.gap


def ext_impact(parameters: dict, release: str) -> xr.Dataset:
    """Free impacts by release and ζ, and the force in one contact. Times are in units of 1/ω, which
    is the unit of time at ϖ = 1.
    """
    zeta = np.linspace(0.0, damping_of(parameters["restitution_min"]), parameters["samples"])
    along = [
        SpringDamper(1.0, damping_ratio=zeta, release=each).signature(1.0) for each in RELEASES
    ]
    given = damping_of(parameters["restitution"])
    balls = [SpringDamper(1.0, damping_ratio=given, release=each) for each in RELEASES]
    ends = [ball.signature(1.0) for ball in balls]
    time = np.linspace(0.0, ends[0].duration, parameters["samples"])
    contact = balls[0].contact(0.0, 1.0, time, amplitude=0.0, gravity=0.0)
    shape = ("release", "damping_ratio")
    return xr.Dataset(
        {
            "restitution": (shape, [each.restitution for each in along]),
            "contact_duration": (shape, [each.duration for each in along]),
            "free_force": ("time", force(balls[0], contact)),
            "contact_end": ("release", [each.duration for each in ends]),
            "end_restitution": ("release", [each.restitution for each in ends]),
        },
        {"release": RELEASES, "damping_ratio": zeta, "time": time},
    )


def ext_instant(parameters: dict, release: str) -> xr.Dataset:
    """The contact of an orbit, with the flights before and after it continued into it."""
    ratio = parameters["frequency_ratio"]
    amplitude = parameters["amplitude"]
    ball = SpringDamper(ratio, restitution=parameters["restitution"], release=release)
    found = orbit(ball, amplitude=amplitude, n=parameters["n"])
    end = found.contact_duration
    # The ends of the contact are samples, if they are, whatever rounding does.
    share = np.linspace(-0.6, 1.6, parameters["samples"]).round(12)
    time = share * end
    table = amplitude * np.sin(found.phase + time)
    speed = -found.relative_impact_velocity
    inside = np.clip(time, 0, end)
    contact = ball.contact(found.phase, speed, ratio * inside, amplitude)
    start = amplitude * np.sin(found.phase)
    before = start + (found.impact_velocity - time / 2) * time
    last = ball.contact(found.phase, speed, ratio * end, amplitude)
    bounce = amplitude * np.sin(found.phase + end) + last.gap
    since = time - end
    after = bounce + (found.bounce_velocity - since / 2) * since
    touching = (share >= 0) & (share <= 1)
    # Both parabolas have the same curvature, so that they differ by a straight line.
    jump = found.bounce_velocity + end - found.impact_velocity
    apart = bounce - (start + (found.impact_velocity - end / 2) * end)
    meeting = end - apart / jump
    return xr.Dataset(
        {
            "ball": ("time", np.select([touching, time < 0], [table + contact.gap, before], after)),
            "table": ("time", table),
            "flight_before": ("time", before),
            "flight_after": ("time", after),
            "contact_force": ("time", np.where(touching, force(ball, contact), 0.0)),
            "contact_duration": end,
            "meeting_time": meeting,
            "meeting_height": start + (found.impact_velocity - meeting / 2) * meeting,
            "delay": ball.signature(speed).centroid,
        },
        {"time": time},
    )


STAGE = {"ext_impact": ext_impact, "ext_instant": ext_instant}
