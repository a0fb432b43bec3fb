"""Time histories of orbits of the spring-damper model (Figs. 7 and 12)."""

import numpy as np
import xarray as xr

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import Many, Samples
from bouncing_ball.studies.parameters import MotionRatio, OrbitParameters

# What is published of each orbit.
_STATE = ("phase", "contact_duration", "impact_velocity", "bounce_velocity")


class ContactHistory(OrbitParameters):
    """One cycle of one orbit."""

    frequency_ratio: MotionRatio
    samples: Samples


class Histories(OrbitParameters):
    """One cycle on several contacts."""

    frequency_ratio: Many[MotionRatio]
    samples: Samples


def _cycle(orbit: Orbit, samples: int) -> tuple[np.ndarray, ...]:
    """Times of one cycle with the orbit's states: contact, then flight.

    Half the samples fall in either part, and τ_b is a sample in both: the
    contact may be a hundredth of the cycle and must be resolved all the same.
    """
    half = samples // 2
    during = np.linspace(0.0, orbit.contact_duration, half)
    after = np.linspace(orbit.contact_duration, 2 * np.pi * orbit.n, samples - half)
    pairs = [orbit.contact_path(during), orbit.flight_path(after)]
    time = np.concatenate([during, after])
    touching = np.concatenate([np.ones(half, bool), np.zeros(samples - half, bool)])
    return time, *(np.concatenate(part) for part in zip(*pairs, strict=True)), touching


def contact_history(parameters: ContactHistory, release: Release) -> xr.Dataset:
    """One cycle of the spring-damper model from the start of contact, shape (sample,) (Fig. 7).

    Raises
    ------
    NoOrbitError
        If the orbit does not exist or is inadmissible.
    """
    lam, ratio = parameters.amplitude, parameters.frequency_ratio
    contact = SpringDamper.from_restitution(parameters.restitution, ratio, release)
    orbit = SpringDamperModel(contact).require_admissible(parameters.n, lam)
    time, ball, velocity, touching = _cycle(orbit, parameters.samples)
    return described(
        {
            "time": ("sample", time),
            "ball": ("sample", ball),
            "ball_velocity": ("sample", velocity),
            "table": ("sample", lam * np.sin(time + orbit.phase)),
            "contact": ("sample", touching),
            "frequency_ratio": ((), ratio),
            **{name: ((), float(getattr(orbit, name))) for name in _STATE},
        }
    )


def both_histories(parameters: Histories, release: Release) -> xr.Dataset:
    """Both models against the phase of the table in rad, shape (ϖ, sample) (Fig. 12).

    Raises
    ------
    NoOrbitError
        If an orbit does not exist or is inadmissible.
    """
    n, lam, r = parameters.n, parameters.amplitude, parameters.restitution
    ratios = np.sort(parameters.frequency_ratio)
    columns: dict[str, list[np.ndarray]] = {"table_phase": [], "ball": [], "contact": []}
    states: dict[str, list[float]] = {name: [] for name in _STATE}
    for ratio in ratios:
        orbit = SpringDamperModel(
            SpringDamper.from_restitution(r, ratio, release)
        ).require_admissible(n, lam)
        time, ball, _, touching = _cycle(orbit, parameters.samples)
        for name, values in zip(columns, (time + orbit.phase, ball, touching), strict=True):
            columns[name].append(values)
        for name in _STATE:
            states[name].append(float(getattr(orbit, name)))
    rigid = RestitutionModel(r).require_orbit(n, lam)
    time = np.linspace(0.0, 2 * np.pi * n, parameters.samples)
    height, _ = rigid.path(np.minimum(time, time[-1] * (1 - 1e-15)))
    dims = ("frequency_ratio", "sample")
    return described(
        {
            **{name: (dims, np.array(values)) for name, values in columns.items()},
            **{name: ("frequency_ratio", values) for name, values in states.items()},
            "restitution_ball": ("sample", height),
            "time": ("sample", time),
            "restitution_phase": ((), float(rigid.phase)),
        },
        coords={"frequency_ratio": ratios},
    )
