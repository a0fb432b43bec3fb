"""Stage: Table 1 under other readings of what the authors may have computed.

The printed ranges of the compliant contacts differ from the computed ones in their last digits. A
reading is a hypothesis about the reason: another damping ratio, another release, no gravity in
contact, another stability, digits that were cut off, or the formulas of the restitution model.
"""

import sys

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from bouncing_ball import restitution
from bouncing_ball.continuation import at_bifurcation, bifurcations, walk
from bouncing_ball.datasets import printed_table, save
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact, damping_ratio, force_release_restitution

BOUNDS = ("saddle-node", "period doubling")
RESTITUTION = 0.85
PRINTED_DAMPING = 0.052
"""ζ as the paper rounds it in the captions of Figs. 8 to 10."""
LAST_DIGIT = 0.001


def high_bounce_doubling(family: Family, y: np.ndarray) -> np.ndarray:
    """1 + trace + determinant of a return map whose flight ends at the height at which it began.

    This is the neglect of Holmes' map: a flight of duration L obeys z′_b L - L²/2 = 0 in place of
    Eq. 25, so that L changes by -L/z′_i times the change of z′_b.
    """
    x, lift, _ = family.start(y)
    end = family.contact_end(y)
    by_gap, by_rate = family.linearised_contact(y)
    rows = []
    for phase, change in ((1, (-lift, x, lift)), (0, (0 * x, 0 * x, 1 + 0 * x))):
        gap = sum(one * other for one, other in zip(by_gap, change, strict=True))
        rate = sum(one * other for one, other in zip(by_rate, change, strict=True))
        longer = -gap / end.gap_velocity
        later = phase + longer
        velocity = rate + end.gap_acceleration * longer - end.table_height * later
        flight = -end.flight / y[2] * velocity
        rows.append((later + flight, velocity - flight))
    # The map is from phase and relative velocity to these; in flight the velocity of the table
    # changes by -Y times the phase.
    (phase_by_phase, velocity_by_phase), (phase_by_velocity, velocity_by_velocity) = rows
    determinant = phase_by_phase * velocity_by_velocity - phase_by_velocity * velocity_by_phase
    return 1 + phase_by_phase + velocity_by_velocity + determinant


def equal_damping() -> float:
    """ζ with which a free impact with the force release has the restitution of the table."""
    return brentq(lambda zeta: force_release_restitution(zeta) - RESTITUTION, 1e-3, 0.9, xtol=1e-15)


def readings(n: np.ndarray, ratios: np.ndarray) -> dict[str, np.ndarray]:
    """Both ends of each range under nine readings, shape (n, ϖ, 2).

    With "equal r" the contact with the force release has the damping with which a free impact has
    the restitution of the table. Under "high-bounce stability" the orbits are exact.
    """
    r = RESTITUTION
    zeta = float(damping_ratio(r))
    equal = equal_damping()

    # One walk along the contacts has the families of all readings with the same release.
    def ends(damping, release="displacement", weight=1.0):
        damping, weight = np.broadcast_arrays(damping, weight)
        contact = Contact(
            ratios,
            np.repeat(damping, n.size)[:, np.newaxis],
            release,
            np.repeat(weight, n.size)[:, np.newaxis],
        )
        families = np.tile(n, damping.size)
        kinds = [bifurcations(families, kind, ratios, contact)[0] for kind in BOUNDS]
        return np.stack(kinds, axis=-1).reshape(damping.size, n.size, ratios.size, 2)

    first_order = -np.log(r) / np.pi
    plain, as_printed, to_first_order, weightless = ends(
        [zeta, PRINTED_DAMPING, first_order, zeta], weight=[1.0, 1.0, 1.0, 0.0]
    )
    force, force_equal = ends([zeta, equal], "force")
    families = n[:, np.newaxis]
    x = restitution.saddle_node(families, r)
    high_bounce = walk(
        Family(families, Contact(ratios, zeta)),
        ratios,
        at_bifurcation(high_bounce_doubling),
        x,
        np.ones_like(x),
    )[0]
    printed_formulas = np.stack(
        [restitution.saddle_node(n, r), restitution.holmes_period_doubling(n, r)], axis=-1
    )
    return {
        "equations as they stand": plain,
        "digits cut off": np.floor(plain / LAST_DIGIT) * LAST_DIGIT,
        "damping as printed": as_printed,
        "damping to first order": to_first_order,
        "force release": force,
        "force release, equal r": force_equal,
        "no gravity in contact": weightless,
        "high-bounce stability": np.stack([plain[..., 0], high_bounce], axis=-1),
        "all rows from Eqs. 7-8": np.broadcast_to(printed_formulas[:, np.newaxis], plain.shape),
    }


