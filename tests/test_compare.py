"""What the comparison must call different, what it must not, and what it says of the cause."""

import io
import json
import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import matplotlib
import netCDF4
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image

from bouncing_ball import claims, compare, datasets, differences, drawing, products

PARAMETERS = {"restitution": 0.65, "frequency_ratio": {"min": 1.0, "max": 10.0}}
STYLE = {"color": "#0072b2"}


def heights() -> xr.Dataset:
    """A dataset with a variable of each kind."""
    ratio = np.linspace(1.0, 10.0, 31)
    height = 3 + np.sin(ratio)
    height[5] = np.nan
    return xr.Dataset(
        {
            "max_height": ("frequency_ratio", height),
            "relative_error": ("frequency_ratio", 1 / ratio**6),
            "stable": ("frequency_ratio", ratio > 4),
            "error_threshold": 82.1774,
            "threshold_status": "found",
            "lyapunov_exponent": 0.3,
            "lyapunov_error": 0.01,
            "impacts": 7,
        },
        {"frequency_ratio": ratio},
    )


def verdicts() -> xr.Dataset:
    """A dataset of two claims."""
    return xr.Dataset(
        {"verdict": ("claim", ["reproduced", "contradicted"]), "found": ("claim", [0.25, 1.0])},
        {"claim": ["stiff limit", "height"]},
    )


def draw(data, folder):
    """Two curves of the dataset with a legend and marks."""
    with drawing.style():
        figure = Figure(figsize=(1.6, 1.2))
        axes = figure.add_subplot()
        heights = data["fig14"].max_height
        axes.plot(heights.frequency_ratio, heights, label="stable", **STYLE)
        axes.plot(heights.frequency_ratio, 4 - 0.2 * heights, "--", color="black", label="unstable")
        axes.plot([2, 3], [3, 3], "o", color="black")
        axes.legend()
        png, svg = (folder / "figures" / f"fig14.{kind}" for kind in ("png", "svg"))
        drawing.save_picture(figure, png, svg, datasets.commit())


def article(data):
    """A text with numbers of two datasets."""
    threshold = float(data["fig14"].error_threshold)
    verdict = ", ".join(data["claims"].verdict.values)
    return f"The threshold is {threshold:.2f}.\nThe verdicts are {verdict}.\n"


PICTURE = compare.Product(("figures/fig14.png", "figures/fig14.svg"), ("fig14",), draw, ())
PAPER = compare.text("paper.md", ("fig14", "claims"), article)


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    """A folder with the files that today's code makes, and that code."""
    folder = tmp_path_factory.mktemp("original")
    for name in ("study.py", "draw.py"):
        (folder / name).write_text(f"# {name}\n")
    (folder / "figures").mkdir()
    code = [folder / "study.py"]
    datasets.save(heights(), folder / "figures" / "fig14.nc", "Figure 14", PARAMETERS, code)
    datasets.save(verdicts(), folder / "figures" / "claims.nc", "Claims", {}, code)
    data = compare.read_all(folder, ["fig14", "claims"])
    for product in (PICTURE, PAPER):
        product.make(data, folder)
    return folder


class Record:
    """A reference and results in folders of their own, which are equal until a test edits them."""

    def __init__(self, folder: Path, original: Path, *without: str):
        self.reference = folder / "reference"
        self.results = folder / "results"
        for place in (self.reference, self.results):
            shutil.copytree(original, place, ignore=shutil.ignore_patterns(*without))
        code = {"parameters": PARAMETERS, "code": [self.reference / "study.py"]}
        self.artifacts = {"fig14": code, "claims": code | {"parameters": {}}}

    def report(self, *names):
        return compare.compare(
            self.results, self.reference, products.PRODUCTS, self.artifacts, names
        )

    def lines(self, *names):
        """The report in one text, or nothing if all agrees."""
        report = self.report(*names)
        return "\n".join(finding.line for finding in report.findings)

    def edit(self, change, name="fig14", side="results"):
        """Rewrite a dataset as `change` returns it."""
        path = getattr(self, side) / "figures" / f"{name}.nc"
        changed = change(datasets.read(path))
        changed.to_netcdf(path, engine="netcdf4")

    def rewrite(self, file, old, new, side="results"):
        """Replace the first occurrence of a text in a file."""
        path = getattr(self, side) / file
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")


