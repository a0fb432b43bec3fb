"""Datasets: what each variable means, and how a result is saved, read and traced to its code.

Every figure and table has one netCDF file. `VARIABLES` describes each variable that occurs in one
of them, and says how closely two computations of it agree: a number x agrees with the reference y
if

    |x - y| <= tolerance · max(|y|, floor).

The usual tolerance, 1e-9, is meant for the rounding of other processors and versions of numpy: the
orbits are solved to some 1e-13, and a bifurcation amplifies that by some powers of ten. Below the
floor the tolerance is absolute, so that a zero need not be met to the last bit. Texts, integers and
booleans agree only if they are equal.
"""

import csv
import json
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path

import numpy as np
import xarray as xr

from bouncing_ball.history import commit, contents

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient and "
    "spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)
Datasets = Mapping[str, xr.Dataset]
"""Datasets by the names of their figures and tables."""
PACKAGES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")


@dataclass(frozen=True)
class Variable:
    """Description of a variable, and the tolerance within which its numbers agree.

    If `tolerance_scale` names another variable of the same dataset, the tolerance is a multiple of
    that variable in place of the number itself.
    """

    long_name: str
    symbol: str = ""
    equation: str = ""
    units: str = "1"
    tolerance: float = 1e-9
    floor: float = 1e-3
    tolerance_scale: str = ""