def paper_equations(n: int, ratio: float, zeta: float, unknowns: np.ndarray) -> np.ndarray:
    """The defects of Eqs. 21 to 26, with heights in contact times ϖ.

    The unknowns are (φ, z′_i, z′_b, ϖτ_b, ϖA, ϖB) and Λ, with A and B the constants of Eq. 12.
    """
    phase, impact, bounce, angle, a, b, amplitude = unknowns
    gamma = (ratio**2 - 1) ** 2 + (2 * zeta * ratio) ** 2
    duration = angle / ratio
    flight = 2 * np.pi * n - duration
    damped = np.sqrt(1 - zeta**2)

    def contact(time):
        """ϖδ and δ′ at a time."""
        swing = amplitude * ratio / gamma
        sine = np.sin(time + phase)
        cosine = np.cos(time + phase)
        decay = np.exp(-zeta * ratio * time)
        u = np.cos(damped * ratio * time)
        v = np.sin(damped * ratio * time)
        displacement = swing * ((ratio**2 - 1) * sine - 2 * zeta * ratio * cosine)
        velocity = swing * ((ratio**2 - 1) * cosine + 2 * zeta * ratio * sine)
        transient = decay * (a * u + b * v)
        transient_velocity = decay * damped * (b * u - a * v) - zeta * transient
        return displacement - 1 / ratio + transient, velocity / ratio + transient_velocity

    start, start_velocity = contact(0.0)
    end, end_velocity = contact(duration)
    release = duration + phase
    drop = amplitude * (np.sin(release) - np.sin(phase))
    return np.array(
        [
            start,
            start_velocity + amplitude * np.cos(phase) - impact,
            end,
            end_velocity + amplitude * np.cos(release) - bounce,
            drop + bounce * flight - flight**2 / 2,
            bounce - flight - impact,
        ]
    )


def needed_tolerance(
    n: int, ratio: float, zeta: float, node: np.ndarray, amplitude: float
) -> float:
    """The smallest norm of the defects of Eqs. 21 to 26 at a Λ below the saddle-node.

    It is given to first order in the distance from the saddle-node; 0 above, where orbits exist.

    At the saddle-node the derivative of the defects by the unknowns has a left null vector. No
    change of the unknowns removes the part of the defects along it.
    """
    largest, phase, impact, angle = node
    family = Family(n, Contact(ratio, zeta))
    gamma = (ratio**2 - 1) ** 2 + (2 * zeta * ratio) ** 2
    swing = largest * ratio / gamma
    sine = np.sin(phase)
    cosine = np.cos(phase)
    _, _, relative = family.start(node)
    # A and B from δ = 0 and δ′ = u at the start of the contact.
    a = 1 / ratio - swing * ((ratio**2 - 1) * sine - 2 * zeta * ratio * cosine)
    velocity = swing / ratio * ((ratio**2 - 1) * cosine + 2 * zeta * ratio * sine)
    b = (relative - velocity + zeta * a) / np.sqrt(1 - zeta**2)
    bounce = float(family.bounce_velocity(node))
    unknowns = np.array([phase, impact, bounce, angle, a, b, largest])
    columns = []
    for k in range(unknowns.size):
        # Central differences of smooth functions of the size of 1, with an error of some 1e-10.
        shift = 1e-5 * np.eye(unknowns.size)[k]
        above = paper_equations(n, ratio, zeta, unknowns + shift)
        below = paper_equations(n, ratio, zeta, unknowns - shift)
        columns.append((above - below) / 2e-5)
    jacobian = np.stack(columns, axis=-1)
    left = np.linalg.svd(jacobian[:, :-1])[0][:, -1]
    return float(abs(left @ jacobian[:, -1]) * max(largest - amplitude, 0))


