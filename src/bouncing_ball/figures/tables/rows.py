"""The tables of the run: for each table a function of its dataset, with the name of the table.

Each function returns the header and the rows as texts, made from parts of the dataset and columns
(:mod:`.layout`).
"""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.rounding import compared_text
from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import Table, number
from bouncing_ball.figures.tables.layout import Columns, at, quantity, table, text, value


def table1(data: xr.Dataset) -> Table:
    """Stability ranges over Λ: each end of each range computed, printed, and their difference.

    Differences are in Λ. The rows of the restitution model have no printed values.
    """
    ends: Columns = {"n": text("n"), "bound": text("bound")}
    contacts: Columns = {
        "ϖ": value("frequency_ratio", "g"),
        **ends,
        "computed": value("computed", ".5f"),
        "printed": value("printed", ".3f", ""),
        "difference": lambda part: number(part.computed - part.printed, "+.5f", ""),
    }
    header, body = table(each(data, "frequency_ratio", *ends), contacts)
    for part in each(data, "impact_map", *ends):
        place = [column(part) for column in ends.values()]
        name = f"restitution ({part.impact_map.item()} map)"
        body.append([name, *place, number(part.restitution_range, ".5f"), "", ""])
    return header, body


def thresholds(data: xr.Dataset) -> Table:
    """The ϖ needed for each tolerance, quantity by quantity.

    If the threshold is outside the range scanned, the entry is the end of the range after < or >.
    """
    low, high = (f"{float(data.frequency_ratio[k]):g}" for k in (0, -1))
    found = _threshold(".5g", f"< {low}", f"> {high}")
    columns = {f"{100 * each:g} %": at(found, tolerance=each) for each in data.tolerance.values}
    return table(each(data, "quantity"), {"quantity": quantity, **columns})


def _threshold(form: str, within: str, never: str):
    """A column of thresholds, with the given texts for thresholds outside the range scanned."""

    def column(part: xr.Dataset) -> str:
        outside = within if part.threshold_status.item() == "within" else never
        return number(part.error_threshold, form, outside)

    return column


def formulas(data: xr.Dataset) -> Table:
    """Printed formulas: the comparison, the disagreement, and the disagreement allowed.

    For a disagreement of the size of rounding the entry is its bound.
    """
    columns: Columns = {
        "formula": text("formula"),
        "compared with": text("compared_with"),
        "largest disagreement": lambda part: compared_text(
            float(part.disagreement), float(part.budget), ".1e"
        ),
        "allowed": value("budget", ".0e"),
    }
    return table(each(data, "formula"), columns)


def forensics(data: xr.Dataset) -> Table:
    """Readings of Table 1, the closest first; differences in units of the last digit.

    The entry is a dash if a reading has no orbit.
    """
    columns: Columns = {"rank": text("rank"), "reading": text("reading")}
    for name in data.rows.values[:2]:
        columns[f"largest, {name}"] = at(value("largest_difference", ".2f"), rows=name)
        columns[f"rms, {name}"] = at(value("rms_difference", ".2f"), rows=name)
    for name in data.rows.values[:2]:
        columns[f"reproduced, {name}"] = at(
            lambda part: f"{int(part.reproduced)} of {int(part.entries)}", rows=name
        )
    columns["printed below every orbit"] = text("unreachable")
    return table(each(data, "reading"), columns)


def witness(data: xr.Dataset) -> Table:
    """Largest disagreement between the routes to the orbits of each figure or table.

    An entry is a bound of the largest disagreement, which is the budget unless this is exceeded,
    and the number of orbits in brackets. The disagreement itself is not printed, because it
    consists of rounding errors, which differ between processors.
    """

    def entry(part: xr.Dataset) -> str:
        found, allowed = float(part.disagreement), float(part.budget)
        text = f"≤ {allowed:.0e}" if found <= allowed else f"{found:.1e}"
        return f"{text} ({int(part.orbits)})" if part.orbits else "–"

    kinds = {str(kind): at(entry, comparison=kind) for kind in data.comparison.values}
    header, body = table(each(data, "artifact"), {"artifact": text("artifact"), **kinds})
    return header, [["budget", *(f"{float(value):.0e}" for value in data.budget.values)], *body]


def claims(data: xr.Dataset) -> Table:
    """Claims of the paper: place, statement, number, deviation, verdict.

    The column "printed or required" has the printed number, or the bound that a
    formula or a statement must meet.
    """
    columns: Columns = {
        "claim": text("claim"),
        "where": text("item"),
        "what the paper says": text("statement"),
        "printed or required": text("required"),
        "found": found_text,
        "deviation": deviation_text,
        "verdict": text("verdict"),
    }
    return table(each(data, "claim"), columns)