@pytest.fixture
def record(tmp_path, original, monkeypatch):
    """Datasets and a text; without a picture a comparison takes no time."""
    monkeypatch.setattr(products, "PRODUCTS", [PAPER])
    return Record(tmp_path, original, "*.png", "*.svg")


@pytest.fixture
def drawn(record, tmp_path, original, monkeypatch):
    """Datasets, a text and a picture."""
    monkeypatch.setattr(products, "PRODUCTS", [PICTURE, PAPER])
    return Record(tmp_path / "drawn", original)


def scaled(name, factor, where=slice(None)):
    """A change that multiplies values of a variable."""

    def change(data):
        values = data[name].values.copy()
        values[where] = values[where] * factor
        return data.assign({name: data[name].copy(data=values)})

    return change


def attribute(name, key, value):
    """A change of an attribute of a variable."""

    def change(data):
        data[name].attrs[key] = value
        return data

    return change


# Truths


def test_equal_results_are_one_green_line(drawn):
    report = drawn.report()
    assert report.findings == []
    assert report.lines == ["All 5 files agree with the reference."]


def test_rounding_and_other_versions_of_the_code_of_the_reference_are_no_difference(drawn):
    drawn.edit(scaled("max_height", 1 + 1e-11))
    drawn.edit(scaled("relative_error", 1 + 1e-7, slice(20, None)))
    drawn.edit(lambda data: data.assign_attrs(commit="old", code="old"), side="reference")
    drawn.edit(lambda data: data[sorted(data.variables, reverse=True)])
    PICTURE.make(compare.read_all(drawn.results, ["fig14"]), drawn.results)
    assert drawn.lines() == ""


def test_line_ends_of_windows_are_no_difference(drawn):
    for file in ("paper.md", "figures/fig14.svg"):
        path = drawn.reference / file
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert drawn.lines() == ""


def test_signed_zeros_are_equal(record):
    record.edit(scaled("error_threshold", 0.0, ()), side="reference")
    record.edit(scaled("error_threshold", -0.0, ()))
    assert "error_threshold" not in record.lines()


def test_a_user_setting_of_matplotlib_changes_nothing(drawn):
    with matplotlib.rc_context({"axes.grid": True, "axes.spines.left": False}):
        assert drawn.lines() == ""


# Datasets

DATASET_LIES = {
    "a number": (
        scaled("error_threshold", 1 + 1e-4, ()),
        "error_threshold is 82.19, the reference has 82.18 (tolerance 8.2e-08, exceeded",
    ),
    "one of many": (
        scaled("max_height", 1.5, 3),
        r"max_height is 5.919, the reference has 3.946 at frequency_ratio = 1.9",
    ),
    "a small entry beside large ones": (scaled("relative_error", 2, 18), "relative_error is"),
    "a NaN": (scaled("max_height", np.nan, 3), "max_height is nan, the reference has 3.946"),
    "a number for NaN": (
        lambda data: data.assign(max_height=data.max_height.fillna(1.0)),
        "max_height is 1, the reference has nan",
    ),
    "an infinity": (scaled("max_height", np.inf, 3), "max_height is inf"),
    "a flag": (
        lambda data: data.assign(stable=data.stable.copy(data=~data.stable.values)),
        "stable is True, the reference has False at frequency_ratio = 1.0, and 30 more of 31",
    ),
    "an integer": (lambda data: data.assign(impacts=data.impacts + 1), "impacts is 8"),
    "a word": (
        lambda data: data.assign(threshold_status=data.threshold_status.copy(data="above")),
        "threshold_status is above, the reference has found",
    ),
    "five standard errors": (scaled("lyapunov_exponent", 1.2, ()), "lyapunov_exponent is 0.36"),
    "single precision": (
        lambda data: data.assign(max_height=data.max_height.astype("float32")),
        "max_height has type float32, in the reference float64",
    ),
    "a unit": (attribute("max_height", "units", "m"), "attribute units of max_height is 'm'"),
    "a long name": (attribute("stable", "long_name", "x"), "attribute long_name of stable"),
    "a new attribute": (attribute("stable", "note", "x"), "attribute note of stable is 'x'"),
    "a raised tolerance": (
        attribute("max_height", "tolerance", 1.0),
        "attribute tolerance of max_height is np.float64(1.0), in the reference np.float64(1e-09)",
    ),
    "an attribute of the dataset": (
        lambda data: data.assign_attrs(title="x"),
        "attribute title of the dataset is 'x'",
    ),
    "a new variable": (lambda data: data.assign(n=1), "n is not in the reference"),
    "a missing variable": (lambda data: data.drop_vars("impacts"), "impacts is missing"),
    "a renamed variable": (
        lambda data: data.rename(max_height="height"),
        "max_height is missing; height has its values: is it renamed?",
    ),
    "a variable as a coordinate": (
        lambda data: data.set_coords("impacts"),
        "impacts has role coordinate, in the reference variable",
    ),
    "a moved coordinate": (
        lambda data: data.assign_coords(frequency_ratio=data.frequency_ratio + 1e-6),
        "frequency_ratio is 1.000001, the reference has 1",
    ),
    "reversed values": (
        lambda data: data.isel(frequency_ratio=slice(None, None, -1)),
        "frequency_ratio is 10, the reference has 1",
    ),
    "fewer points": (
        lambda data: data.isel(frequency_ratio=slice(30)),
        "frequency_ratio: without 10.0; the other 30 agree",
    ),
}


