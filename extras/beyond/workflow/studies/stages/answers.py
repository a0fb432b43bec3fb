"""Stage: does the contact have an orbit, and is it stable, where the restitution model says so?

One branch in both models and by the error law, with the window below the saddle-node; the frequency
ratios from which on the contact has this window; and the shift of the period doubling on tables of
several waveforms.
"""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.continuation import bifurcations
from bouncing_ball.restitution import period_doubling, period_doubling_height, saddle_node
from bouncing_ball.spring_damper import Contact
from bouncing_ball_beyond.contacts.balls import Rigid, SpringDamper, damping_of
from bouncing_ball_beyond.errors.error_law import free_impact, law_coefficients, law_errors
from bouncing_ball_beyond.periodic.continuation import limits
from bouncing_ball_beyond.periodic.orbits import orbit
from bouncing_ball_beyond.tables.table import Table
from paper_replication.datasets import grid

# Points of the drawn branches on each side of the saddle-node.
POINTS = 101

# The next orbit to the saddle-node, as a share of its Λ: there the branch is vertical.
NEXT = 1e-9


def both_sides(low: float, high: float) -> NDArray:
    """Amplitudes from the unstable end to the saddle-node and on to the stable end, dense at it."""
    share = np.linspace(-1, 1, 2 * POINTS) ** 2
    return low * (1 + NEXT) + share * (high - low * (1 + NEXT))


