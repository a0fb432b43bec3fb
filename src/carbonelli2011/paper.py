"""What the paper prints: its numbers with their digits, and the parameters of its figures.

The configuration repeats the parameters, and users may change them there. A claim is judged only if
its datasets were computed with the parameters below, and the article is written only if all were.
Lists of curves and rows may have more: claims and article leave out what the paper does not have.
"""

from operator import itemgetter

import numpy as np
import xarray as xr

from paper_replication.datasets import (
    Among,
    Datasets,
    other_parameters,
    others,
    parameters,
    selected,
)

LIMIT = 0.01
"""The error of the restitution model that the paper allows, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""The frequency ratio above which the paper calls both models equal."""
PRINTED = {
    "height threshold": "82",
    "permanent contact threshold": "6",
    "compliant end of 1.2": "0.81",
    "damping of 0.85": "0.052",
    "damping of 0.65": "0.1359",
}
"""Printed numbers with their digits, by the names of their claims."""
BOUNDS = ("saddle-node", "period doubling")
"""The ends of a range of stable orbits."""
TABLE_1 = {
    (1e4, 1): ("0.255", "1.032"),
    (1e4, 2): ("0.509", "1.122"),
    (1e4, 3): ("0.764", "1.259"),
    (10.0, 1): ("0.238", "1.035"),
    (10.0, 2): ("0.495", "1.126"),
    (10.0, 3): ("0.750", "1.262"),
    (2.0, 1): ("0.187", "1.082"),
    (2.0, 2): ("0.463", "1.170"),
    (2.0, 3): ("0.733", "1.298"),
}
"""Table 1: Λ at both ends of the ranges, by (ϖ, n). The exponent of the largest ϖ is illegible."""


def end_of_range(ratio: float, n: int, bound: str) -> str:
    """Return the name of a number of Table 1.

    >>> end_of_range(10.0, 3, "saddle-node")
    'Table 1: 10, 3, saddle-node'
    """
    return f"Table 1: {ratio:g}, {n}, {bound}"


def printed_table() -> xr.DataArray:
    """Return Table 1 as texts, over frequency_ratio, n and bound; `astype(float)` gives numbers."""
    ratios, families = (list(dict.fromkeys(column)) for column in zip(*TABLE_1, strict=True))
    shape = (len(ratios), len(families), len(BOUNDS))
    return xr.DataArray(
        np.reshape(list(TABLE_1.values()), shape),
        {"frequency_ratio": ratios, "n": families, "bound": list(BOUNDS)},
        ("frequency_ratio", "n", "bound"),
    )


def on_contacts(**given) -> dict:
    """Add the release of the paper to the parameters of the spring-damper model."""
    return {**given, "release": "displacement"}


def curves(*pairs: tuple[float, float]) -> Among:
    """Return curves of (r, Λ)."""
    return Among("case", [{"restitution": r, "amplitude": amplitude} for r, amplitude in pairs])