@pytest.mark.parametrize("lie", DATASET_LIES)
def test_a_changed_dataset_is_different(record, lie):
    change, said = DATASET_LIES[lie]
    record.edit(change)
    assert f"fig14: {said}" in record.lines("fig14")


def test_packed_values_are_different(record):
    def packed(data):
        data.max_height.encoding = {"dtype": "int16", "scale_factor": 1e-4, "_FillValue": -1}
        return data

    record.edit(packed)
    assert "max_height has storage" in record.lines()


def test_a_hidden_group_is_different(record):
    with netCDF4.Dataset(record.results / "figures" / "fig14.nc", "a") as file:
        file.createGroup("hidden")
    assert "figures/fig14.nc of the results cannot be read, or has groups" in record.lines()


def test_a_changed_verdict_comes_first(record):
    record.edit(scaled("error_threshold", 1 + 1e-4, ()))
    record.edit(
        lambda data: data.assign(verdict=("claim", ["reproduced", "undecidable"])), "claims"
    )
    assert (
        record.report()
        .lines[0]
        .startswith(
            "claims: verdict is undecidable, the reference has contradicted at claim = height"
        )
    )


def test_a_damaged_dataset_is_one_line(record):
    (record.results / "figures" / "fig14.nc").write_bytes(b"no netCDF")
    assert "figures/fig14.nc of the results cannot be read" in record.lines()


# Results of something else


def test_results_of_other_parameters_are_stale(record):
    record.artifacts["fig14"] |= {"parameters": PARAMETERS | {"restitution": 0.7}}
    assert record.report().lines[0] == (
        "fig14: stale: the configuration is another than it was made with: restitution 0.65 -> 0.7"
    )


def test_results_of_other_code_are_stale(record):
    (record.reference / "study.py").write_text("# edited\n")
    assert "fig14: stale: it was made by other code than today's" in record.lines()


def test_a_changed_parameter_is_the_cause(record):
    changed = PARAMETERS | {"frequency_ratio": {"min": 1.0, "max": 20.0}}
    record.artifacts["fig14"] |= {"parameters": changed}
    record.edit(lambda data: data.assign_attrs(parameters=json.dumps(changed)))
    record.edit(scaled("error_threshold", 2, ()))
    assert (
        record.report("fig14")
        .lines[0]
        .endswith(
            "; changed parameter: frequency_ratio.max 10.0 -> 20.0"
            "; changes of the code are unknown without git"
        )
    )


def test_only_a_changed_parameter_is_a_difference(record):
    record.edit(lambda data: data.assign_attrs(parameters="{}"))
    assert "fig14: its parameters changed, and its values did not" in record.lines("fig14")


def test_results_without_a_reference_may_be_stale(record):
    (record.reference / "figures" / "fig14.nc").unlink()
    (record.reference / "study.py").write_text("# edited\n")
    assert "fig14: stale: it was made by other code than today's" in record.lines("fig14")


def test_a_name_that_is_not_compared_is_refused(record):
    with pytest.raises(ValueError, match=r"^fig17: no file of that name .* are claims, fig14, p"):
        record.report("fig17", "fig14")


