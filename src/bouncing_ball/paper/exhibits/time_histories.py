"""Time histories of orbits of the spring-damper model (Figs. 7 and 12)."""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Many, Samples
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import Release
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.orbit_parameters import ContactRatio, OrbitParameters
from bouncing_ball.periodic.explicit import required_orbit
from bouncing_ball.periodic.orbit import Orbit, contact_path, flight_path, path

VARIABLES = {
    "table_phase": Variable("phase of the table, whose height is Λ sin τ", symbol="τ", units="rad"),
    "restitution_ball": Variable(
        "height of the ball, restitution model", symbol="z_CR", equation="Eq. 4"
    ),
}
# Quantities of each orbit in the datasets.
_STATE = ("phase", "contact_duration", "impact_velocity", "bounce_velocity")
# Phases of some radians differ by less if they are the same up to rounding.
_ROUNDING = 1e-13
_CURVES = ("frequency_ratio", "table_phase")


class ContactHistory(OrbitParameters):
    """One cycle of one orbit on one contact."""

    frequency_ratio: ContactRatio
    samples: Samples


class Histories(OrbitParameters):
    """One cycle of one orbit on several contacts."""

    frequency_ratio: Many[ContactRatio]
    samples: Samples


def _orbit(parameters: OrbitParameters, ratio: float, release: Release) -> Orbit:
    """The orbit on one contact.

    Raises
    ------
    NoOrbitError
        If there is none, or if it is inadmissible.
    """
    contact = SpringDamper.from_restitution(parameters.restitution, ratio, release)
    orbit = required_orbit(contact, parameters.n, parameters.amplitude)
    if not orbit.admissible:
        raise NoOrbitError(
            f"the {parameters.n}-T orbit at Λ = {parameters.amplitude:g} for {contact.label} is "
            "inadmissible: an earlier impact or release occurs"
        )
    return orbit


def contact_history(parameters: ContactHistory, release: Release) -> xr.Dataset:
    """One cycle of the spring-damper model from the start of contact (Fig. 7).

    Half of the samples are in the contact, because it may last a hundredth of the cycle and must
    still be resolved. The dataset has ``ball``, ``ball_velocity``, ``table`` and ``contact``, a
    mask, of shape (time,), and the numbers ``frequency_ratio``, ``phase`` in rad,
    ``contact_duration``, ``impact_velocity`` and ``bounce_velocity``.

    Raises
    ------
    NoOrbitError
        If the orbit does not exist or is inadmissible.
    """
    orbit = _orbit(parameters, parameters.frequency_ratio, release)
    half = parameters.samples // 2
    during = np.linspace(0.0, orbit.contact_duration, half)
    flight = np.linspace(
        orbit.contact_duration, 2 * np.pi * parameters.n, parameters.samples - half + 1
    )
    # The end of the contact is its last sample.
    after = flight[1:]
    ball, velocity = np.hstack([contact_path(orbit, during), flight_path(orbit, after)])
    time = np.concatenate([during, after])
    return described(
        {
            "ball": ("time", ball),
            "ball_velocity": ("time", velocity),
            "table": ("time", parameters.amplitude * np.sin(time + orbit.phase)),
            "contact": ("time", np.arange(parameters.samples) < half),
            "frequency_ratio": parameters.frequency_ratio,
            **{name: float(getattr(orbit, name)) for name in _STATE},
        },
        coords={"time": time},
        variables=VARIABLES,
    )


def both_histories(parameters: Histories, release: Release) -> xr.Dataset:
    """One cycle of both models against the phase of the table (Fig. 12).

    All curves have the same samples: as many as given, at equal steps of the table's phase, and the
    starts and ends of all contacts, where the curves have their corners. The dataset has ``ball``
    and ``contact``, a mask, (ϖ, table_phase); ``restitution_ball`` and ``table`` (table_phase,);
    ``phase``, ``contact_duration``, ``impact_velocity`` and ``bounce_velocity`` (ϖ,); and the
    number ``restitution_phase``. Phases are in rad.

    Raises
    ------
    NoOrbitError
        If an orbit does not exist or is inadmissible.
    """
    n = parameters.n
    lam = parameters.amplitude
    period = 2 * np.pi * n
    ratios = sorted(parameters.frequency_ratio)
    orbits = [_orbit(parameters, ratio, release) for ratio in ratios]
    rigid = required_orbit(RestitutionModel(parameters.restitution), n, lam)
    corners = [rigid.phase, *(x for one in orbits for x in (one.phase, one.release_phase))]
    phase = np.union1d(np.linspace(0.0, period, parameters.samples), np.mod(corners, period))
    # The start of a contact is at the time 0 and not, by rounding, at the end of the cycle.
    since = [np.mod(phase - one.phase + _ROUNDING, period) - _ROUNDING for one in orbits]
    pairs = zip(orbits, since, strict=True)
    touching = [time <= one.contact_duration + _ROUNDING for one, time in pairs]
    return described(
        {
            "ball": (_CURVES, [path(*pair)[0] for pair in zip(orbits, since, strict=True)]),
            "contact": (_CURVES, touching),
            "restitution_ball": ("table_phase", path(rigid, phase - rigid.phase)[0]),
            "table": ("table_phase", lam * np.sin(phase)),
            "restitution_phase": ((), float(rigid.phase)),
            **{name: ("frequency_ratio", [getattr(x, name) for x in orbits]) for name in _STATE},
        },
        coords={"frequency_ratio": ratios, "table_phase": phase},
        variables=VARIABLES,
    )
