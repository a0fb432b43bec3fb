"""Time histories of orbits of the spring-damper model (Figs. 7 and 12)."""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import FrequencyRatio, Many, Samples
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.paper.exhibits.orbit_parameters import OrbitParameters
from bouncing_ball.periodic import n_t

VARIABLES = {
    "table_phase": Variable("phase of the table", symbol="τ + φ", units="rad"),
    "restitution_ball": Variable(
        "height of the ball, restitution model", symbol="z_CR", equation="Eq. 4"
    ),
}
# Quantities of each orbit in the datasets.
_STATE = ("phase", "contact_duration", "impact_velocity", "bounce_velocity")


class ContactHistory(OrbitParameters):
    """One cycle of one orbit on one contact."""

    frequency_ratio: FrequencyRatio
    samples: Samples


class Histories(OrbitParameters):
    """One cycle of one orbit on several contacts."""

    frequency_ratio: Many[FrequencyRatio]
    samples: Samples


def _cycle(parameters: ContactHistory | Histories, ratio: float, release: Release) -> xr.Dataset:
    """One cycle on one contact: the contact, then the flight.

    Half the samples fall in either part, and τ_b is a sample in both, because the
    contact may last a hundredth of the cycle and must still be resolved.
    """
    n = parameters.n
    lam = parameters.amplitude
    half = parameters.samples // 2
    contact = SpringDamper.from_restitution(parameters.restitution, ratio, release)
    orbit = n_t.require_admissible(SpringDamperModel(contact), n, lam)
    during = np.linspace(0.0, orbit.contact_duration, half)
    after = np.linspace(orbit.contact_duration, 2 * np.pi * n, parameters.samples - half)
    ball, velocity = np.hstack([orbit.contact_path(during), orbit.flight_path(after)])
    phase = np.concatenate([during, after]) + orbit.phase
    return xr.Dataset(
        {
            "time": ("sample", np.concatenate([during, after])),
            "ball": ("sample", ball),
            "ball_velocity": ("sample", velocity),
            "table": ("sample", lam * np.sin(phase)),
            "table_phase": ("sample", phase),
            "contact": ("sample", np.arange(parameters.samples) < half),
            "frequency_ratio": ratio,
            **{name: float(getattr(orbit, name)) for name in _STATE},
        }
    )


def contact_history(parameters: ContactHistory, release: Release) -> xr.Dataset:
    """One cycle of the spring-damper model from the start of contact (Fig. 7).

    The dataset has ``time``, ``ball``, ``ball_velocity``, ``table`` and ``contact``, a mask, of
    shape (sample,), and the numbers ``frequency_ratio``, ``phase`` in rad, ``contact_duration``,
    ``impact_velocity`` and ``bounce_velocity``.

    Raises
    ------
    NoOrbitError
        If the orbit does not exist or is inadmissible.
    """
    cycle = _cycle(parameters, parameters.frequency_ratio, release)
    return describe(cycle.drop_vars("table_phase"), variables=VARIABLES)


def both_histories(parameters: Histories, release: Release) -> xr.Dataset:
    """One cycle of both models against the phase of the table (Fig. 12).

    The dataset has ``table_phase`` in rad, ``ball`` and ``contact``, a mask, (ϖ, sample);
    ``phase``, ``contact_duration``, ``impact_velocity`` and ``bounce_velocity`` (ϖ,); and for the
    restitution model ``time`` and ``restitution_ball`` (sample,) and the number
    ``restitution_phase`` in rad.

    Raises
    ------
    NoOrbitError
        If an orbit does not exist or is inadmissible.
    """
    cycles = [_cycle(parameters, ratio, release) for ratio in sorted(parameters.frequency_ratio)]
    dataset = xr.concat([x.set_coords("frequency_ratio") for x in cycles], "frequency_ratio")
    n = parameters.n
    lam = parameters.amplitude
    rigid = n_t.require_orbit(RestitutionModel(parameters.restitution), n, lam)
    time = np.linspace(0.0, 2 * np.pi * n, parameters.samples)
    height, _ = rigid.path(time)
    return describe(
        dataset[["table_phase", "ball", "contact", *_STATE]].assign(
            restitution_ball=("sample", height),
            time=("sample", time),
            restitution_phase=float(rigid.phase),
        ),
        variables=VARIABLES,
    )
