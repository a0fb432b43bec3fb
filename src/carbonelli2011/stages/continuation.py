"""Stage: branches of n-T orbits along Λ, and their bifurcations (Figs. 8, 9 and 15, Table 1)."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball import restitution
from bouncing_ball.continuation import Branch, End, bifurcations, branch, laid_ranges
from bouncing_ball.errors import lowest_period_doublings
from bouncing_ball.orbits import Family, NoOrbit
from bouncing_ball.spring_damper import Contact, damping_ratio
from carbonelli2011.paper import PARAMETERS, printed_table
from paper_replication.datasets import grid

QUANTITIES = (
    "amplitude",
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "stable",
    "admissible",
)
"""Quantities of the orbits of a branch."""


def followed(family: Family, parameters: dict, largest_step: float) -> Branch:
    """The branch of a family; if it cannot be followed, NaN, with the reason at its ends."""
    points = parameters["points"]
    try:
        return branch(family, parameters["amplitude_max"], points, largest_step)
    except NoOrbit as error:
        absent = End("inside", str(error))
        return Branch(np.full((4, points), np.nan), [], (absent, absent))


def other_ranges(family: Family, known: Branch, amplitude_max: float) -> NDArray:
    """The stable ranges of the branch from permanent contact (`laid_ranges`), if the branch that is
    known does not end there, and if contacts may pull.
    """
    is_known = "permanent contact" in {end.kind for end in known.ends}
    if is_known or family.contact.release != "displacement":
        return np.empty((0, 2, 2))
    return laid_ranges(family, amplitude_max)


def padded(values: list, count: int, fill) -> list:
    """A list that is filled up to a length."""
    return [*values, *[fill] * (count - len(values))]


def branches(parameters: dict, release: str, largest_step: float) -> xr.Dataset:
    """The branches of one family on contacts of one or several frequency ratios.

    They have the quantities of the orbits, their multipliers, the special points, of which all
    branches get as many as the one with most, and the reasons of the ends.
    """
    ratios = np.atleast_1d(parameters["frequency_ratio"])
    zeta = float(damping_ratio(parameters["restitution"], release))
    families = [Family(parameters["n"], Contact(ratio, zeta, release)) for ratio in ratios]
    followed_branches = [followed(family, parameters, largest_step) for family in families]
    if all(np.isnan(line.orbits).all() for line in followed_branches):
        raise NoOrbit(followed_branches[0].ends[0].reason)
    count = max(len(line.special) for line in followed_branches)
    pairs = zip(families, followed_branches, strict=True)
    laid = [other_ranges(*pair, parameters["amplitude_max"]) for pair in pairs]
    laid_count = max(1, *map(len, laid))
    rows = []
    for family, line, ranges in zip(families, followed_branches, laid, strict=True):
        quantities = family.observables(line.orbits, QUANTITIES)
        multipliers = family.multipliers(line.orbits).T
        ratio = family.contact.frequency_ratio
        special = line.special
        durations = [point.orbit[3] / ratio for point in special]
        rows.append(
            quantities
            | {
                "multiplier_real": multipliers.real,
                "multiplier_imag": multipliers.imag,
                "special_kind": padded([point.kind for point in special], count, ""),
                "special_amplitude": padded([point.orbit[0] for point in special], count, np.nan),
                "special_phase": padded([point.orbit[1] for point in special], count, np.nan),
                "special_contact_duration": padded(durations, count, np.nan),
                "special_arclength": padded([point.place for point in special], count, np.nan),
                "laid_amplitude": padded([*ranges[:, 0]], laid_count, [np.nan] * 2),
                "laid_contact_duration": padded([*ranges[:, 1]], laid_count, [np.nan] * 2),
                "end_kind": [end.kind for end in line.ends],
                "end_reason": [end.reason for end in line.ends],
            }
        )
    axes = {"multiplier": ("point", "multiplier"), "special": ("special",), "end": ("end",)}
    axes["laid"] = ("laid", "range_end")
    variables: dict[str, Any] = {"damping_ratio": zeta}
    for name in rows[0]:
        inner = axes.get(name.partition("_")[0], ("point",))
        variables[name] = (("frequency_ratio", *inner), [row[name] for row in rows])
    return xr.Dataset(
        variables,
        {
            "frequency_ratio": ratios,
            "point": np.arange(parameters["points"]),
            "multiplier": [0, 1],
            "special": np.arange(count),
            "laid": np.arange(laid_count),
            "range_end": ["longest contact", "shortest contact"],
            "end": ["unstable side", "stable side"],
        },
    )


def fig15(parameters: dict, release: str, largest_step: float) -> xr.Dataset:
    """One family on one contact, and in the restitution model."""
    n = parameters["n"]
    r = parameters["restitution"]
    dataset = branches(parameters, release, largest_step)
    x = float(restitution.saddle_node(n, r))
    highest = np.sqrt(parameters["amplitude_max"] ** 2 - x**2)
    impact_height = np.linspace(-highest, highest, parameters["points"])
    doubling = float(restitution.period_doubling(n, r))
    return dataset.assign(
        restitution_amplitude=("point", np.hypot(x, impact_height)),
        restitution_phase=("point", np.arctan2(impact_height, x)),
        restitution_stable=("point", restitution.stable(r, impact_height)),
        restitution_admissible=("point", restitution.admissible(n, r, impact_height)),
        saddle_node_amplitude=x,
        saddle_node_phase=0.0,
        period_doubling_amplitude=doubling,
        period_doubling_phase=float(np.arccos(x / doubling)),
    )


def table1(parameters: dict, release: str) -> xr.Dataset:
    """Ranges of Λ with stable orbits: computed, printed, and of both maps of the restitution model.

    A printed end of a row that the paper does not have, or of another r or release, is NaN. No ball
    follows an orbit that is not admissible.
    """
    n = parameters["n"]
    r = parameters["restitution"]
    ratios = parameters["frequency_ratio"]
    paper = PARAMETERS["table1"]
    printed = printed_table().astype(float)
    printed = printed.where((r, release) == (paper["restitution"], paper["release"]))
    bounds = printed["bound"].values
    contact = Contact.of_restitution(np.array(ratios), r, release)
    ends = np.stack([bifurcations(n, kind, contact) for kind in bounds], axis=-1)
    amplitude, phase, _, angle = ends
    duration = angle / np.array(ratios)[:, np.newaxis]
    family = Family(np.array(n)[:, np.newaxis], contact)
    admissible = [family.admissible(ends[..., k]) for k in range(bounds.size)]
    fold = restitution.saddle_node(n, r)
    doublings = [restitution.period_doubling(n, r), restitution.holmes_period_doubling(n, r)]
    shape = ("n", "frequency_ratio", "bound")
    dataset = xr.Dataset(
        {
            "computed": (shape, amplitude),
            "special_phase": (shape, phase),
            "special_contact_duration": (shape, duration),
            "admissible": (shape, np.stack(admissible, axis=-1)),
            "restitution_range": (
                ("impact_map", "n", "bound"),
                [np.stack([fold, doubling], axis=-1) for doubling in doublings],
            ),
        },
        {
            "frequency_ratio": ratios,
            "n": n,
            "bound": bounds,
            "impact_map": ["exact", "holmes"],
        },
    )
    return dataset.assign(printed=printed.reindex_like(dataset["computed"])).transpose(
        "impact_map", "frequency_ratio", "n", "bound"
    )


def lowest_doubling(parameters: dict, release: str) -> xr.Dataset:
    """The ϖ at which the period doubling of each family is lowest, and its Λ there."""
    n = parameters["n"]
    ratios = grid(parameters["frequency_ratio"])
    r = parameters["restitution"]
    turns, amplitudes = lowest_period_doublings(n, r, ratios, release)
    admissible = []
    for family, turn in zip(n, turns, strict=True):
        if np.isnan(turn):
            admissible.append(False)
            continue
        contact = Contact.of_restitution(turn, r, release)
        orbit = bifurcations(family, "period doubling", contact)
        admissible.append(bool(Family(family, contact).admissible(orbit)))
    return xr.Dataset(
        {
            "period_doubling_turn": ("n", turns),
            "period_doubling_amplitude": ("n", amplitudes),
            "admissible": ("n", admissible),
        },
        {"n": n},
    )


STAGE = {
    "fig08": branches,
    "fig09": branches,
    "fig15": fig15,
    "table1": table1,
    "lowest_doubling": lowest_doubling,
}