def test_results_that_are_the_reference_are_refused(record):
    shutil.rmtree(record.results)
    for target in (record.reference, record.reference / "figures"):
        record.results.symlink_to(target)
        with pytest.raises(ValueError, match="is a part of the reference"):
            record.report()
        record.results.unlink()


def test_a_result_that_is_linked_to_the_reference_is_refused(record):
    path = record.results / "figures" / "fig14.nc"
    path.unlink()
    os.link(record.reference / "figures" / "fig14.nc", path)
    with pytest.raises(ValueError, match=r"fig14.nc is a part of the reference"):
        record.report()


@pytest.mark.parametrize("side", ["reference", "results"])
def test_missing_and_unexpected_files_are_different(drawn, side):
    folder = getattr(drawn, side)
    (folder / "figures" / "fig14.svg").unlink()
    (folder / "figures" / "fig17.png").write_bytes(b"")
    (folder / "figures" / ".DS_Store").write_bytes(b"")
    lines = drawn.lines()
    assert f"figures/fig14.svg is missing in the {side}" in lines
    assert f"figures/fig17.png of the {side} is made by no rule" in lines
    assert "DS_Store" not in lines


def test_only_what_is_named_is_compared(record):
    record.edit(scaled("found", 2), "claims")
    assert record.lines("fig14") == ""
    assert "paper" not in record.lines("claims")


# Texts and pictures

WORDS = {
    "reference": "today's code makes another {} of the reference: ",
    "results": "{} in the results is not what its dataset gives: ",
}


@pytest.mark.parametrize("side", ["reference", "results"])
def test_edited_texts_and_pictures_are_different(drawn, side):
    drawn.rewrite("paper.md", "82.18", "82.19", side)
    drawn.rewrite("figures/fig14.svg", "stroke-width: 1.2", "stroke-width: 1.21", side)
    lines = drawn.lines()
    assert f"paper: {WORDS[side].format('paper.md')}" in lines
    assert f"fig14: {WORDS[side].format('figures/fig14.svg')}" in lines


