"""The orbits into which permanent contact continues: their cascade of flights and their basins."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.rattling import openings, stiff_openings
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.basins import ELSEWHERE, Destinations, destinations
from bouncing_ball.orbits.long_contact import joining_ratio
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import (
    Family,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    Span,
    number,
)
from bouncing_ball.studies.parameters import OrbitAmplitude


class Flights(Parameters):
    """Contacts of several r along ϖ, and the number of openings of their orbits."""

    restitution: Many[LossyRestitution]
    frequency_ratio: Span
    flights: Annotated[int, number("openings that are followed", ge=2, le=6)]


class Basins(Parameters):
    """Starts on one contact at several amplitudes."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: FrequencyRatio
    amplitude: Many[OrbitAmplitude]
    velocity_max: Annotated[
        float, number("largest relative speed of impact at the start", ge=0.1, le=100)
    ]
    starts: Annotated[int, number("starts along each axis, at middles of cells", ge=10, le=1000)]
    impacts: Annotated[
        int,
        number(
            "impacts after which a ball is given up, before rounding decides where it goes",
            ge=10,
            le=200,
        ),
    ]


# Range of ϖ in which the families of short and long contacts separate, for all r ≥ 0.3.
_PARTING = (1.9, 4.0)

MOTIONS = (
    "permanent contact",
    "1-T, short contact",
    "1-T, long contact",
    "n-T, n > 1",
    "none of these",
)
"""The motions on which a ball may end; a long contact lasts more than half a table period."""

# Balls on none of these motions of which the period is determined.
_ASKED = 100


def cascade_of_flights(parameters: Flights, release: Release) -> xr.Dataset:
    """The amplitudes at which the T-periodic orbit above Λ_SD has one flight more per period.

    The dataset has ``threshold_amplitude`` Λ_SD (restitution, ϖ); ``opening_amplitude`` and
    ``opening_multiplier`` (restitution, flights, ϖ), the Λ up to which the orbit has so many
    flights and the larger modulus of its multipliers there, NaN where no stable one was found;
    ``stiff_opening`` (restitution, flights), the limit of E = ϖ²(Λ - Λ_SD) for stiff contacts; and
    ``joining_ratio`` (restitution,), the ϖ below which the orbits with a short and a long contact
    are one family. All but the first are NaN unless the release is the displacement's.
    """
    restitution, ratio = np.array(parameters.restitution), parameters.frequency_ratio.grid()
    zeta, most = damping_ratio(restitution), parameters.flights
    law = SpringDamper(ratio, zeta[:, np.newaxis], release)
    found, stiff = (
        np.full((2, zeta.size, most, ratio.size), np.nan),
        np.full((zeta.size, most), np.nan),
    )
    joining = np.full(zeta.shape, np.nan)
    if release is Release.DISPLACEMENT:
        found = np.array(openings(zeta, ratio, most))
        found = np.where(found[1] < 1, found, np.nan)
        stiff = np.stack([stiff_openings(z, most) for z in zeta])
        joining = joining_ratio(zeta, release, *_PARTING)
    dims = ("restitution", "flights", "frequency_ratio")
    held = SpringDamperModel(law).permanent_contact_threshold()
    return described(
        {
            "threshold_amplitude": (("restitution", "frequency_ratio"), held),
            "opening_amplitude": (dims, found[0]),
            "opening_multiplier": (dims, found[1]),
            "stiff_opening": (dims[:2], stiff),
            "joining_ratio": ("restitution", joining),
        },
        coords={
            "restitution": restitution,
            "flights": np.arange(1, most + 1),
            "frequency_ratio": ratio,
        },
    )


def _shared_period(model: SpringDamperModel, amplitude: float, ends: Destinations) -> int:
    """Number of impacts after which most motions on no n-T orbit repeat; 0 if there is none."""
    # A ball whose last recorded state is rising, after a release below the table's level, has no
    # impact to start from.
    left = np.flatnonzero((ends.orbit == ELSEWHERE) & (ends.velocity < 0))
    asked = left[:: max(1, left.size // _ASKED)]
    if not asked.size:
        return 0
    phase = ends.phase[asked]
    velocity = ends.velocity[asked] + amplitude * np.cos(phase)
    periods = label(model.impact_law, amplitude, phase, velocity).impacts
    # Some of these balls approach an n-T orbit slowly; their motion repeats after one impact.
    values, counts = np.unique(periods, return_counts=True)
    most = int(values[counts.argmax()])
    return most if most > 1 and counts.max() > asked.size / 2 else 0


def basins(parameters: Basins, release: Release) -> xr.Dataset:
    """Where balls end that start with an impact at (φ, δ′), for one contact and several Λ.

    The dataset has ``destination`` (case, start_speed, start_phase), an index into :data:`MOTIONS`,
    with φ in rad and the speed -δ′ at the middles of cells; ``basin_share`` (case, motion), the
    shares of the starts; ``orbit_phase`` in rad and ``orbit_speed`` (case, motion), the places (φ,
    -δ′) of the stable 1-T orbits, NaN where there is none; ``amplitude`` and ``other_period``, in
    impacts, of shape (case,).
    """
    r, ratio = parameters.restitution, parameters.frequency_ratio
    model = SpringDamperModel(SpringDamper.from_restitution(r, ratio, release))
    count, amplitudes = parameters.starts, parameters.amplitude
    middle = (np.arange(count) + 0.5) / count
    phase, speed = 2 * np.pi * middle - np.pi, parameters.velocity_max * middle
    shape = (len(amplitudes), count, count)
    ends, periods = np.empty(shape, dtype=np.int8), np.zeros(len(amplitudes), dtype=int)
    places = np.full((2, len(amplitudes), len(MOTIONS)), np.nan)
    start, velocity = (np.ravel(x) for x in np.meshgrid(phase, -speed))
    for k, lam in enumerate(amplitudes):
        all_orbits = [model.orbits(n, lam) for n in parameters.n]
        stable = [found[found.is_stable() & found.is_admissible()] for found in all_orbits]
        orbits = [found[k] for found in stable for k in range(found.size)]
        kinds = [3 if x.n > 1 else 1 + int(x.contact_duration > np.pi) for x in orbits]
        for orbit, kind in zip(orbits, kinds, strict=True):
            if orbit.n == 1:
                places[:, k, kind] = orbit.phase, -orbit.relative_impact_velocity
        reached = destinations(model, lam, orbits, start, velocity, parameters.impacts)
        # Indices from the end, ELSEWHERE and PERMANENT, are those of no orbit.
        kind_of = np.array([*kinds, len(MOTIONS) - 1, 0], dtype=np.int8)
        ends[k] = kind_of[reached.orbit].reshape(count, count)
        periods[k] = _shared_period(model, lam, reached)
    shares = [(ends == kind).mean(axis=(1, 2)) for kind in range(len(MOTIONS))]
    return described(
        {
            "amplitude": ("case", np.array(amplitudes)),
            "destination": (("case", "start_speed", "start_phase"), ends),
            "basin_share": (("case", "motion"), np.stack(shares, axis=-1)),
            "orbit_phase": (("case", "motion"), places[0]),
            "orbit_speed": (("case", "motion"), places[1]),
            "other_period": ("case", periods),
        },
        coords={"motion": list(MOTIONS), "start_phase": phase, "start_speed": speed},
    )
