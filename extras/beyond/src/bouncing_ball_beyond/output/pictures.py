"""Draw branches of orbits and curves of special orbits.

Stable orbits are drawn as solid lines, and unstable orbits as dashed lines. Orbits that no ball
follows are pale. Special orbits have marks. The pictures do not use pyplot or the user's settings
of matplotlib.
"""

from dataclasses import replace
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bouncing_ball_beyond.output.results import OF_IMPACTS, OF_ORBITS, PARAMETERS
from bouncing_ball_beyond.periodic.branches import FollowedBranch, SpecialCurve
from bouncing_ball_beyond.periodic.equations import PeriodicOrbit
from bouncing_ball_beyond.periodic.paths import OF_TABLES
from carbonelli2011.curves import KINDS, pieces
from paper_replication.drawing import WIDTH, colours, legend_below, pale, sample, style

MARKS = {
    "saddle-node": "o",
    "period doubling": "s",
    "period halving": "D",
    "Neimark-Sacker": "P",
    "grazing of a flight": "^",
    "grazing of a release": "v",
    "grazing of an impact": "<",
    "vanishing flight": ">",
    "lost release": "X",
    "switch of a release": "+",
}
"""Marker of each kind of special orbit."""

MARK: dict[str, Any] = {
    "fillstyle": "none",
    "markersize": 4,
    "linestyle": "none",
    "markeredgewidth": 1.0,
    "zorder": 4,
}
"""Style of all marks."""

HEIGHT = 2.8
"""Height of a figure in inches."""

TITLE = 50
"""Maximum number of letters in a line of a title. Lines do not break at an equals sign."""
EQUAL = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"

BESIDE = 1e-3
"""If multipliers are farther than this from the unit circle, the orbit is not special."""

MARKED = 4
"""Number of impacts above which special orbits have no marks. More marks would hide the lines."""


def plot(*branches: Any, quantity: str = "phase", ax: Axes | None = None) -> Figure:
    """Draw branches against their parameter, or curves of special orbits against two parameters.

    Parameters
    ----------
    *branches : FollowedBranch, SpecialCurve or list of them
        Branches or curves, all along the same parameters. A cascade is a list of branches.
    quantity : str
        Quantity drawn against the parameter of a branch. It is "max_height", or a quantity of
        impacts such as "phase". A quantity of impacts gives one line per impact.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into. By default the figure is new.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If ``branches`` contains other objects, or if there is no such quantity.
    """
    groups = [group if isinstance(group, list | tuple) else [group] for group in branches]
    # An OrbitNotFound is left out.
    drawn = [branch for group in groups for branch in group if isinstance(branch, FollowedBranch)]
    along = {tuple(path.name for path in branch.equations.along) for branch in drawn}
    if len(along) != 1:
        raise ValueError(
            "plot draws branches, curves and lists of them, all along the same parameters, such as"
            " follow(orbit, to=1.3)"
        )
    names = *along.pop(), quantity
    if quantity not in OF_IMPACTS and quantity != "max_height":
        allowed = ", ".join(["max_height", *OF_IMPACTS])
        raise ValueError(f"quantity = {quantity!r}: must be one of {allowed}")
    with style():
        figure = Figure(figsize=(WIDTH, HEIGHT))
        axes = figure.subplots() if ax is None else ax
        entries: dict[str, Any] = {}
        lines: dict[str, Any] = {}
        title, differences = _texts(drawn)
        # Orbits of the same parameters share a colour, and curves if their kind is also the same.
        keys = [
            (difference, getattr(branch, "kind", ""))
            for difference, branch in zip(differences, drawn, strict=True)
        ]
        kinds = dict.fromkeys(keys)
        # Several colours leave out black, in which the legend has what branches share.
        black = int(len(kinds) > 1)
        palette = dict(zip(kinds, colours(len(kinds) + black)[black:], strict=True))
        for branch, key in zip(drawn, keys, strict=True):
            entries |= _draw(axes, branch, quantity, palette[key])
            lines[key[0]] = sample(color=palette[key])
        entries = dict(sorted(entries.items(), key=_order)) | (lines if len(lines) > 1 else {})
        axes.set(xlabel=_label(names[0]), ylabel=_label(names[1]), title=title)
        if ax is None:
            legend_below(figure, entries, columns=3)
            return figure
        axes.legend(entries.values(), entries.keys())
        return axes.get_figure(root=True) or figure


def _draw(axes: Axes, branch: FollowedBranch, quantity: str, colour: str) -> dict[str, Any]:
    """Draw one branch or curve, and return samples of its lines by their texts in the legend."""
    is_curve = isinstance(branch, SpecialCurve)
    shown = branch.refined()
    orbits = shown.with_special()
    whole = replace(shown, z=np.array([orbit.z for orbit in orbits]))
    x, y, period = _coordinates(whole, quantity)
    stable = np.ones(len(x), bool) if is_curve else whole.stable
    looks = 2 * whole.admissible + stable
    looks = looks[_ordinary(orbits, branch.special)]
    entries = {}
    for part in pieces(looks):
        admissible, steady = divmod(int(looks[part.start]), 2)
        look: dict[str, Any] = {
            "color": colour if admissible else pale(colour),
            "linestyle": KINDS["stable" if steady else "unstable"],
        }
        for line in y[part].T:
            axes.plot(*_cut(x[part], line, period), **look)
        kind = getattr(whole, "kind", "stable" if steady else "unstable")
        text = kind if admissible else f"{kind}, no ball follows"
        # Colours distinguish the kinds of curves. Several branches share a line style, so its
        # entry is black.
        common = colour if is_curve else "black"
        entries[text] = sample(**look | {"color": common if admissible else pale(common)})
    for orbit, abscissa, ordinates in zip(orbits, x, y, strict=True):
        if orbit in branch.special and orbit.impacts <= MARKED:
            look = MARK | {"marker": MARKS[orbit.kind]}
            axes.plot(np.full(ordinates.shape, abscissa), ordinates, color=colour, **look)
            entries[orbit.kind] = sample(**look)
    return entries


