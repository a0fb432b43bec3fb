"""The tables of errors, each a function of its dataset: rows of texts, the header first."""

import xarray as xr

from paper_replication.datasets import parameters
from paper_replication.texts import number, parts_along
from studies.variables import LAW_NAMES


def in_words(name: xr.DataArray) -> str:
    """The name of a quantity."""
    return str(name.item()).replace("_", " ")


def ext_orders(data: xr.Dataset) -> list[list[str]]:
    """The error law by quantity; the permanent contact, which has no correction, comes last.

    C is the corrected model's error times ϖ². The last column is the ϖ at which the error of the
    restitution model changes its sign.
    """
    models = data["model"].values.tolist()
    rows = [["quantity", "K", "C", "law", *models, "error zero at"]]
    for line in parts_along(data, "quantity"):
        thresholds = [
            number(
                line["error_threshold"].sel(model=model),
                ".4g",
                "all" if line["threshold_status"].sel(model=model) == "within" else "none",
            )
            for model in models
        ]
        rows.append(
            [
                in_words(line["quantity"]),
                number(line["coefficient"], ".4f"),
                number(line["second_order"], ".4f"),
                number(line["law_threshold"], ".4g"),
                *thresholds,
                number(line["error_zero"], ".3g"),
            ]
        )
    permanent = [
        number(data["permanent_coefficient"], ".4f"),
        "–",
        number(data["permanent_law"], ".4g"),
        number(data["permanent_threshold"], ".4g"),
    ]
    return [*rows, ["permanent contact, second order", *permanent, "–", "–"]]


def ext_laws(data: xr.Dataset) -> list[list[str]]:
    """Errors on contacts of five laws with the same restitution coefficient and centroid.

    The columns are both models at the smallest, the middle and the largest π/(D + κ) of the grid,
    and the threshold of the height.
    """
    ratios = data["centroid_ratio"].values
    chosen = [float(ratio) for ratio in ratios[[0, round((len(ratios) - 1) / 2), -1]]]
    places = [(model, ratio) for model in data["model"].values.tolist() for ratio in chosen]
    tolerance = parameters(data)["tolerance"]
    header = [f"{model}, π/(D + κ) = {ratio:.3g}" for model, ratio in places]
    rows = [["quantity", "law", *header, f"π/(D + κ) for {100 * tolerance:g} %"]]
    for line in parts_along(data, "quantity", "law"):
        errors = [
            number(line["relative_error"].sel(model=model, centroid_ratio=ratio), ".2g")
            for model, ratio in places
        ]
        is_height = line["quantity"] == "max_height"
        threshold = line["error_threshold"].isel(case=0, calibration=0)
        threshold_text = number(threshold, ".4g") if is_height else "–"
        rows.append(
            [in_words(line["quantity"]), LAW_NAMES[line["law"].item()], *errors, threshold_text]
        )
    return rows


TABLES = {"ext_orders": ext_orders, "ext_laws": ext_laws}
"""The tables by name."""
