"""Stage: one contact, its force, its ends, the flights before and after it, and its time in s."""

import numpy as np
import xarray as xr

from bouncing_ball_beyond.contacts.balls import Impact, Rigid, SpringDamper, damping_of
from bouncing_ball_beyond.contacts.named_laws import tsuji
from bouncing_ball_beyond.errors.error_law import free_impact
from bouncing_ball_beyond.errors.shaker import STANDARD_GRAVITY
from bouncing_ball_beyond.periodic.orbits import orbit
from paper_replication.datasets import grid

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
        SpringDamper(1.0, damping_ratio=zeta, release=condition).signature(1.0)
        for condition in RELEASES
    ]
    given = damping_of(parameters["restitution"])
    balls = [SpringDamper(1.0, damping_ratio=given, release=condition) for condition in RELEASES]
    ends = [ball.signature(1.0) for ball in balls]
    time = np.linspace(0.0, ends[0].duration, parameters["samples"])
    contact = balls[0].contact(0.0, 1.0, time, amplitude=0.0, gravity=0.0)
    shape = ("release", "damping_ratio")
    return xr.Dataset(
        {
            "restitution": (shape, [signature.restitution for signature in along]),
            "contact_duration": (shape, [signature.duration for signature in along]),
            "free_force": ("time", force(balls[0], contact)),
            "contact_end": ("release", [signature.duration for signature in ends]),
            "end_restitution": ("release", [signature.restitution for signature in ends]),
        },
        {"release": RELEASES, "damping_ratio": zeta, "time": time},
    )


def ext_instant(parameters: dict, release: str) -> xr.Dataset:
    """The contact of an orbit, with the flights before and after it continued into it."""
    ratio = parameters["frequency_ratio"]
    amplitude = parameters["amplitude"]
    ball = SpringDamper(ratio, restitution=parameters["restitution"], release=release)
    contact_orbit = orbit(ball, amplitude=amplitude, n=parameters["n"])
    end = contact_orbit.contact_duration
    # The ends of the contact are samples, if they are, whatever rounding does.
    share = np.linspace(-0.6, 1.6, parameters["samples"]).round(12)
    time = share * end
    table = amplitude * np.sin(contact_orbit.phase + time)
    speed = -contact_orbit.relative_impact_velocity
    inside = np.clip(time, 0, end)
    contact = ball.contact(contact_orbit.phase, speed, ratio * inside, amplitude)
    start = amplitude * np.sin(contact_orbit.phase)
    before = start + (contact_orbit.impact_velocity - time / 2) * time
    last = ball.contact(contact_orbit.phase, speed, ratio * end, amplitude)
    bounce = amplitude * np.sin(contact_orbit.phase + end) + last.gap
    since = time - end
    after = bounce + (contact_orbit.bounce_velocity - since / 2) * since
    touching = (share >= 0) & (share <= 1)
    # Both parabolas have the same curvature, so that they differ by a straight line.
    jump = contact_orbit.bounce_velocity + end - contact_orbit.impact_velocity
    apart = bounce - (start + (contact_orbit.impact_velocity - end / 2) * end)
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
            "meeting_height": start + (contact_orbit.impact_velocity - meeting / 2) * meeting,
            "delay": ball.signature(speed).centroid,
        },
        {"time": time},
    )


def compliance(body: dict) -> float:
    """(1 - ν²)/E of a ball or of a table, in 1/Pa."""
    return (1 - body["poissons_ratio"] ** 2) / body["youngs_modulus"]


def hertz_time(ball: dict, table: dict, speed: np.ndarray) -> np.ndarray:
    """Durations in s of free impacts at speeds in m/s, by the law of Hertz with Tsuji's damping.

    A law without units takes them all: here its units are those of the SI.
    """
    radius = ball["diameter"] / 2
    mass = ball["density"] * 4 / 3 * np.pi * radius**3
    modulus = 1 / (compliance(ball) + compliance(table))
    law = tsuji(restitution=ball["restitution"], duration=1.0, speed=1.0)
    stiff = law.at(stiffness=4 / 3 * modulus * np.sqrt(radius) / mass)
    return stiff.signature(speed).duration


def ext_contact_time(parameters: dict) -> xr.Dataset:
    """Contact times of balls at the impact speed of their orbit, along the table's frequency.

    The time is in proportion to v^(-1/5), and v to 1/Ω. The part of the period that the contact
    lasts is therefore in proportion to Ω^(6/5), which gives the frequency at which it is 1/(2ϖ).
    """
    frequency = grid(parameters["frequency"])
    balls = parameters["balls"]
    r = np.array([ball["restitution"] for ball in balls.values()])
    unit = STANDARD_GRAVITY / (2 * np.pi * frequency)
    speeds = unit * free_impact(Rigid(r), parameters["n"]).speed[:, np.newaxis]
    times = np.stack(
        [
            hertz_time(ball, parameters["table_material"], speed)
            for ball, speed in zip(balls.values(), speeds, strict=True)
        ]
    )
    longest = 1 / (2 * parameters["frequency_ratio"])
    part = times[:, 0] * frequency[0]
    return xr.Dataset(
        {
            "impact_speed": (("ball_name", "frequency"), speeds),
            "contact_time": (("ball_name", "frequency"), times),
            "longest_contact_time": ("frequency", longest / frequency),
            "stiff_frequency": ("ball_name", frequency[0] * (longest / part) ** (5 / 6)),
        },
        {"ball_name": list(balls), "frequency": frequency, "restitution": ("ball_name", r)},
    )


STAGE = {
    "ext_impact": ext_impact,
    "ext_instant": ext_instant,
    "ext_contact_time": ext_contact_time,
}