VARIABLES = {
    # Coordinates
    "amplitude": Variable("excitation amplitude", "Λ", "Eq. 4"),
    "bound": Variable("end of the stability range"),
    "case": Variable("parameter set"),
    "claim": Variable("claim of the paper"),
    "end": Variable("end of the branch"),
    "frequency_ratio": Variable("frequency ratio of contact and table", "ϖ", "Eq. 11"),
    "impact_map": Variable("map of the restitution model", equation="Eqs. 5, 8"),
    "multiplier": Variable("Floquet multiplier, the larger modulus first", "μ"),
    "n": Variable("index of the family of periodic orbits", "n", "Eq. 6"),
    "point": Variable("point along the branch, at equal steps of arclength"),
    "quantity": Variable("quantity compared between the two models"),
    "reading": Variable("what is assumed, one reading of the paper each"),
    "restitution": Variable("restitution coefficient", "r", "Eq. 2"),
    "rows": Variable("rows of the table that are compared", equation="Table 1"),
    "special": Variable("special point of the branch, in order of arclength"),
    "table_phase": Variable("phase of the table, whose height is Λ sin τ", "τ", units="rad"),
    "time": Variable("time since the first impact", "τ"),
    "tolerance": Variable("relative error tolerated", equation="Eqs. 37-38"),
    # Motions
    "ball": Variable("height of the ball", "z", "Eqs. 4, 12, 14"),
    "ball_velocity": Variable("velocity of the ball", "z′", "Eqs. 3, 13, 15"),
    "table": Variable("height of the table", "w", "Eq. 4"),
    "contact": Variable("whether the ball touches the table"),
    "restitution_ball": Variable("height of the ball, restitution model", "z_CR", "Eq. 4"),
    # Orbits
    "phase": Variable("phase of the table when the contact starts", "φ", "Eqs. 6, 21", "rad"),
    "contact_duration": Variable("duration of the contact", "τ_b", "Eq. 23"),
    "release_phase": Variable(
        "phase of the table when the contact ends", "φ + τ_b", "Eq. 23", "rad"
    ),
    "impact_velocity": Variable("velocity of the ball as contact starts", "z′_i", "Eq. 22"),
    "bounce_velocity": Variable("bouncing-off velocity of the ball", "z′_b", "Eqs. 24, 27"),
    "apparent_restitution": Variable("apparent restitution coefficient", "r_a", "Eq. 17"),
    "max_height": Variable("greatest height of the ball over the cycle", "max z", "Eq. 37"),
    "damping_ratio": Variable("damping ratio of the contact", "ζ", "Eq. 16"),
    # Where both multipliers nearly coincide, they are known to the square root of the precision of
    # the matrix whose eigenvalues they are, some 1e-13.
    "multiplier_real": Variable(
        "real part of the Floquet multiplier", "Re μ", tolerance=1e-6, floor=1.0
    ),
    "multiplier_imag": Variable(
        "imaginary part of the Floquet multiplier", "Im μ", tolerance=1e-6, floor=1.0
    ),
    "stable": Variable("whether both Floquet multipliers are inside the unit circle", "|μ| < 1"),
    "admissible": Variable("whether nothing else happens during the orbit"),
    "end_reason": Variable("why the branch ends there"),
    "labelled": Variable("whether the figure marks this frequency ratio"),
    # Orbits of the restitution model
    "restitution_amplitude": Variable("excitation amplitude, restitution model", "Λ"),
    "restitution_phase": Variable("phase of impact, restitution model", "φ_CR", "Eq. 6", "rad"),
    "restitution_impact_velocity": Variable(
        "velocity before impact, restitution model", "-nπ", "Eq. 3"
    ),
    "restitution_bounce_velocity": Variable(
        "bouncing-off velocity, restitution model", "nπ", "Eq. 6"
    ),
    "restitution_max_height": Variable("greatest height, restitution model", "max z_CR", "Eq. 37"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_admissible": Variable(
        "whether nothing else happens during the restitution model's orbit"
    ),
    # Bifurcations and other special points
    "saddle_node_amplitude": Variable("amplitude of the saddle-node", "Λ_SN", "Eq. 7"),
    "saddle_node_phase": Variable("phase at the saddle-node", "φ_SN", "Eq. 6", "rad"),
    "period_doubling_amplitude": Variable("amplitude of the period doubling", "Λ_PD", "Eq. 8"),
    "period_doubling_phase": Variable("phase at the period doubling", "φ_PD", "Eq. 6", "rad"),
    "grazing_amplitude": Variable("amplitude at which the unstable orbit grazes the table", "Λ"),
    "grazing_phase": Variable(
        "phase at which the unstable orbit grazes the table", "φ", units="rad"
    ),
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("excitation amplitude at the special point", "Λ"),
    "special_phase": Variable("phase at the special point", "φ", "Eq. 21", "rad"),
    "special_contact_duration": Variable("contact duration at the special point", "τ_b", "Eq. 23"),
    "special_arclength": Variable(
        "arclength of the branch up to the special point, over that of the whole branch"
    ),
    # The lowest doubling is a minimum over ϖ: its place is known to the square root of the
    # precision of the amplitude there, some 1e-13.
    "period_doubling_turn": Variable(
        "frequency ratio at which the period doubling is lowest", "ϖ", tolerance=1e-5
    ),
    # Permanent contact
    "threshold_amplitude": Variable(
        "threshold of permanent contact", "Λ_SD, or Λ_F for the force release", "Eq. 33"
    ),
    "restitution_threshold": Variable(
        "threshold of permanent contact, restitution model", "Λ_CR", "Eq. 9"
    ),
    "minimum_frequency_ratio": Variable("where the lowest threshold is", "1/√(1-2ζ²)", "Eq. 36"),
    "minimum_threshold": Variable("lowest threshold of permanent contact", "2ζ√(1-ζ²)", "Eq. 36"),
    # Errors of the restitution model
    "relative_error": Variable("relative error of the restitution model", "", "Eqs. 37-38"),
    "error_threshold": Variable(
        "frequency ratio above which the relative error stays below the tolerance",
        "ϖ_1%",
        "Eqs. 37-38",
    ),
    "threshold_status": Variable("whether the threshold lies within the range scanned"),
    # Where a frequency ratio is enough. Single precision has seven digits.
    "place": Variable("place between saddle-node (0) and period doubling (1), linear in Λ"),
    "enough_from": Variable(
        "frequency ratio from which on the error stays within the tolerance, or the lowest one "
        "scanned",
        "ϖ",
        tolerance=1e-6,
    ),
    "stiff_error": Variable(
        "largest error at the advised frequency ratio and above; that of the phase is a share of a "
        "period, the others are relative",
        tolerance=1e-6,
    ),
    "not_reached": Variable("number of orbits without an answer"),
    "failing_share": Variable(
        "share of the range of Λ on which the advised frequency ratio is not enough", tolerance=1e-6
    ),
    "failing_mean": Variable("mean of this share over r", tolerance=1e-6),
    "failing_up_to": Variable("r up to which it is not enough for some Λ", "r", tolerance=1e-6),
    "halved_enough_from": Variable(
        "frequency ratio from which on half the tolerance is kept by the orbit that needs most",
        "ϖ",
        tolerance=1e-6,
    ),
    "doubled_share": Variable(
        "share of the range of Λ on which the period has doubled at the advised frequency ratio",
        tolerance=1e-6,
    ),
    "curve": Variable("curve of the paper"),
    "curve_n": Variable("family of the curve", "n"),
    "curve_restitution": Variable("restitution coefficient of the curve", "r"),
    "curve_amplitude": Variable("excitation amplitude of the curve", "Λ"),
    "curve_place": Variable("place of the curve between saddle-node and period doubling"),
    # Table 1
    "computed": Variable("end of the stability range, this replication", "Λ"),
    "printed": Variable("end of the stability range, as printed", "Λ", "Table 1"),
    "restitution_range": Variable("end of the stability range, restitution model", "Λ"),
    # Printed numbers under other readings. Differences in units of the last printed digit subtract
    # two numbers of the same size, so that they are known less well than these.
    "number": Variable("printed number, as the claims name it"),
    "exponent": Variable("exponent of the largest frequency ratio"),
    "agrees": Variable("whether the number found rounds to the printed one"),
    "reproduced": Variable("number of printed numbers within half a unit of the last digit"),
    "compliant_reproduced": Variable("number of these among the ends on the compliant contacts"),
    "largest_difference": Variable("largest distance of these ends, in units", tolerance=1e-6),
    "below_orbits": Variable("number of saddle-nodes printed below every orbit of the equations"),
    "rms_difference": Variable(
        "root mean square distance of the ends of Table 1 on the compliant contacts, in units",
        tolerance=1e-6,
    ),
    "damping_of_82": Variable("ζ with which the height threshold is 81.5 and 82.5", "ζ"),
    "stiff_reproduced": Variable("number of ends of the stiffest row that are reproduced"),
    "mean_difference": Variable(
        "mean distance of the ends on the compliant contacts, in units", tolerance=1e-6
    ),
    "mean_chance": Variable("share of the orders of these distances whose means differ as much"),
    "free_reproduced": Variable("number of ends of a row that any contact reproduces"),
    "free_chance": Variable("share of the orders of the row's distances that fit as well"),
    # Three balls
    "impact": Variable("number of the impact"),
    "impact_time": Variable("time of the impact", "τ", "Eq. 5"),
    "impact_bounce": Variable("velocity of the ball after the impact", "z′", "Eq. 5"),
    "impacts": Variable("impacts until the motion repeats, 0 if it does not"),
    "periods": Variable("periods of the table after which the motion repeats, 0 if it does not"),
    "stickings": Variable("number of impacts after which the ball sticks to the table"),
    # Rounding grows along a chaotic motion until another processor sees another motion, whose
    # averages agree only as well as averages of so many impacts do: five standard errors.
    "lyapunov_exponent": Variable(
        "largest Lyapunov exponent, per period of the table",
        "λ",
        tolerance=5.0,
        tolerance_scale="lyapunov_error",
    ),
    # A standard error from some thirty blocks of impacts is itself known to about 13 %.
    "lyapunov_error": Variable(
        "error of the largest Lyapunov exponent: twice it on both sides are 95 %", tolerance=0.5
    ),
    # Claims
    "verdict": Variable("verdict on the claim"),
    "own_sense": Variable("whether a statement by reading holds in the sense of its own sentence"),
    "item": Variable("figure, table, equation or section of the paper"),
    "statement": Variable("what the claim says"),
    "remark": Variable("how the claim was read"),
    "condition": Variable("condition that decides a statement in words"),
    "group": Variable("what the claim is counted as"),
    "printed_text": Variable("the number as printed"),
    "decided_by": Variable("datasets that decide"),
    "found": Variable("the number found"),
    # Two numbers that agree to three or four digits are subtracted.
    "deviation": Variable("relative deviation", tolerance=1e-6),
    "deviation_units": Variable("deviation in units of the last printed digit", tolerance=1e-6),
    "reason": Variable("why a claim or a motion is undecided"),
}


