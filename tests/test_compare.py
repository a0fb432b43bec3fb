"""What the comparison must call different, what it must not, and what becomes of accepted results.

What it says of causes is tested in test_causes.py.
"""

import fcntl
import json
import os
import re
import shutil
import sys
import zlib
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import netCDF4
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image
from tests.repository import commit

from bouncing_ball import accept, artifacts, claims, compare, datasets, drawing, products
from bouncing_ball.differences import file_differences
from bouncing_ball.history import CHECKOUT

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


def draw(data):
    """Two curves of the dataset and marks."""
    with drawing.style():
        figure = Figure(figsize=(1.2, 1.0), dpi=60)
        axes = figure.add_subplot()
        heights = data["light"].max_height
        axes.plot(heights.frequency_ratio, heights, **STYLE)
        axes.plot(heights.frequency_ratio, 4 - 0.2 * heights, "--", color="black")
        axes.plot([2, 3], [3, 3], "o", color="black")
        axes.set(xticks=[], yticks=[], xlabel="ratio")
    return figure


def article(data):
    """A text with numbers of two datasets."""
    threshold = float(data["light"].error_threshold)
    verdict = ", ".join(data["claims"].verdict.values)
    return f"The threshold is {threshold:.2f}.\nThe verdicts are {verdict}.\n"


PICTURE = artifacts.picture("light", ("light",), draw, ())
PAPER = artifacts.text("paper.md", ("light", "claims"), article)


def data_of(folder):
    """The datasets of a folder that can be read."""
    return artifacts.read_side("", folder, ["light", "claims"]).data


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    """A folder with the files that today's code makes, and that code."""
    folder = tmp_path_factory.mktemp("original")
    for name in ("study.py", "draw.py"):
        (folder / name).write_text(f"# {name}\n")
    (folder / "figures").mkdir()
    code = [folder / "study.py"]
    datasets.save(heights(), folder / "figures" / "light.nc", "Light", PARAMETERS, code)
    datasets.save(verdicts(), folder / "figures" / "claims.nc", "Claims", {}, code)
    for product in (PICTURE, PAPER):
        product.make(data_of(folder), folder)
    return folder


class Record:
    """A reference and results in folders of their own, which are equal until a test edits them."""

    def __init__(self, folder: Path, original: Path, *without: str):
        self.reference = folder / "reference"
        self.results = folder / "results"
        for place in (self.reference, self.results):
            shutil.copytree(original, place, ignore=shutil.ignore_patterns(*without))
        self.config = {"release": "displacement", "stage": {"light": PARAMETERS}}
        self.products = [PAPER]

    def report(self, *names):
        return compare.Comparison(*self.arguments, names, self.reference)

    @property
    def arguments(self):
        return self.results, self.reference, self.products, self.config

    def lines(self, *names):
        """The report in one text, or nothing if all agrees."""
        report = self.report(*names)
        return "\n".join(finding.line for finding in report.findings)

    def edit(self, change, name="light", side="results"):
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
def record(tmp_path, original):
    """Datasets and a text; without a picture a comparison takes no time."""
    return Record(tmp_path, original, "*.png", "*.svg")


@pytest.fixture
def drawn(tmp_path, original):
    """Datasets, a text and a picture."""
    found = Record(tmp_path / "drawn", original)
    found.products = [PICTURE, PAPER]
    return found


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
    drawn.edit(scaled("lyapunov_exponent", 0.0, ()), side="reference")
    drawn.edit(scaled("lyapunov_exponent", -0.0, ()))
    old = {"commit": "old", "code": '{"old.py": "0"}', "computed_on": "old"}
    drawn.edit(lambda data: data.assign_attrs(old), side="reference")
    drawn.edit(lambda data: data[sorted(data.variables, reverse=True)])
    PICTURE.make(data_of(drawn.results), drawn.results)
    assert drawn.lines() == ""


