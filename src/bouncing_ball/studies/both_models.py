"""Branches and stability ranges beside those of the restitution model (Fig. 15, Table 1)."""

import numpy as np
import xarray as xr

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.continuation.branch import Branch, ContinuationError
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.columns import PLACE, columns, whole_branch
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.parameters import FrequencyRatio
from bouncing_ball.studies.orbit_branches import (
    Branches,
    Continuation,
    Domains,
    Ranges,
    orbit_branches,
)
from bouncing_ball.studies.printed_table1 import printed_table

SADDLE_NODE, PERIOD_DOUBLING = Bifurcation


class BothDomains(Branches):
    """One family, followed along Λ on one contact and in the restitution model."""

    frequency_ratio: FrequencyRatio


def both_domains(
    parameters: BothDomains, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one ϖ, and that of the restitution model (Fig. 15).

    The dataset has the variables of :func:`~.orbit_branches.orbit_branches` with one ϖ. The
    restitution model has ``restitution_amplitude``, ``restitution_phase`` in rad,
    ``restitution_stable`` and ``restitution_admissible`` (point,), and numbers for Λ and φ of its
    two bifurcations.

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit up to ``amplitude_max``.
    """
    n, r, top = parameters.n, parameters.restitution, parameters.amplitude_max
    one = dict(parameters) | {"frequency_ratio": (parameters.frequency_ratio,)}
    contact = orbit_branches(Domains(**one), release, continuation)
    model = RestitutionModel(r)
    rigid = model.orbit_of(n, *restitution_orbits.branch(n, r, top, parameters.points))
    along = columns(rigid, "amplitude", "phase")
    limits = {"saddle_node": model.saddle_node(n), "period_doubling": model.period_doubling(n)}
    return describe(
        contact.assign(
            {f"restitution_{name}": ("point", values) for name, values in along.items()}
            | {f"{kind}_{x}": getattr(limits[kind], x) for kind in limits for x in PLACE[:2]}
        )
    )


def first_limits(branch: Branch) -> np.ndarray:
    """The saddle-node and the period doubling that bound the first stable range, shape (2, N + 1).

    In the order of the branch, from the unstable to the stable side, they are its last saddle-node
    and the first period doubling after it.

    Raises
    ------
    NoOrbitError
        If the branch lacks one of them.
    """
    folds = [k for k, special in enumerate(branch.special) if special.name == SADDLE_NODE]
    beyond = branch.special[folds[-1] :] if folds else ()
    flips = [special for special in beyond if special.name == PERIOD_DOUBLING]
    if not flips:
        raise NoOrbitError(
            f"the branch from {str(branch.start)!r} to {str(branch.end)!r} has no "
            f"{PERIOD_DOUBLING if folds else SADDLE_NODE} to bound its stable range"
        )
    return np.array([beyond[0].point, flips[0].point])


def stability_ranges(
    parameters: Ranges, release: Release, continuation: Continuation
) -> xr.Dataset:
    """Ranges of Λ in which the n-T orbits are stable, computed and printed (Table 1).

    The dataset has ``computed`` and ``printed``, values of Λ, ``special_phase`` in rad and
    ``special_contact_duration``, shape (ϖ, n, bound), where the bounds are a saddle-node and a
    period doubling; and ``restitution_range`` (impact_map, n, bound). An entry is NaN where the
    orbit has no such range, and ``absence`` (ϖ, n), which exists only then, says why; ``printed``
    is NaN where the paper has no entry.
    """
    families, ratios = parameters.n, parameters.frequency_ratio
    shape = len(ratios), len(families)
    found, absence = np.full((*shape, 2, len(PLACE)), np.nan), np.full(shape, "", dtype=object)
    for at in np.ndindex(shape):
        n, ratio = families[at[1]], ratios[at[0]]
        try:
            contact = SpringDamper.from_restitution(parameters.restitution, ratio, release)
            model, step = SpringDamperModel(contact), continuation.largest_step
            branch = whole_branch(model, n, parameters.amplitude_max, step, Bifurcation)
            limits = model.system(n).orbit(first_limits(branch))
            found[at] = np.stack([getattr(limits, name) for name in PLACE], axis=-1)
        except (NoOrbitError, ContinuationError) as error:
            absence[at] = str(error)
    r, maps = parameters.restitution, restitution_orbits.ImpactMap
    rigid = RestitutionModel(r).saddle_node(np.array(families))
    doublings = [restitution_orbits.period_doubling(np.array(families), r, kind) for kind in maps]
    rigid_ranges = np.array([np.stack([rigid.amplitude, each], axis=-1) for each in doublings])
    dims = ("frequency_ratio", "n", "bound")
    names = ("computed", "special_phase", "special_contact_duration")
    dataset = xr.Dataset(
        {
            **{name: (dims, found[..., k]) for k, name in enumerate(names)},
            # Entries that the paper does not have become NaN.
            "printed": printed_table().reindex(frequency_ratio=list(ratios), n=list(families)),
            "restitution_range": (("impact_map", "n", "bound"), rigid_ranges),
        },
        coords={
            "frequency_ratio": np.array(ratios),
            "n": np.array(families),
            "bound": [SADDLE_NODE, PERIOD_DOUBLING],
            "impact_map": [str(kind) for kind in maps],
        },
    )
    if np.any(absence != ""):
        dataset["absence"] = (dims[:2], absence.astype(str))
    return describe(dataset)