@pytest.mark.parametrize(
    ("old", "new"), [("82.18", "82.1"), ("The", "A"), ("reproduced, ", ""), ("\n", "")]
)
def test_an_edited_text_is_different(original, tmp_path, old, new):
    made = original / "paper.md"
    path = tmp_path / "paper.md"
    path.write_text(made.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    assert differences.file_difference(made, made, loosely=False) is None
    assert differences.file_difference(made, path, loosely=False).kind == "text"


def test_a_text_that_is_written_otherwise_is_different(record, monkeypatch):
    def floor(data):
        return article(data).replace("82.18", "82.17")

    changed = compare.text("paper.md", ("fig14", "claims"), floor)
    monkeypatch.setattr(products, "PRODUCTS", [changed])
    finding = record.report().findings[0]
    assert "-The threshold is 82.18.\n+The threshold is 82.17." in finding.lines


def test_a_number_that_rounds_otherwise_within_its_tolerance_is_no_difference(record):
    for side, value in (("reference", 82.175 - 1e-10), ("results", 82.175 + 1e-10)):
        record.edit(lambda data, value=value: data.assign(error_threshold=value), side=side)
        data = compare.read_all(getattr(record, side), ["fig14", "claims"])
        PAPER.make(data, getattr(record, side))
    texts = [(folder / "paper.md").read_text() for folder in (record.reference, record.results)]
    assert texts[0] != texts[1]
    assert "paper" not in record.lines()


SVG_LIES = {
    "a removed path": (r"<path [^>]*stroke: #0072b2[^>]*/>", ""),
    "a shorter path": (r"\nL [\d. ]+\n\" clip-path", '\n" clip-path'),
    "another colour": ("#0072b2", "#000000"),
    "dashes": ("stroke-dasharray: [^;]*;", ""),
    "a width": ("stroke-width: 1.2", "stroke-width: 1.21"),
    "opacity": ("stroke: #0072b2", "opacity: 0; stroke: #0072b2"),
    "a word": ("<!-- stable -->", "<!-- steady -->"),
    "a script": ("</svg>", "<script>alert(1)</script></svg>"),
    "a mark elsewhere": (
        r'(<use xlink:href="#m\w*" x=")(\d+)(\.\d+" y="[\d.]+" style="stroke: #000000"/>)',
        r"\g<1>9\2\3",
    ),
}


@pytest.mark.parametrize("lie", SVG_LIES)
@pytest.mark.parametrize("loosely", [False, True])
def test_an_edited_svg_is_different(original, tmp_path, lie, loosely):
    made = original / "figures" / "fig14.svg"
    edited, count = re.subn(*SVG_LIES[lie], made.read_text(encoding="utf-8"), count=1)
    assert count == 1
    path = tmp_path / "fig14.svg"
    path.write_text(edited, encoding="utf-8")
    assert differences.file_difference(made, made, loosely) is None
    assert differences.file_difference(made, path, loosely).kind == "picture"


def one_grey_level(pixels):
    return np.where(pixels > 0, pixels - 1, pixels).astype("uint8")


def one_pixel(pixels):
    pixels = pixels.copy()
    pixels[50, 50, :3] = 255 - pixels[50, 50, :3]
    return pixels


@pytest.mark.parametrize("change", [one_grey_level, one_pixel, np.flipud])
def test_edited_pixels_are_different(original, tmp_path, change):
    made = original / "figures" / "fig14.png"
    path = tmp_path / "fig14.png"
    with Image.open(made) as image:
        Image.fromarray(change(np.asarray(image))).save(path)
    assert differences.file_difference(made, made, loosely=False) is None
    finding = differences.file_difference(made, path, loosely=False)
    assert "pixels differ" in finding.text
    assert len(finding.images) == 3


def test_a_png_with_more_than_its_pixels_is_different(original, tmp_path):
    made = original / "figures" / "fig14.png"
    path = tmp_path / "fig14.png"
    with Image.open(made) as image:
        black = Image.new("RGBA", image.size, "black")
        image.save(path, save_all=True, append_images=[black], default_image=False)
    assert "its chunks: IHDR" in differences.file_difference(made, path, loosely=False).text
    data = made.read_bytes()
    gamma = bytes.fromhex("0000000467414d410000b18f0bfc6105")
    path.write_bytes(data[:33] + gamma + data[33:])
    assert "its chunks: IHDR gAMA" in differences.file_difference(made, path, loosely=False).text
    path.write_bytes(data[:500])
    assert differences.file_difference(made, path, loosely=False).kind == "file"


def test_a_picture_that_is_older_than_its_dataset_is_different(drawn):
    drawn.edit(scaled("max_height", 1.01))
    drawn.edit(scaled("max_height", 1.01), side="reference")
    PICTURE.make(compare.read_all(drawn.reference, ["fig14"]), drawn.reference)
    lines = drawn.lines()
    assert "figures/fig14.png in the results is not what its dataset gives" in lines
    assert "figures/fig14.svg in the results is not what its dataset gives" in lines
    assert "in the reference" not in lines


def test_code_that_cannot_draw_the_reference_is_one_line(drawn):
    drawn.edit(lambda data: data.drop_vars("max_height"), side="reference")
    assert "today's code cannot make it of the dataset in the reference" in drawn.lines()


# Another matplotlib


@pytest.fixture
def older(drawn):
    """The reference names another matplotlib."""
    versions = datasets.versions() | {"matplotlib": "3.10.0"}
    for name in ("fig14", "claims"):
        drawn.edit(
            lambda data: data.assign_attrs(versions=json.dumps(versions)), name, side="reference"
        )
    return drawn


def test_another_matplotlib_is_another_green(older):
    report = older.report()
    assert report.findings == []
    assert report.lines[-1].endswith("by strokes, fills, words and curves, and not by pixels.")


def test_small_moves_of_another_matplotlib_are_no_difference(older):
    path = older.reference / "figures" / "fig14.svg"

    def moved(match):
        return f"{match[1]} {float(match[2]) + 0.6:.6f} {float(match[3]) - 0.6:.6f}"

    text = re.sub(r"([ML]) (\d[\d.]*) (\d[\d.]*)", moved, path.read_text(encoding="utf-8"))
    path.write_text(text, encoding="utf-8")
    assert older.lines() == ""


def test_another_matplotlib_is_no_excuse(older):
    older.rewrite("figures/fig14.svg", "stroke: #0072b2", "stroke: #c77c00", "reference")
    assert "fig14: today's code makes another figures/fig14.svg of the reference" in older.lines()


# Causes


def git(folder, *arguments):
    identity = ["-c", "user.name=A", "-c", "user.email=a@b.c"]
    command = ["git", "-C", str(folder), *identity, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def committed(record):
    """The reference in a checkout of a branch, made at the first commit."""
    git(record.reference, "init", "-q", "-b", "main")
    git(record.reference, "add", ".")
    git(record.reference, "commit", "-q", "-m", "code")
    commit = git(record.reference, "rev-parse", "HEAD")
    for name in ("fig14", "claims"):
        for side in ("reference", "results"):
            record.edit(lambda data: data.assign_attrs(commit=commit), name, side=side)
    git(record.reference, "commit", "-q", "-a", "-m", "reference")
    record.edit(scaled("error_threshold", 2, ()))
    return record


def the_cause(record):
    findings = record.report("fig14").findings
    return next(each.cause for each in findings if each.kind == "number")


def test_without_git_causes_are_unknown(record, monkeypatch):
    record.edit(scaled("error_threshold", 2, ()))
    assert the_cause(record) == "changes of the code are unknown without git"
    monkeypatch.setenv("PATH", "")
    assert the_cause(record) == "changes of the code are unknown without git"


def test_causes_are_files_of_the_rule_that_git_knows_to_have_changed(committed):
    folder = committed.reference
    (folder / "README").write_text("")
    git(folder, "add", ".")
    assert the_cause(committed) == "no file that it is made from has changed"
    (folder / "study.py").write_text("# two\n")
    git(folder, "commit", "-q", "-a", "-m", "two")
    assert the_cause(committed) == "also changed since the reference was made: study.py"
    git(folder, "checkout", "-q", "-b", "branch")
    (folder / "study.py").write_text("# three\n")
    git(folder, "commit", "-q", "-a", "-m", "three")
    assert the_cause(committed) == "changed: study.py (on this branch)"
    (folder / "study.py").write_text("# four\n")
    assert the_cause(committed) == "changed: study.py (not committed)"


def test_a_changed_file_does_not_hide_behind_a_changed_parameter(committed):
    changed = json.dumps(PARAMETERS | {"restitution": 0.7})
    committed.edit(lambda data: data.assign_attrs(parameters=changed))
    (committed.reference / "study.py").write_text("# two\n")
    assert the_cause(committed) == (
        "changed parameter: restitution 0.65 -> 0.7; changed: study.py (not committed)"
    )


def test_the_first_line_is_about_the_most_exceeded_tolerance_and_names_the_file(committed):
    (committed.reference / "study.py").write_text("# two\n")
    committed.edit(scaled("max_height", 10))
    lines = [finding.line for finding in committed.report("fig14").findings]
    numbers = [line for line in lines if "exceeded" in line]
    assert numbers[0].startswith("fig14: max_height is ")
    assert numbers[0].endswith("; changed: study.py (not committed)")
    assert numbers[1].startswith("fig14: error_threshold is ") and "study.py" not in numbers[1]


def test_code_that_cannot_draw_the_reference_is_named(drawn, monkeypatch):
    git(drawn.reference, "init", "-q", "-b", "main")
    code = drawn.reference / "draw.py"
    git(drawn.reference, "add", ".")
    git(drawn.reference, "commit", "-q", "-m", "code")
    code.write_text("# two\n")

    def failing(data, folder):
        raise KeyError("heights")

    changed = compare.Product(PICTURE.files, ("fig14",), failing, (code,))
    monkeypatch.setattr(products, "PRODUCTS", [changed, PAPER])
    assert drawn.report().lines[0] == (
        "fig14: today's code cannot make it of the dataset in the reference: KeyError('heights'); "
        "changed: draw.py (not committed)"
    )


def test_a_changed_text_is_blamed_for_the_text_only(committed, monkeypatch):
    committed.edit(scaled("error_threshold", 0.5, ()))
    code = committed.reference / "draw.py"
    code.write_text("# two\n")
    needs = ("fig14", "claims")
    changed = compare.text("paper.md", needs, lambda data: "The threshold.\n", (code,))
    monkeypatch.setattr(products, "PRODUCTS", [changed])
    assert committed.report().lines[0] == (
        "paper: today's code makes another paper.md of the reference: line 1: "
        "'The threshold is 82.18.\\n' -> 'The threshold.\\n'; changed: draw.py (not committed)"
    )


# The page


def test_the_page_has_all_findings_and_needs_no_other_file(drawn):
    drawn.edit(scaled("error_threshold", 1.01, ()))
    PICTURE.make(compare.read_all(drawn.results, ["fig14"]), drawn.results)
    PAPER.make(compare.read_all(drawn.results, ["fig14", "claims"]), drawn.results)
    drawn.rewrite("figures/fig14.svg", "#0072b2", "<&>", "reference")
    template = Path(__file__).parents[1] / "workflow" / "templates" / "diff.html.j2"
    report = drawn.report()
    page = compare.page(report, template)
    assert "Numbers beyond their tolerance" in page
    assert "error_threshold is 83, the reference has 82.18" in page
    assert "+The threshold is 83.00." in page
    assert "&lt;&amp;&gt;" in page
    assert not re.search(r'(src|href)="(?!data:)', page)


# The results become the reference


@pytest.fixture
def clean(committed):
    """Results that differ, and follow from committed code."""
    data = compare.read_all(committed.results, ["fig14", "claims"])
    PAPER.make(data, committed.results)
    return committed


def accepted(record):
    return compare.accept(record.results, record.reference, products.PRODUCTS, record.artifacts)


def test_a_picture_is_accepted_with_its_dataset(drawn, monkeypatch):
    git(drawn.reference, "init", "-q")
    git(drawn.reference, "add", ".")
    git(drawn.reference, "commit", "-q", "-m", "code")
    drawn.edit(scaled("max_height", 1.01))
    PICTURE.make(compare.read_all(drawn.results, ["fig14"]), drawn.results)
    assert accepted(drawn) == ["figures/fig14.nc", "figures/fig14.png", "figures/fig14.svg"]
    assert drawn.lines() == ""


def test_accepted_results_are_the_reference(clean):
    assert accepted(clean) == ["figures/fig14.nc", "paper.md"]
    assert clean.lines() == ""
    assert accepted(clean) == []


def test_a_stale_dataset_that_the_reference_lacks_is_not_accepted(clean):
    path = clean.reference / "figures" / "fig14.nc"
    path.unlink()
    git(clean.reference, "commit", "-q", "-a", "-m", "without")
    clean.artifacts["fig14"] |= {"parameters": PARAMETERS | {"restitution": 0.7}}
    with pytest.raises(ValueError, match="fig14: stale: the configuration"):
        accepted(clean)
    assert not path.exists()


@pytest.fixture
def run(clean, monkeypatch):
    """Run a script as Snakemake does; returns its exit status, what it prints and its log."""
    monkeypatch.chdir(clean.results.parent)
    scripts = Path(__file__).parents[1] / "workflow" / "scripts"
    log = Path("log")

    def script(name, *names, given=MappingProxyType({"release": "displacement"})):
        params = SimpleNamespace(
            results=clean.results,
            reference=clean.reference,
            artifacts=clean.artifacts,
            names=list(names),
            config=given,
            accepted={"release": "displacement"},
        )
        log.unlink(missing_ok=True)
        monkeypatch.setattr(sys, "path", [*sys.path])
        monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), "utf-8"))
        status = 0
        try:
            names = {"snakemake": SimpleNamespace(params=params, log=[str(log)])}
            runpy.run_path(str(scripts / f"{name}.py"), names, "__main__")
        except SystemExit as end:
            status = end.code
        sys.stdout.seek(0)
        return status, sys.stdout.read(), log.read_text("utf-8") if log.exists() else ""

    return script