def test_line_ends_of_windows_are_no_difference(drawn):
    for file in ("paper.md", "figures/light.svg"):
        path = drawn.reference / file
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert drawn.lines() == ""


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
        "stable is True, the reference has False at frequency_ratio = 1, and 30 more of 31",
    ),
    "an integer": (lambda data: data.assign(impacts=data.impacts + 1), "impacts is 8"),
    "a word": (
        lambda data: data.assign(threshold_status=data.threshold_status.copy(data="above")),
        "threshold_status is 'above', the reference has 'found'",
    ),
    "five standard errors": (scaled("lyapunov_exponent", 1.2, ()), "lyapunov_exponent is 0.36"),
    "single precision": (
        lambda data: data.assign(max_height=data.max_height.astype("float32")),
        "max_height.type float64 -> float32",
    ),
    "a unit": (attribute("max_height", "units", "m"), "max_height.units 1 -> m"),
    "a long name": (attribute("stable", "long_name", "x"), "stable.long_name whether"),
    "a new attribute": (attribute("stable", "note", "x"), "stable.note absent -> x"),
    "a raised tolerance": (
        attribute("max_height", "tolerance", 1.0),
        "max_height.tolerance 1e-09 -> 1.0",
    ),
    "an attribute of the dataset": (
        lambda data: data.assign_attrs(title="x"),
        "title Light -> x",
    ),
    "a new variable": (lambda data: data.assign(n=1), "variables: new 'n'"),
    "a missing variable": (lambda data: data.drop_vars("impacts"), "variables: without 'impacts'"),
    "a renamed variable": (
        lambda data: data.rename(max_height="height"),
        "variables: new 'height', without 'max_height'",
    ),
    "a variable as a coordinate": (
        lambda data: data.set_coords("impacts"),
        "impacts.role variable -> coordinate",
    ),
    "a moved coordinate": (
        lambda data: data.assign_coords(frequency_ratio=data.frequency_ratio + 1e-6),
        "frequency_ratio is 1.000001, the reference has 1",
    ),
    "reversed values": (
        lambda data: data.isel(frequency_ratio=slice(None, None, -1)),
        "frequency_ratio: the order changed; the 31 agree",
    ),
    "fewer points": (
        lambda data: data.isel(frequency_ratio=slice(30)),
        "frequency_ratio: without 10; the other 30 agree",
    ),
}


@pytest.mark.parametrize("lie", DATASET_LIES)
def test_a_changed_dataset_is_different(record, lie):
    change, said = DATASET_LIES[lie]
    record.edit(change)
    assert f"light: {said}" in record.lines("light")


def test_packed_values_are_different(record):
    def packed(data):
        data.max_height.encoding = {"dtype": "int16", "scale_factor": 1e-4, "_FillValue": -1}
        return data

    record.edit(packed)
    assert "max_height.storage.scale_factor absent -> 0.0001" in record.lines()


def test_a_hidden_group_is_different(record):
    with netCDF4.Dataset(record.results / "figures" / "light.nc", "a") as file:
        file.createGroup("hidden")
    words = "it has the format NETCDF4 with groups or unlimited dimensions: hidden"
    assert f"cannot be read: ValueError: {words}" in record.lines()


def test_a_changed_verdict_comes_first(record):
    record.edit(scaled("error_threshold", 1 + 1e-4, ()))
    changed = xr.DataArray(["reproduced", "a longer word"], dims="claim")
    record.edit(
        lambda data: data.assign(verdict=changed.assign_attrs(data.verdict.attrs)), "claims"
    )
    line = "claims: verdict is 'a longer word', the reference has 'contradicted' at claim = "
    assert record.report().lines[0].startswith(line)
    changed = [each for each in record.report().findings if each.artifact == "claims"]
    assert [each.variable for each in changed] == ["verdict"]


def test_a_damaged_dataset_is_one_line(record):
    (record.results / "figures" / "light.nc").write_bytes(b"no netCDF")
    assert "figures/light.nc in the results cannot be read" in record.lines()


# Results of something else


def test_results_of_other_parameters_are_stale(record):
    record.config["stage"]["light"] = PARAMETERS | {"restitution": 0.7}
    assert record.report().lines[0] == (
        "light: stale: the configuration is another than it was made with: restitution 0.65 -> 0.7"
    )


def of_other_code(data):
    (name,) = json.loads(data.attrs["code"])
    return data.assign_attrs(code=json.dumps({name: "0" * 40}))


def test_results_of_other_code_are_stale(record):
    record.edit(of_other_code)
    line = record.lines("light").splitlines()[0]
    assert line.startswith("light: stale: it was made by other code than today's: ")
    assert line.endswith("/study.py; remove it, and run again")


def test_only_a_changed_parameter_is_a_difference(record):
    record.edit(lambda data: data.assign_attrs(parameters="{}"))
    assert "light: parameters.restitution 0.65 -> absent" in record.lines("light")