QUANTITIES = {
    "max_height": "maximum height",
    "summit": "maximum height in flight",
    "bounce_velocity": "bouncing-off velocity",
    "phase_in_periods": "phase of the impact",
    "apparent_restitution": "apparent restitution coefficient",
    "saddle_node": "Λ of the saddle-node",
    "period_doubling": "Λ of the period doubling",
    "permanent_contact": "Λ of permanent contact",
}
"""Names of the quantities that both models have (Eqs. 37 and 38), for texts and figures. The
maximum height is that of a whole cycle: the table can lift the ball higher than it flies.
"""
ALONG_RATIO = {"min": 1.0, "max": 1000.0}
ROWS_OF_TABLE_1 = Among("frequency_ratio", [1e4, 10.0, 2.0])
PARAMETERS: dict[str, dict] = {
    "fig03": {"n": Among("n", [1, 2, 3, 4, 5]), "restitution": 0.85},
    "fig05": on_contacts(
        n=1,
        cases=curves((1.0, 0.8), (0.85, 1.0), (0.65, 1.0), (0.1, 2.6)),
        frequency_ratio=ALONG_RATIO,
    ),
    "fig06": on_contacts(
        n=1, cases=curves((0.65, 0.7), (0.65, 1.0), (0.65, 1.2)), frequency_ratio=ALONG_RATIO
    ),
    "fig08": on_contacts(n=1, restitution=0.85, frequency_ratio=ROWS_OF_TABLE_1),
    "fig09": on_contacts(n=2, restitution=0.85, frequency_ratio=ROWS_OF_TABLE_1),
    "fig10": on_contacts(
        n=2,
        restitution=0.85,
        amplitude=Among("case", [1.1, 1.0, 0.6]),
        frequency_ratio=ALONG_RATIO,
    ),
    "fig11": on_contacts(restitution=0.65),
    "fig12": on_contacts(
        n=1,
        restitution=0.65,
        amplitude=1.0,
        frequency_ratio=Among("frequency_ratio", [2.0, 5.0, 20.0, 100.0]),
    ),
    "fig13": on_contacts(
        n=1, restitution=0.65, amplitude=Among("case", [1.0]), frequency_ratio=ALONG_RATIO
    ),
    "fig14": on_contacts(n=1, restitution=0.65, amplitude=1.0, frequency_ratio=ALONG_RATIO),
    "fig15": on_contacts(n=2, restitution=0.65, frequency_ratio=10.0),
    "fig16": on_contacts(restitution=0.65, frequency_ratio={"min": 0.5, "max": 100.0}),
    "three_balls": {
        "restitution": 0.5,
        "amplitude": Among("amplitude", [1.2, 1.6, 1.75]),
        "phase": 1.0,
        "impact_speed": 5.0,
    },
    "table1": on_contacts(
        n=Among("n", [1, 2, 3]), restitution=0.85, frequency_ratio=ROWS_OF_TABLE_1
    ),
    "thresholds": on_contacts(
        n=1,
        restitution=0.65,
        amplitude=1.0,
        # The map has two quantities of its own.
        quantities=Among("quantity", [quantity for quantity in QUANTITIES if quantity != "summit"]),
        frequency_ratio={"min": 1.0, "max": 1e4},
    ),
    "lowest_doubling": on_contacts(n=[1, 2, 3], restitution=0.85),
    "validity_map": on_contacts(n=[1, 2, 3], restitution={"min": 0.05, "max": 0.95}, advised=STIFF),
}
"""The parameters that the claims need of each dataset: those of the paper, and where its axes
cannot be read, the ends of the ranges to which the conditions refer. Those of the three balls and
the frequency ratios of Fig. 12 are ours.
"""
TOLERANCES: dict[str, dict] = {
    "fig14": {"tolerance": LIMIT},
    "fig16": {"tolerance": LIMIT},
    "thresholds": {"tolerances": Among("tolerance", [LIMIT])},
    "validity_map": {"tolerance": LIMIT},
}
"""The tolerance of the paper, which only thresholds of ϖ need."""
AXES = {
    "fig03": {"amplitude_max": 2.0},
    "fig08": {"amplitude_max": 1.5},
    "fig09": {"amplitude_max": 1.5},
    "fig15": {"amplitude_max": 2.2},
    "thresholds": {"frequency_ratio": {"samples": 101}},
    "validity_map": {"frequency_ratio": {"min": 10.0, "max": 1e4}},
}
"""Our choices on which sentences of the article rest."""


def changed_parameters(datasets: Datasets) -> list[str]:
    """Return a line for each parameter that differs from the run that the article is about.

    A line begins with the names of the datasets that have the parameter.
    """
    names_by_line: dict[str, list[str]] = {}
    for name, needed in sorted(
        [*PARAMETERS.items(), *TOLERANCES.items(), *AXES.items()], key=itemgetter(0)
    ):
        for line in others(name, parameters(datasets[name]), needed):
            names_by_line.setdefault(line.removeprefix(f"{name}."), []).append(name)
    return [f"{', '.join(dict.fromkeys(names))}: {line}" for line, names in names_by_line.items()]


def of_paper(datasets: Datasets) -> dict[str, xr.Dataset]:
    """Select the curves and rows of the paper, in its order, in the datasets that have them."""
    chosen = {}
    for name, data in datasets.items():
        needed = PARAMETERS.get(name, {}) | TOLERANCES.get(name, {})
        chosen[name] = data if other_parameters(name, data, needed) else selected(data, needed)
    return chosen
