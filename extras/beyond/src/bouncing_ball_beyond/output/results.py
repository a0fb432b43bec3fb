"""Convert orbits, branches and curves to labelled datasets."""

import numpy as np
import xarray as xr

from bouncing_ball_beyond.periodic.branches import FollowedBranch, SpecialCurve
from bouncing_ball_beyond.periodic.equations import PeriodicOrbit

OF_IMPACTS = {
    "phase": ("phase of the table as an impact starts", "φ", "rad"),
    "contact_duration": ("duration of the contact", "D", "1"),
    "flight_time": ("duration of the flight after the contact", "", "1"),
    "impact_velocity": ("velocity of the ball as an impact starts", "", "1"),
    "bounce_velocity": ("velocity of the ball as the contact ends", "", "1"),
    "relative_impact_velocity": ("relative velocity as an impact starts", "δ′", "1"),
    "relative_bounce_velocity": ("relative velocity as the contact ends", "δ′", "1"),
    "apparent_restitution": ("apparent restitution coefficient", "rₐ", "1"),
}
"""Quantities of the impacts: long name, symbol and unit."""

OF_ORBITS = {
    "max_height": ("greatest height of the ball", "", "1"),
    "periods": ("periods of the table in one period of the orbit", "m", "1"),
    "stable": ("whether neighbouring motions stay near", "", "1"),
    "admissible": ("whether a ball follows the orbit", "", "1"),
    "kind": ("kind of a special orbit, and empty for others", "", "1"),
}
"""Quantities of whole orbits."""

OF_EQUATIONS = {
    "multiplier_real": ("real part of the Floquet multiplier", "μ", "1"),
    "multiplier_imag": ("imag part of the Floquet multiplier", "μ", "1"),
    "impact_time": ("time of the impact", "τ", "1"),
    "scaled_duration": ("duration of the contact in the time of its equations", "T", "1"),
}
"""Unknowns and multipliers."""

PARAMETERS = {
    "amplitude": ("amplitude of the table", "Λ", "1"),
    "restitution": ("restitution coefficient", "r", "1"),
    "frequency_ratio": ("frequency ratio", "ϖ", "1"),
    "damping_ratio": ("damping ratio", "ζ", "1"),
    "frequency": ("frequency of a table with a fixed stroke", "Ω/√(g/a)", "1"),
}
"""Parameters. The long name of a parameter of a law is its name."""


def to_dataset(orbit_or_branch: PeriodicOrbit | FollowedBranch) -> xr.Dataset:
    """Convert an orbit, a branch or a curve to a labelled dataset.

    Parameters
    ----------
    orbit_or_branch : PeriodicOrbit, FollowedBranch or SpecialCurve

    Returns
    -------
    xarray.Dataset
        One row per orbit along ``point``. Quantities of impacts also have the axis ``impact``.
        Special orbits are between their neighbours on the branch, and have a ``kind``. Parameters
        are variables. The attributes of the dataset contain the ball and the table of the first
        orbit.

    Raises
    ------
    ValueError
        If ``orbit_or_branch`` is something else, such as a list of branches.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> data = to_dataset(orbit(Rigid(0.5), amplitude=1.4))
    >>> round(data.impact_velocity.item(), 6), dict(data.sizes)
    (-3.141593, {'point': 1, 'impact': 1, 'multiplier': 2})
    """
    if not isinstance(orbit_or_branch, PeriodicOrbit | FollowedBranch):
        raise ValueError(
            "a dataset stores one orbit or branch: write"
            " [to_dataset(branch) for branch in branches]"
        )
    orbits = (
        [orbit_or_branch]
        if isinstance(orbit_or_branch, PeriodicOrbit)
        else orbit_or_branch.with_special()
    )
    first = orbits[0]
    along = [path.name for path in first.equations.along]
    of_impacts = {
        name: [np.atleast_1d(getattr(orbit, name)) for orbit in orbits] for name in OF_IMPACTS
    }
    of_impacts["impact_time"] = [orbit.times for orbit in orbits]
    T = [orbit.scaled_durations for orbit in orbits]
    if np.size(T):
        of_impacts["scaled_duration"] = T
    of_orbits = {name: [getattr(orbit, name) for orbit in orbits] for name in OF_ORBITS}
    of_orbits |= {name: [orbit.parameters[name] for orbit in orbits] for name in first.parameters}
    multipliers = np.array([orbit.multipliers for orbit in orbits])
    data = xr.Dataset(
        {
            **{name: (("point", "impact"), values) for name, values in of_impacts.items()},
            **{name: ("point", values) for name, values in of_orbits.items()},
            "multiplier_real": (("point", "multiplier"), multipliers.real),
            "multiplier_imag": (("point", "multiplier"), multipliers.imag),
        },
        attrs={
            "source": "bouncing_ball_beyond",
            "impacts": first.impacts,
            "ball": repr(first.ball),
            "table": repr(first.table),
        },
    )
    if isinstance(orbit_or_branch, FollowedBranch):
        data.attrs |= {"start": orbit_or_branch.start, "end": orbit_or_branch.end}
    if isinstance(orbit_or_branch, SpecialCurve):
        data.attrs["kind"] = orbit_or_branch.kind
    texts = OF_IMPACTS | OF_ORBITS | OF_EQUATIONS | PARAMETERS
    for label, variable in data.items():
        text = texts.get(str(label), (str(label).replace("_", " "), "", "1"))
        variable.attrs.update(zip(("long_name", "symbol", "units"), text, strict=True))
    return data.set_coords(along)