def found_text(claim: xr.Dataset) -> str:
    """The number found, with two digits more than printed, or four digits if nothing is printed.

    For a number of the size of rounding the text is its bound.
    """
    printed = claim.printed_text.item()
    if not printed and np.isfinite(claim.found):
        return compared_text(float(claim.found), float(claim.limit))
    return number(claim.found, f".{len(printed.partition('.')[2]) + 2}f")


def deviation_text(claim: xr.Dataset) -> str:
    """The deviation in units of the last printed digit, and in per cent."""
    units, share = float(claim.deviation_units), float(claim.deviation)
    return "" if np.isnan(units) else f"{units:+.2f} ({100 * share:+.3g} %)"


def ext_orders(data: xr.Dataset) -> Table:
    """The error law by quantity; the permanent contact, which has no correction, comes last.

    C is the corrected model's error times ϖ²; the last column is the ϖ at which
    the restitution model's error changes its sign.
    """
    found = _threshold(".4g", "all", "none")
    columns: Columns = {
        "quantity": quantity,
        "K": value("coefficient", ".4f"),
        "C": value("second_order", ".4f"),
        "law": value("law_threshold", ".4g"),
        **{str(model): at(found, model=model) for model in data.model.values},
        "error zero at": value("error_zero", ".3g"),
    }
    header, body = table(each(data, "quantity"), columns)
    k, law, exact = (data[f"permanent_{name}"] for name in ("coefficient", "law", "threshold"))
    numbers = [number(k, ".4f"), "–", number(law, ".4g"), number(exact, ".4g"), "–", "–"]
    return header, [*body, ["permanent contact, second order", *numbers]]


def ext_laws(data: xr.Dataset) -> Table:
    """Errors on contacts of five laws with the same restitution coefficient and centroid.

    Columns give both models at the smallest, the middle and the largest π/(D + κ) of the grid, and
    the threshold of the height.
    """
    grid = data.centroid_ratio.values
    columns: Columns = {"quantity": quantity, "law": text("law")}
    for model in data.model.values:
        for ratio in grid[[0, round((len(grid) - 1) / 2), -1]]:
            error = at(value("relative_error", ".2g"), model=model, centroid_ratio=ratio)
            columns[f"{model}, π/(D + κ) = {ratio:.3g}"] = error
    columns[f"π/(D + κ) for {100 * data.attrs['tolerance']:g} %"] = lambda part: (
        number(part.error_threshold, ".4g") if part["quantity"] == "max_height" else "–"
    )
    return table(each(data, "quantity", "law"), columns)


_OF_ENGINES = "free_steps measured_restitution contact_steps height_scatter".split()


def ext_engines(data: xr.Dataset) -> Table:
    """Physics engines and models: restitution, steps, and the heights of orbits.

    Errors are the mean of the bounces ± their scatter. Times are relative to that of the
    event-driven simulation.
    """
    tolerance = data.tolerance.max()
    columns: Columns = {
        "engine or model": text("engine"),
        "release": text("release"),
        "r": value("restitution", "g"),
        "n": value("n", "g"),
        f"steps in a contact for {100 * tolerance.item():g} % in r": value("free_steps", ".0f"),
        "r got": value("measured_restitution", ".4f"),
        "steps in a contact": lambda part: number(part.contact_steps.max(), ".0f"),
        **{
            f"height error, ϖ = {ratio:g}": at(_error, frequency_ratio=ratio)
            for ratio in data.frequency_ratio.values
        },
        f"time of a bounce, ϖ = {_listed(data.frequency_ratio, 'g')}": lambda part: _listed(
            part.bounce_time, ".1f"
        ),
    }
    # A dictionary, because the keyword tolerance is another argument of sel.
    shown = data.sel({"tolerance": tolerance})
    parts: list[xr.Dataset] = []
    for case in each(shown, "release", "restitution", "n"):
        parts += [one for one in each(case, "engine") if np.isfinite(one.free_steps)]
        for one in each(case, "model"):
            name, error = f"{one.model.item()} model", one.model_error
            own = {"engine": name, "height_error": error, "bounce_time": one.model_time}
            blank = dict.fromkeys(_OF_ENGINES, np.nan)
            parts.append(one.isel(engine=0, drop=True).assign(blank | own))
    return table(parts, columns)


def _listed(values: xr.DataArray, form: str) -> str:
    """The numbers that are not NaN, in one cell."""
    return ", ".join(f"{x:{form}}" for x in values.values.ravel() if np.isfinite(x))


def _error(part: xr.Dataset) -> str:
    """The mean error of a height and its scatter, in per cent."""
    error, scatter = 100 * float(part.height_error), 100 * float(part.height_scatter)
    if not np.isfinite(error):
        return "–"
    # Adding 0.0 removes the sign of a zero that results from rounding.
    mean = f"{round(error, 3) + 0.0:+.3f}"
    return f"{mean} ± {scatter:.2f} %" if np.isfinite(scatter) else f"{mean} %"
