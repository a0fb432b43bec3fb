"""Which entries of a configuration ask for orbits that do not exist, by the closed forms.

Snakemake asks before any job, in an environment that may lack numpy. A test compares the amplitudes
with those of `bouncing_ball.restitution`.
"""

from collections.abc import Iterator, Mapping
from math import hypot, pi

from paper_replication.configuration import names

COMPARED = "error_thresholds"
"""The stage that compares stable orbits of both models."""
ALONG_CASES = ("apparent_restitution", "continuation", "time_histories")
"""Stages whose entries need an orbit of stiff contacts in one case. A branch begins at its largest
amplitude.
"""
WITHOUT_ORBITS = {"saddle_node", "period_doubling", "permanent_contact"}
"""Quantities that need no orbit at the amplitude."""


def stable_range(n: int, r: float) -> tuple[float, float]:
    """Amplitudes at both ends of the stable n-T orbits of the restitution model (Eqs. 7 and R1).

    >>> low, high = stable_range(1, 0.85)
    >>> round(low, 4), round(high, 4)
    (0.2547, 1.0383)
    """
    low = n * pi * (1 - r) / (1 + r)
    return low, hypot(low, 2 * (1 + r**2) / (1 + r) ** 2)


def without_orbit(config: Mapping) -> Iterator[str]:
    """Yield a line for each entry that asks for orbits where there are none."""
    for name in names(config[COMPARED]):
        entry = config[COMPARED][name]
        if {"n", "restitution", "amplitude"} <= entry.keys():
            low, high = stable_range(entry["n"], entry["restitution"])
            is_asked = not {*entry.get("quantities", ("max_height",))} <= WITHOUT_ORBITS
            if is_asked and not low < entry["amplitude"] < high:
                yield (
                    f"{COMPARED}.{name}.amplitude: {entry['amplitude']:g} has no stable "
                    f"{entry['n']}-T orbit, which needs Λ from {low:.6g} to {high:.6g} (Eqs. 7 and "
                    f"R1 for r = {entry['restitution']:g})"
                )
    for stage in ALONG_CASES:
        for name in names(config[stage]):
            entry = config[stage][name]
            amplitudes = entry.get("amplitude", entry.get("amplitude_max", []))
            listed = amplitudes if isinstance(amplitudes, list) else [amplitudes]
            cases = [entry | {"amplitude": size} for size in listed] + entry.get("cases", [])
            lowest = [stable_range(entry["n"], case["restitution"])[0] for case in cases]
            below = [case["amplitude"] < low for case, low in zip(cases, lowest, strict=True)]
            if cases and all(below):
                yield (
                    f"{stage}.{name}: {entry['n']}-T orbits on stiff contacts need Λ >= "
                    f"{min(lowest):.6g} (Eq. 7), and the largest Λ is "
                    f"{max(case['amplitude'] for case in cases):g}"
                )