def on_a_line(level: float, turned: float, amplitude: NDArray) -> NDArray:
    """Phases at which Λ cos(φ + θ) is a level, on both sides of the saddle-node."""
    angle = np.arccos(level / amplitude)
    angle[: angle.size // 2] *= -1
    return angle - turned


def branches(parameters: dict) -> xr.Dataset:
    """Phases of the touch along Λ in the restitution model, on the contact and by the error law."""
    n = parameters["n"]
    r = parameters["restitution"]
    high = parameters["amplitude_max"]
    ball = SpringDamper(parameters["frequency_ratio"], restitution=r)
    impact = free_impact(ball, n)
    line = float(impact.line)
    level = line - float(impact.shift)
    turned = float(impact.shift + impact.centroid)
    ends = limits(ball, n=n)
    node, doubling = ends.saddle_node, ends.period_doubling
    on_contact = both_sides(node.amplitude, high)
    sides = [
        orbit(ball, amplitude=on_contact[:POINTS], n=n, side="unstable"),
        orbit(ball, amplitude=on_contact[POINTS:], n=n, side="stable"),
    ]
    in_model = both_sides(line, high)
    by_law = both_sides(level, high)
    law_doubling = period_doubling(n, r) * (
        1 + law_errors(impact, amplitude=high)["period_doubling"]
    )
    doublings = np.array([period_doubling(n, r), doubling.amplitude, law_doubling], float)
    amplitude = np.stack([in_model, on_contact, by_law])
    phase = np.stack(
        [
            on_a_line(line, 0.0, in_model),
            [contact_orbit.phase for side in sides for contact_orbit in side],
            on_a_line(level, turned, by_law),
        ]
    )
    stable = (amplitude < doublings[:, np.newaxis]) & (np.arange(2 * POINTS) >= POINTS)
    model_phase = np.arctan2(period_doubling_height(r), line)
    law_phase = np.arccos(level / law_doubling) - turned
    return xr.Dataset(
        {
            "branch_amplitude": (("branch", "point"), amplitude),
            "branch_phase": (("branch", "point"), phase),
            "branch_stable": (("branch", "point"), stable),
            "saddle_node_amplitude": ("branch", [line, node.amplitude, level]),
            "saddle_node_phase": ("branch", [0.0, node.phase, -turned]),
            "period_doubling_amplitude": ("branch", doublings),
            "period_doubling_phase": ("branch", [model_phase, doubling.phase, law_phase]),
        },
        {"branch": ["restitution", "contact", "law"]},
    )


def lowest_windows(parameters: dict) -> xr.Dataset:
    """The ϖ below which the contact's saddle-node is above C, by n and r, NaN if it was not seen.

    It is located by interpolation between two of the ratios, of which 400 leave 10⁻⁴ of it.
    """
    n = parameters["window_n"]
    span = parameters["window_restitution"]
    restitution = np.linspace(span["min"], span["max"], span["samples"])
    ratios = grid(parameters["window_ratio"])[::-1]
    n_all, r_all = (values.reshape(-1, 1) for values in np.meshgrid(n, restitution, indexing="ij"))
    contact = Contact(ratios, damping_of(r_all), "displacement")
    nodes, *_ = bifurcations(n_all[:, 0], "saddle-node", contact)
    above = nodes / saddle_node(n_all, r_all) - 1
    window_ratio = np.full(len(above), np.nan)
    for row, share in enumerate(above):
        (some,) = np.nonzero(share > 0)
        if some.size:
            at = slice(some[0] - 1, some[0] + 1)
            window_ratio[row] = np.exp(np.interp(0, share[at], np.log(ratios[at])))
    example = parameters["example"]
    down = np.append(ratios[ratios > example["frequency_ratio"]], example["frequency_ratio"])
    contact = Contact(down, float(damping_of(example["restitution"])), "displacement")
    node = bifurcations(example["n"], "saddle-node", contact)[0, 0, -1]
    return xr.Dataset(
        {
            "window_ratio": (("window_n", "window_restitution"), window_ratio.reshape(len(n), -1)),
            "example_n": example["n"],
            "example_restitution": example["restitution"],
            "example_ratio": example["frequency_ratio"],
            "example_amplitude": node,
            "example_line": saddle_node(example["n"], example["restitution"]),
        },
        {"window_n": n, "window_restitution": restitution},
    )


def shift(table: Table, r: float | NDArray, n: int) -> NDArray:
    """ϖ times the relative shift of the period doubling by the law, Eq. R6."""
    unit = SpringDamper(1.0, restitution=r)
    # The period doubling does not depend on Λ, which the law needs for other quantities.
    return law_coefficients(unit, amplitude=10.0, n=n, table=table)["period_doubling"]


def worst_phase(strength: float, r: float, n: int) -> float:
    """The phase of a third harmonic at which the shift of the doubling is largest, on a grid of it.

    The shift is a smooth function of the phase, of which the maximum is flat.
    """
    phases = np.linspace(-np.pi, np.pi, 73)[1:]
    tables = [Table([(1, 1.0, 0.0), (3, strength, phase)]) for phase in phases]
    return float(phases[np.argmax([float(shift(table, r, n)) for table in tables])])


def doublings(parameters: dict) -> xr.Dataset:
    """ϖ times the relative shift of the period doubling by Eq. R6 and on stiff contacts, on tables
    of several waveforms.
    """
    n = parameters["n"]
    strength = parameters["harmonic"]
    phase = worst_phase(strength, parameters["sign_restitution"], n)
    given = parameters["waveforms"] | {"third harmonic": [[1, 1.0, 0.0], [3, strength, phase]]}
    tables = {name: Table(harmonics) for name, harmonics in given.items()}
    along = np.linspace(0.3, 0.99, parameters["samples"])
    few = np.array(parameters["table_restitution"])
    ratio = parameters["stiff_ratio"]

    def exact(table: Table, r: float, ratio: float) -> float:
        balls = SpringDamper(ratio, restitution=r), Rigid(r)
        of_contact, of_model = (limits(ball, n=n, table=table).period_doubling for ball in balls)
        return ratio * (of_contact.amplitude / of_model.amplitude - 1)

    example = tables["three harmonics"]
    r = parameters["sign_restitution"]
    on_contact = limits(
        SpringDamper(parameters["example_ratio"], restitution=r), n=n, table=example
    )
    in_model = limits(Rigid(r), n=n, table=example)
    return xr.Dataset(
        {
            "doubling_coefficient": (
                ("waveform", "doubling_restitution"),
                [shift(table, along, n) for table in tables.values()],
            ),
            "table_coefficient": (
                ("waveform", "table_restitution"),
                [shift(table, few, n) for table in tables.values()],
            ),
            "table_shift": (
                ("waveform", "table_restitution"),
                [[exact(table, r, ratio) for r in few] for table in tables.values()],
            ),
            "harmonic_phase": phase,
            "example_doubling": on_contact.period_doubling.amplitude,
            "example_restitution_doubling": in_model.period_doubling.amplitude,
        },
        {
            "waveform": list(tables),
            "doubling_restitution": along,
            "table_restitution": few,
        },
    )


def ext_answers(parameters: dict) -> xr.Dataset:
    """The drawn branches, the windows, and the shifts of the period doubling."""
    return xr.merge([branches(parameters), lowest_windows(parameters), doublings(parameters)])


STAGE = {"ext_answers": ext_answers}