def test_the_log_has_the_verdict_and_then_the_first_lines(run):
    status, printed, log = run("compare")
    assert status == 1
    verdict, first = log.splitlines()
    assert verdict.startswith("Differences: 1, in fig14.")
    assert first.startswith("fig14: error_threshold is ")
    assert printed.startswith(first)


def test_accept_says_whether_it_wrote_something(run):
    assert run("accept")[:2] == (
        0,
        "figures/fig14.nc\npaper.md\n2 files of the reference were written.\n",
    )
    assert run("accept")[:2] == (
        0,
        "Nothing was written, because the reference has these results already.\n",
    )


@pytest.mark.parametrize("script", ["compare", "accept"])
def test_a_refused_name_is_the_message_and_the_log_and_nothing_else(run, script):
    status, printed, log = run(script, "fig17")
    assert status == log and printed == ""
    assert log == "fig17: no file of that name is compared; allowed are claims, fig14, paper"


def test_results_of_another_configuration_are_not_accepted(run):
    status, printed, log = run("accept", given={"release": "force"})
    assert status == log == "config/config.yaml has another release than this run"
    assert printed == ""


def test_a_reference_that_was_edited_is_named(committed):
    file = committed.reference / "figures" / "fig14.nc"
    data = xr.load_dataset(file)
    data["max_height"] = data["max_height"] * 2
    data.to_netcdf(file)
    assert the_cause(committed) == "changed: figures/fig14.nc (not committed)"