def grid(limits: Mapping) -> np.ndarray:
    """The values of a range of the configuration, at equal steps of their logarithm.

    >>> grid({"min": 1.0, "max": 100.0, "samples": 3}).tolist()
    [1.0, 10.0, 100.0]
    """
    return np.geomspace(limits["min"], limits["max"], limits["samples"])


def save(
    dataset: xr.Dataset,
    path: str | Path,
    title: str,
    parameters: Mapping,
    code: Iterable[str | Path],
    variables: Mapping[str, Variable] = VARIABLES,
) -> None:
    """Save a dataset as netCDF, with the descriptions of its variables and its provenance.

    `parameters` are the parameters it was computed with, `code` the files of code that computed
    it: the script and the modules of the package that it uses. Their names are recorded with the id
    that git gives to the content of each. The file appears whole or not at all. Raises ValueError
    for a variable that `variables` do not describe.
    """
    path = Path(path)
    files = list(code)
    unknown = [str(name) for name in dataset.variables if name not in variables]
    if unknown:
        raise ValueError(f"{path.name}: VARIABLES has no description of {', '.join(unknown)}")
    described = dataset.drop_encoding().assign_attrs(
        Conventions="CF-1.11",
        title=title,
        references=REFERENCE,
        parameters=json.dumps(plain(parameters), sort_keys=True, ensure_ascii=False),
        commit=commit(files),
        code=json.dumps(contents(files)),
        versions=json.dumps(versions()),
        computed_on=computed_on(),
    )
    for name, variable in described.variables.items():
        variable.attrs = description(variables[str(name)], variable.dtype)
    # The blocks of a small variable need more space than their compression saves.
    large = [name for name, each in described.variables.items() if each.nbytes > 8192]
    packed = {name: {"zlib": True} for name in large if described[name].dtype.kind in "fib"}
    with whole(path) as unfinished:
        described.to_netcdf(unfinished, engine="netcdf4", encoding=packed)


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """The path to write a file to that shall appear at `path` whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.part.{os.getpid()}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def save_stage(
    stage: Mapping[str, Callable[..., xr.Dataset]],
    entries: Mapping[str, Mapping],
    settings: Mapping,
    files: Mapping[str, str],
    code: Iterable[str | Path],
    variables: Mapping[str, Variable] = VARIABLES,
) -> None:
    """Compute and save the datasets of a stage, each by its function in `stage`.

    An entry has the "title" and the "parameters" of its dataset. A function takes the parameters
    and the settings of the whole run. Raises ValueError for an entry without a function.
    """
    missing = [name for name in entries if name not in stage]
    if missing:
        raise ValueError(f"STAGE has no function for {', '.join(missing)}")
    for name, compute in stage.items():
        given = entries[name]["parameters"]
        dataset = compute(given, **settings)
        title = entries[name]["title"]
        save(dataset, files[name], title, {**given, **settings}, code, variables)


def description(variable: Variable, dtype: np.dtype) -> dict[str, str | float]:
    """Attributes of a variable; only floating-point numbers have a tolerance."""
    attributes: dict[str, str | float] = {"long_name": variable.long_name, "units": variable.units}
    if variable.symbol:
        attributes["symbol"] = variable.symbol
    if variable.equation:
        attributes["equation"] = variable.equation
    if dtype.kind == "f":
        attributes["tolerance"] = variable.tolerance
        attributes["floor"] = variable.floor
        if variable.tolerance_scale:
            attributes["tolerance_scale"] = variable.tolerance_scale
    return attributes


def read(path: str | Path) -> xr.Dataset:
    """The dataset of a netCDF file, in memory and with the file closed."""
    return xr.load_dataset(path, engine="netcdf4")


def parameters(dataset: xr.Dataset) -> dict:
    """The parameters with which a dataset was computed; none if it does not say."""
    return json.loads(dataset.attrs.get("parameters", "{}"))


def printed_table(path: str | Path) -> xr.DataArray:
    """The printed ends of Table 1 as texts with their digits, from a CSV file.

    The columns are frequency_ratio, n, saddle-node and period doubling. The result has the
    dimensions frequency_ratio, n and bound; `astype(float)` makes numbers of it.
    """
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    bounds = list(rows[0])[2:]
    ratios = list(dict.fromkeys(float(row["frequency_ratio"]) for row in rows))
    families = list(dict.fromkeys(int(row["n"]) for row in rows))
    texts = np.array([[row[bound] for bound in bounds] for row in rows])
    return xr.DataArray(
        texts.reshape(len(ratios), len(families), len(bounds)),
        {"frequency_ratio": ratios, "n": families, "bound": bounds},
        ("frequency_ratio", "n", "bound"),
    )


def plain(value):
    """Mappings, sequences and numbers as JSON has them, with numpy's numbers as Python's."""
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(each) for each in value]
    return value.item() if isinstance(value, np.generic) else value


@cache
def computed_on() -> str:
    """The platform and the library of linear algebra, on which the last digits of numbers depend.

    It is for the reader of a dataset, and is not compared.
    """
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return f"{platform.platform()}, {blas['name']} {blas['version']}"


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages that numbers and pictures depend on."""
    return {"python": platform.python_version()} | {
        name: metadata.version(name) for name in PACKAGES
    }