def test_a_name_that_is_not_compared_is_refused(record):
    with pytest.raises(ValueError, match=r"^fig17: no file of that name .* are claims, light, p"):
        record.report("fig17", "light")


def test_results_that_are_the_reference_are_refused(record):
    shutil.rmtree(record.results)
    for target, words in (
        (record.reference, "results/figures is a part of the reference"),
        (record.reference / "figures", "results is no folder of results: there is no "),
    ):
        record.results.symlink_to(target)
        with pytest.raises(ValueError, match=words):
            record.report()
        record.results.unlink()


def test_a_figure_without_a_file_in_the_reference_is_a_new_one(drawn):
    for path in (drawn.reference / "figures").glob("light.*"):
        path.unlink()
    lines = drawn.lines()
    words = "figures/light.nc in the reference is missing; if it is new, commit, then accept it"
    assert lines.splitlines()[0] == f"light: {words}"


def test_a_result_that_is_linked_to_the_reference_is_refused(record):
    path = record.results / "figures" / "light.nc"
    path.unlink()
    os.link(record.reference / "figures" / "light.nc", path)
    with pytest.raises(ValueError, match=r"light.nc is a part of the reference"):
        record.report()


@pytest.mark.parametrize("side", ["reference", "results"])
def test_missing_and_unexpected_files_are_different(drawn, side):
    folder = getattr(drawn, side)
    (folder / "figures" / "light.svg").unlink()
    (folder / "figures" / "fig17.png").write_bytes(b"")
    (folder / "figures" / ".DS_Store").write_bytes(b"")
    lines = drawn.lines()
    assert f"figures/light.svg in the {side} is missing" in lines
    assert f"figures/fig17.png in the {side} is made by no rule" in lines
    assert "DS_Store" not in lines


def test_only_what_is_named_is_compared(record):
    record.edit(scaled("found", 2), "claims")
    assert record.lines("light") == ""
    assert "paper" not in record.lines("claims")


# Texts and pictures

WORDS = "{} in the {} is not what today's code makes of its data: "


@pytest.mark.parametrize("side", ["reference", "results"])
def test_edited_texts_and_pictures_are_different(drawn, side):
    drawn.rewrite("paper.md", "82.18", "82.19", side)
    drawn.rewrite("figures/light.svg", "stroke-width: 1.2", "stroke-width: 1.21", side)
    lines = drawn.lines()
    assert f"paper: {WORDS.format('paper.md', side)}" in lines
    assert f"light: {WORDS.format('figures/light.svg', side)}" in lines
    # What is wrong in the results alone has no cause in the code.
    assert ("changes of the code are unknown" in lines) == (side == "reference")


def test_a_number_that_rounds_otherwise_within_its_tolerance_is_no_difference(record):
    for side, value in (("reference", 82.175 - 1e-10), ("results", 82.175 + 1e-10)):
        record.edit(lambda data, value=value: data.assign(error_threshold=value), side=side)
        data = data_of(getattr(record, side))
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
    "a word": ("<!-- ratio -->", "<!-- rate -->"),
    "an entity": ("drawn at commit ", "&undeclared;"),
    "a control character": ("drawn at commit ", "drawn at commit \x07"),
    "a description that is an element": ("drawn at commit ", "drawn at commit <b/>"),
    "a script": ("</svg>", "<script>alert(1)</script></svg>"),
    "a mark elsewhere": (
        r'(<use xlink:href="#m\w*" x=")(\d+)(\.\d+" y="[\d.]+" style="stroke: #000000"/>)',
        r"\g<1>9\2\3",
    ),
}


@pytest.mark.parametrize("lie", SVG_LIES)
def test_an_edited_svg_is_different(original, tmp_path, lie):
    made = original / "figures" / "light.svg"
    edited, count = re.subn(*SVG_LIES[lie], made.read_text(encoding="utf-8"), count=1)
    assert count == 1
    path = tmp_path / "light.svg"
    path.write_text(edited, encoding="utf-8")
    assert file_differences(made, made) == []
    assert file_differences(made, path)[0].kind == "picture"


def one_grey_level(pixels):
    return np.where(pixels > 0, pixels - 1, pixels).astype("uint8")


def one_pixel(pixels):
    pixels = pixels.copy()
    pixels[50, 50, :3] = 255 - pixels[50, 50, :3]
    return pixels