def test_other_claims_follow_from_other_numbers():
    number = differences.Finding("number", "a number", artifact="fig14", cause="changed: orbits.py")
    verdict = differences.Finding("verdict", "a verdict", artifact="claims", cause="old")
    assert [each.cause for each in compare.derived([verdict, number], ["fig14"])] == [
        "follows from fig14: changed: orbits.py",
        "changed: orbits.py",
    ]
    assert [*compare.derived([verdict], ["fig14"])] == [verdict]


def test_nothing_is_accepted_that_does_not_follow_from_committed_code(clean):
    reference = clean.reference / "figures" / "fig14.nc"
    before = reference.read_bytes()

    def refused(match):
        with pytest.raises(ValueError, match=match):
            accepted(clean)
        assert reference.read_bytes() == before

    clean.rewrite("paper.md", "The", "A")
    refused("paper.md in the results is not what its dataset gives")
    (clean.results / "paper.md").unlink()
    refused("paper.md is missing in the results")
    clean.artifacts["fig14"] |= {"parameters": PARAMETERS | {"restitution": 0.7}}
    refused("stale: the configuration")
    clean.artifacts["fig14"].pop("code")
    refused("stale|not known")
    (clean.reference / "src").mkdir()
    (clean.reference / "src" / "new.py").write_text("")
    refused("commit first: .* src/new.py")
    shutil.rmtree(clean.reference / ".git")
    refused("the commit of the code is unknown")


