r"""Errors due to the time steps of physics engines, and errors of the models.

A contact that an engine resolves by N time steps has the restitution r_N of its scheme, which
depends on the fraction of a step at which the contact begins
(:mod:`bouncing_ball_contacts.engines.scheme`). The ball is therefore simulated here from event to
event with the exact contact that has this r, which changes from impact to impact. Errors of heights
are relative to the height of the engine, or of the model, as in Eq. 37.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.errors import paper_error
from bouncing_ball_beyond.accuracy.simple_models import SIMPLE, errors
from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_contacts.engines.impacts import restitution_in_steps
from bouncing_ball_contacts.engines.scheme import Scheme

# Relative tolerance, because coordinates are computed from the configuration and are rounded.
_MATCH = 1e-9
VARIABLES = {
    "engine": Variable("physics engine"),
    "engine_version": Variable("version of an engine that ran"),
    "measured_restitution": Variable(
        "restitution of an engine's free impact that is farthest from the one asked for"
    ),
    "free_steps": Variable("time steps in a contact from which on r is within the tolerance of it"),
    "contact_steps": Variable("time steps in a contact of an engine's orbit"),
    "height_error": Variable(
        "relative error of the greatest height, mean over the cycles (positive: too low)",
        budget=1e-12,
        scale="1",
    ),
    "height_scatter": Variable(
        "standard deviation of the relative errors of the greatest heights", budget=1e-12, scale="1"
    ),
    "step_scatter": Variable(
        "root mean square of the relative errors of the greatest heights, simulated with "
        "contacts at random fractions of a time step",
        budget=1e-11,
    ),
    "bounce_time": Variable(
        "processor time for a bounce over that of the simulation from event to event"
    ),
    "model_time": Variable(
        "processor time for a bounce in a model's simulation over that of the spring-damper"
    ),
    "bounce_steps": Variable("time steps of an engine in a period of an orbit"),
    "bounce_error": Variable(
        "root mean square of the relative errors of the greatest heights, in an engine",
        budget=1e-12,
        scale="1",
    ),
    "single_steps": Variable("time steps in a contact of a single bounce of an engine"),
    "single_bounce": Variable("time steps of an engine in a period of a single bounce"),
    "single_error": Variable(
        "root mean square of the relative errors of single bounces in an engine",
        budget=1e-12,
        scale="1",
    ),
    "model_error": Variable(
        "relative error of the greatest height in a model", budget=1e-12, scale="1"
    ),
    "scheme": Variable("time stepping of engines"),
    "steps": Variable("time steps in a contact", symbol="N"),
    "step_error": Variable(
        "root mean square of the relative errors of the greatest heights, simulated with the "
        "r of N steps",
        budget=1e-11,
    ),
    "steps_in_bounce": Variable("time steps in a period of the orbit"),
    "equal_steps": Variable(
        "time steps in a period of the orbit for the corrected model's error", budget=1e-09
    ),
}
RUNS_TITLE = "Orbits that physics engines ran"
SCHEMES = (Scheme.SEMI_IMPLICIT, Scheme.IMPLICIT, Scheme.COMPENSATED)
"""The time stepping of the engines that ran them, and implicit steps that are not compensated."""
TITLE = "What the time steps of physics engines cost, beside the models"


@dataclass(frozen=True)
class EngineOrbit:
    """One of the orbits that were run in the engines, and how it is simulated here in few and in
    many time steps.

    ``steps`` are those in a contact, rising and at least 8 to resolve it. ``balls`` are simulated,
    and of their impacts so many are recorded after the first ``transient`` ones.
    """

    n: int
    restitution: float
    release: Release
    steps: Sequence[int]
    balls: int
    transient: int
    impacts: int
    seed: int


def greatest_heights(orbit: Orbit, restitution: np.ndarray) -> np.ndarray:
    """Greatest heights of balls that start on orbits, with a given r at each impact.

    Parameters
    ----------
    orbit : Orbit
        Of spring-damper contacts, shape (...).
    restitution : ndarray, shape (impacts, ...)

    Returns
    -------
    ndarray, shape (impacts, ...)
        The greatest heights of the flights after the impacts.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.contact_model import ContactModel
    >>> orbit = n_t.orbit(ContactModel(SpringDamper(10.0, damping_ratio(0.85))), 1, 1.0)
    >>> tops = greatest_heights(orbit, np.full(5, 0.85))
    >>> bool(np.all(abs(tops / orbit.max_height - 1) < 1e-12))
    True
    """
    contact = orbit.law
    lam = orbit.amplitude
    phase = orbit.phase
    relative_velocity = orbit.relative_impact_velocity
    heights = []
    for zeta in damping_ratio(restitution, contact.release):
        law = SpringDamper(contact.frequency_ratio, zeta, contact.release)
        cycle = ContactModel(law).cycle(lam, phase, relative_velocity)
        phase = cycle.phase
        relative_velocity = cycle.relative_velocity
        velocity = lam * np.cos(phase) + relative_velocity
        heights.append(lam * np.sin(phase) + velocity * velocity / 2)
    return np.array(heights)


def step_errors(orbit: Orbit, parameters: EngineOrbit) -> np.ndarray:
    """Root mean square errors of the height of a bounce, shape (scheme, orbit, steps).

    Each impact begins at a random fraction of a time step; the fractions are the same in all
    simulations.
    """
    p = parameters
    zeta = float(np.ravel(orbit.law.damping_ratio)[0])
    # r over (scheme, steps, fraction of a step at which the contact begins).
    tables = np.array(
        [
            [restitution_in_steps(scheme, zeta, p.release, steps) for steps in p.steps]
            for scheme in SCHEMES
        ]
    )
    rng = np.random.default_rng(p.seed)
    impacts = p.transient + p.impacts
    fractions = rng.integers(tables.shape[-1], size=(impacts, p.balls))
    # r over (impact, scheme, 1, steps, ball), and then over all orbits.
    drawn = np.moveaxis(tables[..., fractions], 2, 0)[:, :, np.newaxis]
    drawn = np.broadcast_to(drawn, (impacts, len(SCHEMES), orbit.size, len(p.steps), p.balls))
    every = orbit[:, np.newaxis, np.newaxis]
    heights = greatest_heights(every, drawn)[p.transient :]
    error = paper_error(exact=every.max_height, simple=heights)
    return np.sqrt(np.mean(error**2, axis=(0, -1)))


def model_errors(orbit: Orbit, impacts: int) -> np.ndarray:
    """Relative errors of the height in the simple models and the simulation, shape (model, ...).

    The simulation runs from event to event; its error is the largest over ``impacts`` impacts.
    """
    of_simple = errors(orbit.law, orbit.n, orbit.amplitude, ["max_height"])[:, 0]
    restitution = np.broadcast_to(orbit.law.restitution, (impacts, *orbit.amplitude.shape))
    heights = greatest_heights(orbit, restitution)
    error = paper_error(exact=orbit.max_height, simple=heights)
    of_simulation = np.max(np.abs(error), axis=0)
    return np.array([*of_simple, of_simulation])


def steps_of(steps: np.ndarray, errors: np.ndarray, error: float) -> float:
    """The number of steps with a given error, by a power law between neighbouring errors.

    Parameters
    ----------
    steps, errors : array, shape (count,)
        Rising numbers of steps in a contact, and the errors that they cause, which fall.
    error : float
        The error that is wanted, above zero.

    Returns
    -------
    float
        Not rounded; NaN outside the range of ``errors``.

    Examples
    --------
    >>> round(steps_of(np.array([10, 100]), np.array([0.1, 0.01]), 0.02), 12)
    50.0
    """
    log_steps = np.interp(-np.log(error), -np.log(errors), np.log(steps), left=np.nan, right=np.nan)
    return float(np.exp(log_steps))


def index_of(values: xr.DataArray, name: str, wanted: Any) -> int:
    """Index of a label along a dimension; numbers match up to rounding.

    Raises
    ------
    ModelError
        If no label, or more than one, matches.

    Examples
    --------
    >>> index_of(xr.DataArray([5.0, 6.0], {"r": [0.1 + 0.2, 0.5]}), "r", 0.3)
    0
    """
    labels = values[name].values
    text = isinstance(wanted, str)
    same = labels == wanted if text else np.isclose(labels, wanted, rtol=_MATCH, atol=0)
    if np.count_nonzero(same) != 1:
        raise ModelError(f"{name} = {wanted} is not among {', '.join(map(str, labels))}")
    return int(same.argmax())


def conformance(runs: xr.Dataset, parameters: EngineOrbit) -> xr.Dataset:
    """The runs of the engines beside the models, and the part that their schemes explain.

    Parameters
    ----------
    runs : xarray.Dataset
        What the engines did, docs/data/engines.nc.
    parameters : EngineOrbit
        The orbit of which bounces are simulated over the steps in a contact.

    Returns
    -------
    xarray.Dataset
        The variables of the runs, and over their dimensions ``bounce_steps``, the time steps in a
        period, and ``bounce_error``, the root mean square error of a bounce; ``single_bounce`` are
        the time steps in a period of the ``single_error``.
        ``model_error`` is over (release, model, restitution, n, frequency_ratio), and for the
        spring-damper it is the error of its simulation. For one orbit there are ``step_error`` over
        (scheme, frequency_ratio, steps), see :func:`step_errors`, ``steps_in_bounce``, the time
        steps in a period, and ``equal_steps`` over (scheme, frequency_ratio), those of the
        corrected model's error by :func:`steps_of`.

    Raises
    ------
    ModelError
        If the dataset does not have this orbit.
    """
    along = ("restitution", "n", "frequency_ratio")
    r, n, ratio = (runs[name].values for name in along)
    place = [index_of(runs[name], name, getattr(parameters, name)) for name in along[:2]]
    shown = index_of(runs.release, "release", parameters.release)
    orbits = []
    model_error = []
    contacts_in_bounce = []
    for rule in map(Release.of, runs.release.values):
        contact = SpringDamper(ratio, damping_ratio(r[:, np.newaxis, np.newaxis], rule), rule)
        lam = runs.amplitude.sel(release=rule).transpose(*along).values
        orbit = n_t.orbit(ContactModel(contact), n[:, np.newaxis], lam)
        orbits.append(orbit)
        model_error.append(model_errors(orbit, parameters.transient + parameters.impacts))
        contacts_in_bounce.append(2 * np.pi * n[:, np.newaxis] / contact.free_duration)
    per_contact = xr.DataArray(np.array(contacts_in_bounce), dims=("release", *along))
    shown_per_contact = contacts_in_bounce[shown][*place]
    simulated = step_errors(orbits[shown][*place], parameters)
    corrected = np.abs(model_error[shown][SIMPLE.index("corrected")][*place])
    in_bounce = shown_per_contact[:, np.newaxis] * parameters.steps
    equal = [list(map(steps_of, in_bounce, of_scheme, corrected)) for of_scheme in simulated]
    found = {
        "bounce_steps": runs.contact_steps * per_contact,
        "bounce_error": np.hypot(runs.height_error, runs.height_scatter),
        "single_bounce": runs.single_steps
        * xr.DataArray(shown_per_contact, dims="frequency_ratio"),
        "model_error": (("release", "model", *along), np.array(model_error)),
        "step_error": (("scheme", "frequency_ratio", "steps"), simulated),
        "steps_in_bounce": (("frequency_ratio", "steps"), in_bounce),
        "equal_steps": (("scheme", "frequency_ratio"), equal),
    }
    axes = {"model": [*SIMPLE, "spring-damper"], "scheme": [*SCHEMES], "steps": [*parameters.steps]}
    return describe(
        runs.assign_coords(axes).assign(found).drop_attrs(deep=False), variables=VARIABLES
    )