@pytest.mark.parametrize("change", [one_grey_level, one_pixel, np.flipud])
def test_edited_pixels_are_different(original, tmp_path, change):
    made = original / "figures" / "light.png"
    path = tmp_path / "light.png"
    with Image.open(made) as image:
        Image.fromarray(change(np.asarray(image))).save(path)
    assert file_differences(made, made) == []
    finding = file_differences(made, path)[0]
    assert "pixels differ" in finding.text
    assert len(finding.images) == 3


def test_a_png_with_a_second_frame_is_different(original, tmp_path):
    made = original / "figures" / "light.png"
    path = tmp_path / "light.png"
    with Image.open(made) as image:
        black = Image.new("RGBA", image.size, "black")
        image.save(path, save_all=True, append_images=[black], default_image=False)
    assert "chunks IHDR acTL" in file_differences(made, path)[0].text


def test_the_first_line_on_a_picture_says_which_words_or_which_part_changed(drawn):
    """And not how many pixels, which follow from it."""

    def labelled(data):
        figure = draw(data)
        figure.axes[0].set_xlabel("rate")
        return figure

    def wider(data):
        figure = draw(data)
        figure.axes[0].lines[0].set_linewidth(3)
        return figure

    words = f"light: {WORDS.format('figures/light.svg', 'reference')}"
    for changed, said in (
        (labelled, "words: new 'rate', without 'ratio'"),
        (wider, "line2d_1, line "),
    ):
        drawn.products = [artifacts.picture("light", ("light",), changed, ()), PAPER]
        assert drawn.report("light").lines[0].startswith(words + said)


def test_a_picture_that_is_older_than_its_dataset_is_different(drawn):
    drawn.edit(scaled("max_height", 1.01))
    drawn.edit(scaled("max_height", 1.01), side="reference")
    PICTURE.make(data_of(drawn.reference), drawn.reference)
    lines = drawn.lines()
    assert WORDS.format("figures/light.svg", "results") in lines
    assert "in the reference" not in lines


def test_code_that_cannot_draw_is_one_line(drawn):
    """And not a second one on the other side, or on the files that are there."""
    for side in ("reference", "results"):
        drawn.edit(lambda data: data.drop_vars("max_height"), side=side)
    lines = drawn.lines().splitlines()
    (line,) = [each for each in lines if not each.startswith("paper")]
    assert line.startswith("light: today's code cannot make it of the dataset in the reference: ")


# Another matplotlib


def other(package, version):
    """A change of the version that a dataset records."""
    versions = json.dumps(datasets.versions() | {package: version})
    return lambda data: data.assign_attrs(versions=versions)


@pytest.mark.parametrize("side", ["reference", "results"])
def test_pictures_of_another_matplotlib_are_not_compared_and_this_is_said(drawn, side):
    """The true other matplotlib is that of `make lowest`."""
    for name in ("light", "claims"):
        drawn.edit(other("matplotlib", "3.10.0"), name, side)
    drawn.rewrite("figures/light.svg", "stroke: #0072b2", "stroke: #c77c00", side)
    report = drawn.report()
    today = matplotlib.__version__
    assert report.lines == [
        "3 of 5 files agree with the reference. 2 pictures were not compared, because another "
        f"matplotlib drew them. Other versions in the {side}: matplotlib 3.10.0 (today {today})."
    ]
    drawn.rewrite("paper.md", "82.18", "82.19", side)
    lines = drawn.report().lines
    assert lines[0].startswith("paper: ") and "2 pictures were not compared" in lines[-1]


def test_libraries_of_other_versions_are_said(record):
    record.edit(other("numpy", "2.1.0"), side="reference")
    today = datasets.versions()["numpy"]
    assert record.report().lines == [
        "All 3 files agree with the reference. "
        f"Other versions in the reference: numpy 2.1.0 (today {today})."
    ]
    record.edit(scaled("error_threshold", 2, ()))
    assert f"; other versions: numpy 2.1.0 -> {today}" in record.report("light").lines[0]


# Files of other kinds


def test_a_pipe_among_the_results_is_named_and_not_read(record):
    path = record.results / "figures" / "light.nc"
    path.unlink()
    os.mkfifo(path)
    assert record.report().lines[0] == "light: figures/light.nc in the results is no regular file"


@pytest.mark.parametrize("file", ["paper.md", "figures/light.svg"])
def test_a_lone_carriage_return_is_a_difference(drawn, file):
    path = drawn.results / file
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r", 1))
    assert f"{WORDS.format(file, 'results')}line 1" in drawn.lines()


