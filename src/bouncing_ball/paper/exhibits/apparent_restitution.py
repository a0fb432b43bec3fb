"""Stable n-T orbits of the spring-damper model along ϖ (Figs. 5, 6, 10, 13)."""

from typing import Annotated

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from pydantic import AfterValidator, ValidationInfo

from bouncing_ball.datasets.parameters import Amplitude, Family, Many, Parameters, Restitution, Span
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.models.damping import Release
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.orbit_parameters import (
    OrbitAmplitude,
    require_amplitude,
    require_any_orbit,
)
from bouncing_ball.periodic.branches import OBSERVED
from bouncing_ball.periodic.explicit import explicit_branch

VARIABLES = {
    "labelled": Variable("whether the figure marks this frequency ratio"),
    "restitution_bounce_velocity": Variable(
        "bouncing-off velocity, restitution model", symbol="nπ", equation="Eq. 6"
    ),
    "restitution_impact_velocity": Variable(
        "velocity before impact, restitution model", symbol="-nπ", equation="Eq. 3"
    ),
}
# Relative distance below which two frequency ratios differ only by the rounding of a grid.
_ROUNDING = 1e-12


class Case(Parameters):
    """One curve: a contact's restitution coefficient and the amplitude of the table."""

    restitution: Restitution
    amplitude: Amplitude


def _has_orbit(case: Case, info: ValidationInfo) -> Case:
    if "n" in info.data:
        require_amplitude(case.amplitude, info.data["n"], case.restitution)
    return case


class Cases(Parameters):
    """Several pairs of r and Λ, whose n-T orbits are followed along ϖ."""

    n: Family
    cases: Many[Annotated[Case, AfterValidator(_has_orbit)]]
    frequency_ratio: Span


class Sweep(Parameters):
    """One r and several Λ, whose n-T orbits are followed along ϖ."""

    n: Family
    restitution: Restitution
    amplitude: Many[OrbitAmplitude]
    frequency_ratio: Span


def with_round_values(ratios: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A grid of ϖ with 2, 5 and the decades of its range added, and a mask of these round values.

    A sample that equals a round value up to rounding is replaced by this value.

    Parameters
    ----------
    ratios : ndarray, shape (samples,)
        Increasing.

    Returns
    -------
    ratios, labelled : ndarray
        The merged grid, increasing, and a mask that is True at the round values.

    Examples
    --------
    >>> ratios, labelled = with_round_values(np.array([1.0, 4.0, 10.0 + 1e-14]))
    >>> ratios.tolist(), labelled.tolist()
    ([1.0, 2.0, 4.0, 5.0, 10.0], [True, True, False, True, True])
    """
    values = np.array([0.1, 1.0, 2.0, 5.0, *10.0 ** np.arange(1, 7)])
    low = ratios[0] * (1 - _ROUNDING)
    high = ratios[-1] * (1 + _ROUNDING)
    shown = values[(values >= low) & (values <= high)]
    same = np.abs(ratios[:, np.newaxis] / shown - 1) <= _ROUNDING
    merged = np.union1d(ratios[~same.any(axis=1)], shown)
    return merged, np.isin(merged, shown)


def _sweep(
    shown: str,
    n: int,
    restitution: ArrayLike,
    amplitude: ArrayLike,
    ratios: np.ndarray,
    release: Release,
) -> xr.Dataset:
    """Orbits on the stable side, shape (case, ϖ); NaN where there is none.

    The variable that the figure shows comes first, and each case is named by its r and Λ, so that
    xarray draws the figure without further arguments.

    Raises
    ------
    NoOrbitError
        If there is no orbit at all.
    """
    r, lam = np.broadcast_arrays(restitution, amplitude)
    contacts = SpringDamper.from_restitution(r[:, np.newaxis], ratios, release)
    orbits = explicit_branch(contacts).orbit(n, lam[:, np.newaxis])
    require_any_orbit(orbits.exists, n, lam, ratios)
    dims = ("case", "frequency_ratio")
    others = [*OBSERVED, "max_height", "stable", "admissible"]
    others.remove(shown)
    return xr.Dataset(
        {name: (dims, getattr(orbits, name)) for name in (shown, *others)},
        coords={
            "case": [f"r = {one:g}, Λ = {other:g}" for one, other in zip(r, lam, strict=True)],
            "frequency_ratio": ratios,
            "restitution": ("case", r),
            "amplitude": ("case", lam),
        },
    )


def apparent_restitution(parameters: Cases, release: Release) -> xr.Dataset:
    """Orbits along ϖ for cases of (r, Λ), of which Figs. 5 and 6 show r_a (Eq. 17).

    The dataset has ``apparent_restitution``, the other observables of the stable orbit,
    ``max_height``, ``stable`` and ``admissible``, shape (case, ϖ), NaN where there is no orbit;
    and the coordinates ``case``, such as "r = 0.85, Λ = 1", ``restitution`` and ``amplitude``,
    shape (case,). Phases are in rad.

    Raises
    ------
    NoOrbitError
        If there is no orbit in any case and at any ϖ.
    """
    restitution = [case.restitution for case in parameters.cases]
    amplitude = [case.amplitude for case in parameters.cases]
    ratios = parameters.frequency_ratio.grid()
    shown = "apparent_restitution"
    dataset = _sweep(shown, parameters.n, restitution, amplitude, ratios, release)
    return describe(dataset, variables=VARIABLES)


def frequency_sweep(parameters: Sweep, release: Release) -> xr.Dataset:
    """Orbits along ϖ for one r and several Λ, and their limits in the restitution model (Fig. 10).

    The dataset has the variables of :func:`apparent_restitution`; ``restitution_phase`` (case,) in
    rad, and the numbers ``restitution_bounce_velocity`` = nπ and ``restitution_impact_velocity``.

    Raises
    ------
    NoOrbitError
        If there is no orbit in any case and at any ϖ.
    """
    ratios = parameters.frequency_ratio.grid()
    dataset = _with_limits("bounce_velocity", parameters, ratios, release)
    return describe(dataset, variables=VARIABLES)


def _with_limits(shown: str, parameters: Sweep, ratios: np.ndarray, release: Release) -> xr.Dataset:
    """Orbits along ϖ, and the phase and velocities to which they tend (Eq. 6)."""
    n = parameters.n
    r = parameters.restitution
    lam = np.array(parameters.amplitude)
    return _sweep(shown, n, r, lam, ratios, release).assign(
        restitution_phase=("case", explicit_branch(RestitutionModel(r)).orbit(n, lam).phase),
        restitution_bounce_velocity=n * np.pi,
        restitution_impact_velocity=-n * np.pi,
    )


def poincare_map(parameters: Sweep, release: Release) -> xr.Dataset:
    """Orbits along ϖ that includes round values, which are labelled in Fig. 13.

    The dataset has the variables of :func:`frequency_sweep`, and ``labelled`` (ϖ,), a mask.

    Raises
    ------
    NoOrbitError
        If there is no orbit in any case and at any ϖ.
    """
    ratios, labelled = with_round_values(parameters.frequency_ratio.grid())
    dataset = _with_limits("phase", parameters, ratios, release)
    return describe(dataset.assign(labelled=("frequency_ratio", labelled)), variables=VARIABLES)