def _ordinary(orbits: list[PeriodicOrbit], special: tuple[PeriodicOrbit, ...]) -> NDArray:
    """For each orbit, return the index of the next ordinary orbit, or of the last ordinary orbit.

    Orbits at the ends of the branch are left out, because they may be special. The orbit at an end
    is ordinary if its only neighbour is special, and if the multipliers of the orbit at the end are
    away from the unit circle.
    """
    places = [orbit.z for orbit in special]
    marked = [any(np.array_equal(orbit.z, z) for z in places) for orbit in orbits]
    last = len(orbits) - 1
    inner = []
    for i, orbit in enumerate(orbits):
        at_end = i in (0, last)
        alone = at_end and last > 1 and marked[1 if i == 0 else last - 1]
        alone = alone and np.abs(np.abs(orbit.multipliers) - 1).min() > BESIDE
        if not marked[i] and (alone or not at_end):
            inner.append(i)
    others = np.array(inner or [0])
    return others[np.searchsorted(others, np.arange(len(orbits))).clip(max=len(others) - 1)]


def _order(entry: tuple[str, Any]) -> tuple[bool, bool, bool]:
    """Sort key of a legend. Lines of stable orbits come first, then other lines, then marks."""
    text, line = entry
    return line.get_linestyle() == "None", "no ball" in text, text == "unstable"


def _coordinates(branch: FollowedBranch, quantity: str) -> tuple[NDArray, NDArray, float]:
    """Return abscissas, shape (points,), ordinates, shape (points, lines), and their period.

    The period of a phase over π is 2: each orbit is drawn at its phase in (-π, π], wherever its
    branch begins. The period of other quantities is infinite.
    """
    if isinstance(branch, SpecialCurve):
        return branch.z[:, -2], branch.z[:, -1:], np.inf
    if quantity == "max_height":
        return branch.values, branch.equations.max_height(branch.z)[:, np.newaxis], np.inf
    y = np.array([np.atleast_1d(getattr(orbit, quantity)) for orbit in branch.orbits])
    is_angle = OF_IMPACTS[quantity][2] == "rad"
    return branch.values, y / np.pi if is_angle else y, 2.0 if is_angle else np.inf


def _cut(x: NDArray, y: NDArray, period: float) -> tuple[NDArray, NDArray]:
    """Insert NaN between points of a line where y jumps by its period.

    Examples
    --------
    >>> _cut(np.array([0.0, 1.0, 2.0]), np.array([0.7, 0.9, -0.9]), 2.0)[1].tolist()
    [0.7, 0.9, nan, -0.9]
    """
    jumps = np.flatnonzero(np.abs(np.diff(y)) > period / 2) + 1
    return np.insert(x, jumps, np.nan), np.insert(y, jumps, np.nan)


def _label(name: str) -> str:
    """Label of an axis, with the name and the symbol of a quantity."""
    _, symbol, unit = (OF_IMPACTS | OF_ORBITS | PARAMETERS).get(name, (name, "", "1"))
    symbol = f"{symbol}/π" if unit == "rad" else symbol
    return f"{name} {symbol}".replace("_", " ").rstrip()


def _texts(branches: list[FollowedBranch]) -> tuple[str, list[str]]:
    """Return the title of a figure, and for each branch its text in the legend.

    The title has what all branches share: numbers of impacts and periods, and constant parameters.
    The texts of branches have the rest.
    """
    constants = [_constants(branch) for branch in branches]
    same = [text for text in constants[0] if all(text in texts for texts in constants)]
    others = [", ".join(text for text in texts if text not in same) for texts in constants]
    differences = [text.replace(EQUAL, " = ") for text in others]
    return fill(", ".join(same), TITLE).replace(EQUAL, " = "), differences


def _constants(branch: FollowedBranch) -> list[str]:
    """Texts of the numbers of impacts and periods of a branch, and of its constant parameters.

    Parameters at a default value are left out. The phase of a harmonic is 0 by default, and the
    size of the first harmonic is 1.
    """
    # A branch may end at the value of its parameter at which it began.
    first, *others = (orbit.parameters for orbit in branch.orbits)
    several = "s" if branch.impacts > 1 else ""
    return [f"{branch.impacts} impact{several} in {branch.periods} T"] + [
        f"{_symbol(name)}{EQUAL}{value:.4g}"
        for name, value in first.items()
        if all(value == parameters[name] for parameters in others)
        and value != (1.0 if name == "harmonic_1" else 0.0 if name.startswith("phase_") else None)
    ]


def _symbol(name: str) -> str:
    """Symbol of a parameter in a title: a₃ and p₃ are size and phase of a sin(3τ + p)."""
    if not name.startswith(OF_TABLES):
        return PARAMETERS.get(name, ("", name))[1]
    order = name.rpartition("_")[2].translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))
    return f"{'a' if name.startswith('harmonic') else 'p'}{order}"