def test_a_file_that_cannot_be_locked_is_said(record):
    """As all files of a file system without locks."""
    with (record.results / "figures" / "light.nc").open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        line = record.lines("light").splitlines()[0]
    assert line.endswith("if the file system has no locks, set HDF5_USE_FILE_LOCKING=FALSE")


def test_control_characters_are_not_printed(record):
    record.rewrite("paper.md", "The", "\x1b[2JThe\u202e")
    (line,) = record.lines().splitlines()
    assert line.isprintable() and "x1b[2J" in line


def test_another_format_or_an_unlimited_dimension_is_different(record):
    data = datasets.read(record.reference / "figures" / "claims.nc")
    path = record.results / "figures" / "claims.nc"
    data.to_netcdf(path, engine="netcdf4", unlimited_dims=["claim"])
    words = "it has the format NETCDF4 with groups or unlimited dimensions: claim"
    assert f"claims.nc in the results cannot be read: ValueError: {words}" in record.lines()
    data.to_netcdf(path, engine="netcdf4", format="NETCDF3_64BIT")
    assert "it has the format NETCDF3_64BIT_OFFSET" in record.lines()


@pytest.mark.parametrize("side", ["results", "reference"])
@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"versions": None}, "it does not record its versions"),
        ({"code": None}, "it does not record its code"),
        ({"versions": "{}"}, "it does not record its code and the versions of numpy, scipy"),
        ({"versions": "[]"}, "it does not record its versions"),
        ({"versions": '{"numpy": {}}'}, "it does not record its code and the versions of numpy"),
        ({"versions": 5.0}, "it does not record its versions"),
        ({"versions": '{"numpy": "2.1", "numpy": "2.2"}'}, "its versions, each of them once"),
        ({"parameters": '{"n": 1, "n": 1}'}, "its parameters, each of them once"),
        ({"parameters": "none"}, "cannot be read: JSONDecodeError"),
        ({"code": "{}"}, "it does not record its code"),
        ({"code": '{"study.py": {}}'}, "it does not record its code"),
        ({"code": "none"}, "cannot be read: JSONDecodeError"),
    ],
)
def test_a_dataset_says_how_it_was_made(record, side, change, said):
    def changed(data):
        attributes = data.attrs | change
        data.attrs = {key: value for key, value in attributes.items() if value is not None}
        return data

    record.edit(changed, side=side)
    lines = record.lines("light")
    assert lines.startswith(f"light: figures/light.nc in the {side} cannot be read: ")
    assert said in lines


PNG_CHUNKS = {
    "gamma": (b"gAMA", (45455).to_bytes(4, "big"), 33),
    "a colour profile": (b"iCCP", b"Description\0\0" + zlib.compress(b"drawn"), 33),
    "another text": (b"tEXt", b"Description\0anything", 33),
    "a second end": (b"IEND", b"", None),
}


@pytest.mark.parametrize("lie", PNG_CHUNKS)
def test_another_chunk_of_a_png_is_different(original, tmp_path, lie):
    kind, content, place = PNG_CHUNKS[lie]
    data = (original / "figures" / "light.png").read_bytes()
    chunk = len(content).to_bytes(4, "big") + kind + content
    chunk += zlib.crc32(kind + content).to_bytes(4, "big")
    path = tmp_path / "light.png"
    place = place or len(data)
    path.write_bytes(data[:place] + chunk + data[place:])
    assert file_differences(original / "figures" / "light.png", path) != []
    path.write_bytes(data + b"anything")
    assert file_differences(original / "figures" / "light.png", path) != []


def test_a_damaged_chunk_of_a_png_is_different(original, tmp_path):
    """Of the pixels, which are read all the same."""
    made = original / "figures" / "light.png"
    data = bytearray(made.read_bytes())
    start = data.index(b"IDAT")
    data[start + 4 + int.from_bytes(data[start - 4 : start], "big")] ^= 1
    (tmp_path / "light.png").write_bytes(data)
    (finding,) = file_differences(made, tmp_path / "light.png")
    assert finding.text.startswith("it cannot be read: ") and "IDAT" in finding.text


# The page, the log and the terminal


