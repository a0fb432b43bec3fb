"""Random orbits with all their quantities, and motions of balls, as references for other programs.

The page of the explorer computes them again in the reader's browser.
"""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.simple_models import exact_and_simple_models
from bouncing_ball_beyond.exhibits import corrected_model
from bouncing_ball_beyond.exhibits.random_orbits import random_orbits
from bouncing_ball_beyond.inherited.datasets.parameters import Parameters, Seed, Span
from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release, restitution_coefficient
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions import grids
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.motion import contact_motion, contact_path

VARIABLES = {
    "end_speed": Variable("speed of the ball towards the table at that impact", symbol="-δ′"),
    "trace": Variable("trace of the monodromy", symbol="tr"),
    "determinant": Variable("determinant of the monodromy", symbol="det"),
    "restitution_trace": Variable("trace of the monodromy, restitution model", symbol="tr"),
    "restitution_period_doubling": Variable(
        "amplitude of the period doubling, restitution model", symbol="Λ_PD"
    ),
    "corrected_phase": Variable("phase of impact, corrected model", symbol="φ", units="rad"),
    "corrected_trace": Variable("trace of the monodromy, corrected model", symbol="tr"),
    "corrected_saddle_node": Variable(
        "amplitude of the saddle-node, corrected model", symbol="Λ_SN"
    ),
    "corrected_period_doubling": Variable(
        "amplitude of the period doubling, corrected model", symbol="Λ_PD"
    ),
    "corrected_max_height": Variable("greatest height, corrected model", symbol="max z"),
    "velocity": Variable("velocity of the ball before the first impact", symbol="z′_i"),
    "end_impact": Variable("number of that impact, from 0"),
    "end_time": Variable(
        "time of that impact since the first one, or of the rest that follows it", symbol="τ"
    ),
    "ball_restitution": Variable("restitution coefficient of a ball that is followed", symbol="r"),
    "ball_frequency_ratio": Variable(
        "frequency ratio of the contact of a ball that is followed", symbol="ϖ"
    ),
    "ball_amplitude": Variable("amplitude of the table of a ball that is followed", symbol="Λ"),
}
# Part of the restitution model's stable range, from near its saddle-node (0) to beyond its
# period doubling (1).
_PLACES = (0.02, 1.2)
# Balls that end at rest, on an orbit, on a period-doubled orbit, and on a locked orbit. None is
# near chaos, where the results of two computers differ.
_GIVEN = ("ball_restitution", "ball_frequency_ratio", "ball_amplitude", "start_phase", "velocity")
_BALLS = np.broadcast_arrays(0.5, 80.0, [0.6, 1.2, 1.6, 2.5], 1.0, -3.0)


class References(Parameters):
    """Frequency ratios, for each of which one contact and one orbit are drawn at random."""

    frequency_ratio: Span
    seed: Seed


def reference_orbits(parameters: References) -> xr.Dataset:
    """One random orbit for each ϖ of a grid, under each release rule.

    All variables have the shape (release, sample): the contact and the orbit (``n``,
    ``restitution`` by Eq. 16, ``frequency_ratio``, ``amplitude``), its observables with the phase
    in rad, ``trace`` and ``determinant`` of the monodromy, its bifurcations, ``ball`` and
    ``contact_force`` in the middle of the contact, and values of both simple models
    (``restitution_…``, ``corrected_…``). NaN where there is no orbit or no bifurcation.

    The balls have the shape (model, motion): how they start (``ball_…``, ``start_phase``,
    ``velocity``), the ``periods`` and ``impacts`` until they repeat, and number, phase, speed and
    time of their impact number 100, or of the last one before they rest (``end_…``); the sum of
    infinitely many impacts is included in the time.
    """
    omega = parameters.frequency_ratio.grid()
    parts = [_under(rule, omega, parameters.seed + k) for k, rule in enumerate(LINEAR)]
    orbits = xr.concat(parts, dim="release").assign_coords(release=[str(rule) for rule in LINEAR])
    known = corrected_model.VARIABLES | grids.VARIABLES | VARIABLES
    return describe(orbits.merge(_motions()), variables=known)


def _motions() -> xr.Dataset:
    """The balls, and the motions on which they end, over (model, motion)."""
    r, omega, lam, phase, velocity = _BALLS
    restitution = RestitutionModel(r)
    contact = SpringDamper.from_restitution(r, omega, Release.DISPLACEMENT)
    spring_damper = ContactModel(contact)
    given = {name: ("motion", values) for name, values in zip(_GIVEN, _BALLS, strict=True)}
    start = xr.Dataset(given)
    of_models = [
        xr.Dataset({name: ("motion", values.astype(float)) for name, values in ends.items()})
        for ends in (_ends(model, lam, phase, velocity) for model in (restitution, spring_damper))
    ]
    models = xr.Variable("model", ["restitution", "spring-damper"])
    return start.merge(xr.concat(of_models, models))


def _ends(model: Model, lam: np.ndarray, phase: np.ndarray, velocity: np.ndarray) -> dict[str, Any]:
    """The motions of balls, and their states at the last of 100 impacts or before they rest."""
    found = final_motions(model, lam, phase, velocity)
    run = model.simulate(lam, phase, velocity, 100)
    last = run.impacts - 1
    at_last = last, np.arange(last.size)
    return {
        "periods": found.periods,
        "impacts": found.impacts,
        "end_impact": last,
        "end_phase": run.phase[at_last],
        "end_speed": -run.relative_velocity[at_last],
        "end_time": (run.time + run.settling)[at_last],
    }


def _under(rule: Release, omega: np.ndarray, seed: int) -> xr.Dataset:
    """One random orbit for each ϖ under a release rule, over ``sample``."""
    n, zeta, lam, _ = random_orbits(omega.size, seed, rule, _PLACES)
    r = restitution_coefficient(zeta)
    exact, simple, corrected = exact_and_simple_models(
        SpringDamper.from_restitution(r, omega, rule)
    )
    orbit = n_t.orbit(exact, n, lam)
    trace, determinant = orbit.trace_and_determinant()
    simple_orbit = n_t.orbit(simple, n, lam)
    simple_trace, _ = simple_orbit.trace_and_determinant()
    corrected_orbit = n_t.orbit(corrected, n, lam)
    corrected_trace, _ = corrected_orbit.trace_and_determinant()
    middle = orbit.contact_duration / 2
    values = {
        "n": n,
        "restitution": r,
        "frequency_ratio": omega,
        "amplitude": lam,
        **{name: getattr(orbit, name) for name in OBSERVABLES[1:]},
        "trace": trace,
        "determinant": determinant,
        "saddle_node_amplitude": n_t.saddle_node(exact, n).amplitude,
        "period_doubling_amplitude": n_t.period_doubling(exact, n).amplitude,
        "ball": contact_path(orbit, middle)[0],
        "contact_force": exact.law.force(*-np.array(contact_motion(orbit, middle))),
        "restitution_phase": simple_orbit.phase,
        "restitution_trace": simple_trace,
        "restitution_period_doubling": n_t.period_doubling(simple, n).amplitude,
        "corrected_phase": corrected_orbit.phase,
        "corrected_max_height": corrected_orbit.max_height,
        "corrected_trace": corrected_trace,
        "corrected_saddle_node": n_t.saddle_node(corrected, n).amplitude,
        "corrected_period_doubling": n_t.period_doubling(corrected, n).amplitude,
    }
    return xr.Dataset({name: ("sample", np.asarray(value)) for name, value in values.items()})