# The claims of what is accepted

ROOT = Path(__file__).parents[1]


def test_claims_are_judged_anew_from_the_datasets_of_a_folder(tmp_path):
    data = compare.read_all(ROOT, products.ALL)
    (tmp_path / "figures").mkdir()
    products.judge(data, tmp_path)
    judged = datasets.read(tmp_path / "figures" / "claims.nc")
    printed = datasets.printed_table(ROOT / "config" / "table1_printed.csv")
    xr.testing.assert_equal(judged, claims.judge(data, printed))
    assert judged.attrs["title"] == data["claims"].attrs["title"]


@pytest.fixture
def judging(clean, monkeypatch):
    """As `clean`, with claims of which the second follows from the threshold."""

    def judge(data, folder):
        right = float(data["fig14"].error_threshold) < 1000
        verdict = ["reproduced", "contradicted" if right else "reproduced"]
        judged = verdicts().assign(verdict=("claim", verdict))
        datasets.save(judged, folder / "figures" / "claims.nc", "Claims", {}, [])

    product = compare.Product(("figures/claims.nc",), ("fig14",), judge, ())
    monkeypatch.setattr(products, "PRODUCTS", [product, PAPER])
    return clean


def test_claims_that_stay_as_they_are_stay_in_the_reference(judging):
    path = judging.reference / "figures" / "claims.nc"
    before = path.read_bytes()
    assert accepted(judging) == ["figures/fig14.nc", "paper.md"]
    assert path.read_bytes() == before


def test_claims_change_with_the_dataset_that_decides_them(judging):
    judging.edit(scaled("error_threshold", 100, ()))
    data = compare.read_all(judging.results, ["fig14"])
    (judged,) = (product for product in products.PRODUCTS if product.artifact == "claims")
    # The results still have the claims of before.
    with pytest.raises(ValueError, match=r"figures/claims\.nc in the results is not what"):
        accepted(judging)
    judged.make(data, judging.results)
    judging.edit(
        lambda made: made.assign_attrs(code=datasets.digest([judging.reference / "study.py"])),
        "claims",
    )
    PAPER.make(compare.read_all(judging.results, ["fig14", "claims"]), judging.results)
    assert accepted(judging) == ["figures/claims.nc", "figures/fig14.nc", "paper.md"]
    assert judging.lines() == ""