def test_the_page_has_all_findings_and_needs_no_other_file(drawn):
    drawn.edit(scaled("error_threshold", 1.01, ()))
    PICTURE.make(data_of(drawn.results), drawn.results)
    PAPER.make(data_of(drawn.results), drawn.results)
    drawn.rewrite("figures/light.svg", "#0072b2", "<&>", "reference")
    page = compare.page(drawn.report())
    assert "Numbers beyond their tolerance" in page
    assert "error_threshold is 83, the reference has 82.18" in page
    assert "+The threshold is 83.00." in page
    assert "&lt;&amp;&gt;" in page
    assert not re.search(r'(src|href)="(?!data:)', page)


@pytest.fixture
def run(project, monkeypatch, capsys):
    """Compare or accept as a job of Snakemake does, or on the command line with a folder; returns
    the exit status, what is printed and the log.
    """
    log = project.top.with_name("log")

    def execute(task, *names, results=None):
        given = {"results": project.results, "reference": project.top, "config": project.config}
        job = SimpleNamespace(params={**given, "names": list(names)}, log=[str(log)])
        log.unlink(missing_ok=True)
        if task == "accept":
            status = accept.main(project.products, job, project.CODE, project.top)
        else:
            monkeypatch.setattr(sys, "argv", ["compare.py", str(results)])
            job = None if results else job
            status = compare.main(project.products, project.top, job, project.top)
        return status, capsys.readouterr().out, log.read_text("utf-8") if log.exists() else ""

    return execute


def test_a_folder_and_the_target_diff_give_the_same(project, run):
    project.edit("src/study.py", "1 / ratio", "1.4 / ratio")
    project.edit("templates/paper.md", "The", "A")
    project.run()
    status, printed, log = run("diff")
    assert status == 1 and len(printed.splitlines()) == 6
    assert run("diff", results=project.results) == (1, printed, "")
    *told, verdict, page = printed.splitlines()
    assert log.splitlines() == [verdict, *told]
    assert page == f"See {project.results}/diff/index.html."


def test_where_nothing_can_be_written_there_is_a_verdict_and_no_page(project, run):
    (project.results / "diff").write_text("")
    status, printed, _ = run("diff")
    verdict, page = printed.splitlines()
    assert status == 0 and verdict == "All 5 files agree with the reference."
    assert page.startswith("There is no page: ") and "File exists" in page


def test_a_page_and_a_log_of_before_do_not_stand_for_a_comparison_that_was_killed(
    project, run, monkeypatch
):
    assert run("diff")[0] == 0
    page = project.results / "diff" / "index.html"
    assert "All 5 files agree" in page.read_text("utf-8")

    def killed(*given, **parameters):
        raise KeyboardInterrupt

    monkeypatch.setattr(compare, "Comparison", killed)
    with pytest.raises(KeyboardInterrupt):
        run("diff")
    assert not page.exists()
    assert project.top.with_name("log").read_text() == "The comparison has not ended.\n"


def test_a_folder_without_results_is_one_line_and_nothing_is_written(project, run):
    status, printed, _ = run("diff", results=project.results / "figures")
    folder = project.results / "figures"
    assert status == f"{folder} is no folder of results: there is no {folder}/figures"
    assert printed == "" and not (folder / "diff").exists()


@pytest.mark.parametrize("task", ["diff", "accept"])
def test_a_refused_name_is_the_message_and_the_log_and_nothing_else(run, task):
    status, printed, log = run(task, "fig17")
    assert f"{status}\n" == log and printed == ""
    assert (
        log == "fig17: no file of that name is compared; allowed are claims, heavy, light, paper\n"
    )


def test_accept_says_whether_it_wrote_something(project, run):
    nothing = "Nothing was written, because the reference has these results already.\n"
    assert run("accept")[:2] == (0, nothing)
    project.edit("templates/paper.md", "The", "A")
    commit(project.top, "edit")
    project.run()
    status, printed, _ = run("accept")
    assert status == 0 and printed.splitlines()[-2:] == [
        "paper.md",
        "4 files of the reference were written.",
    ]


# The claims of the replication


def test_claims_are_judged_anew_from_the_datasets_of_a_folder(tmp_path):
    data = artifacts.read_side("", CHECKOUT, products.ALL).data
    (tmp_path / "figures").mkdir()
    products.judge(data, tmp_path)
    judged = datasets.read(tmp_path / "figures" / "claims.nc")
    printed = datasets.printed_table(products.PRINTED)
    xr.testing.assert_equal(judged, claims.judge(data, printed))
    assert judged.attrs["title"] == data["claims"].attrs["title"]