def stable_width(ends: xr.DataArray) -> xr.DataArray:
    """√(Λ_PD² - Λ_SN²), which is 1 by Eqs. 7 and 8 for every n and r."""
    first = ends.sel(bound="saddle-node", drop=True)
    second = ends.sel(bound="period doubling", drop=True)
    return np.sqrt(second**2 - first**2)


def table1_readings(printed: xr.DataArray) -> xr.Dataset:
    """Table 1 under each reading, the readings in the order of their root mean square difference in
    the rows of the compliant contacts, and then in all rows.
    """
    n = printed.n.values
    ratios = printed.frequency_ratio.values
    found = readings(n, ratios)
    computed = xr.DataArray(
        list(found.values()),
        {"reading": list(found), "n": n, "frequency_ratio": ratios, "bound": list(BOUNDS)},
        ("reading", "n", "frequency_ratio", "bound"),
    ).transpose("reading", "frequency_ratio", "n", "bound")
    difference = (computed - printed) / LAST_DIGIT
    ratio = printed.frequency_ratio
    groups = {"all rows": ratio > 0, "compliant rows": ratio < ratio.max()}
    groups |= {f"ϖ = {float(value):g}": ratio == value for value in ratio}
    rows = xr.Variable("rows", list(groups))
    parts = xr.concat([difference.where(group) for group in groups.values()], rows)
    over = ["frequency_ratio", "n", "bound"]
    zeta = float(damping_ratio(RESTITUTION))
    nodes = bifurcations(n, "saddle-node", ratios, Contact(ratios, zeta))
    needed = [
        [
            needed_tolerance(
                int(n[k]),
                float(ratios[j]),
                zeta,
                nodes[:, k, j],
                float(printed.sel(bound="saddle-node")[j, k]),
            )
            for k in range(n.size)
        ]
        for j in range(ratios.size)
    ]
    below = difference.sel(bound="saddle-node", drop=True) > 0.5
    width = stable_width(printed)
    dataset = xr.Dataset(
        {
            "computed": computed,
            "printed": printed,
            "difference": difference,
            "largest_difference": abs(parts).max(over).transpose("reading", "rows"),
            "rms_difference": np.sqrt((parts**2).mean(over)).transpose("reading", "rows"),
            "reproduced": (abs(parts) <= 0.5).sum(over).transpose("reading", "rows"),
            "entries": parts.isel(reading=0, drop=True).count(over),
            "unreachable": below.sum(["frequency_ratio", "n"]),
            "stable_width": stable_width(computed),
            "needed_tolerance": (("frequency_ratio", "n"), needed),
            "printed_stable_width": width,
            # To first order, with both ends off by half a unit.
            "printed_stable_width_rounding": LAST_DIGIT / 2 * printed.sum("bound") / width,
        }
    )
    # Readings that differ by rounding errors only are equal.
    compliant = dataset.rms_difference.sel(rows="compliant rows").round(6)
    every = dataset.rms_difference.sel(rows="all rows").round(6)
    ranked = dataset.isel(reading=np.lexsort([every, compliant]))
    return ranked.assign(rank=("reading", 1 + np.arange(len(found)))).assign_attrs(
        last_digit=LAST_DIGIT,
        restitution=RESTITUTION,
        printed_damping_ratio=PRINTED_DAMPING,
        force_damping_ratio=equal_damping(),
    )


if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
    save(
        table1_readings(printed_table(snakemake.input.printed).astype(float)),
        snakemake.output.table1_readings,
        snakemake.params.entries["table1_readings"]["title"],
        {},
        snakemake.input.code,
    )
