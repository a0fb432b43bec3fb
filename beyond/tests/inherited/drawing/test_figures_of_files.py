"""The dataset of an artifact draws its figure, in the axes, size and fonts that a user asks for."""

import functools
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from declared_artifacts import STUDIES
from matplotlib.text import Text

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.datasets import DRAWING
from bouncing_ball_beyond.inherited.datasets.files import write_dataset
from bouncing_ball_beyond.inherited.drawing.result import MADE_BY

ROOT = Path(__file__).parents[3]
# Axes of places with parameters of their own, and these parameters.
CASES = {("case",), ("node",), ("sample",)}
PARAMETERS = {"n", "restitution", "amplitude", "frequency_ratio"}


@functools.cache
def opened(name):
    """The dataset of an artifact, from its file in the record."""
    return bouncing_ball_beyond.inherited.open(ROOT / f"figures/{name}.nc")


@pytest.mark.parametrize("name", sorted(STUDIES))
def test_parameters_of_cases_are_coordinates(name):
    data = opened(name)
    along = {variable for variable in data.data_vars if data[variable].dims in CASES}
    assert along.isdisjoint(PARAMETERS)


def test_words_in_vector_graphics_are_text(tmp_path):
    for kind in ("svg", "pdf"):
        opened("ext_flights").plot(tmp_path / f"talk.{kind}")
    svg = (tmp_path / "talk.svg").read_text(encoding="utf-8")
    assert "</text>" in svg
    # Type 42 are fonts that programs can edit; Type 3 are drawings of letters.
    assert b"/Type0" in (tmp_path / "talk.pdf").read_bytes()
    assert b"/Type3" not in (tmp_path / "talk.pdf").read_bytes()


# One with a panel in a corner, and one with notes; others, weekly.
FONTS = [
    "ext_impact",
    "ext_instant",
    *(pytest.param(x, marks=pytest.mark.long) for x in ("ext_map", "ext_laws")),
]


@pytest.mark.parametrize("name", FONTS)
def test_every_text_follows_the_font_size(name):
    data = opened(name)

    def sizes(figure):
        figure.draw_without_rendering()
        texts = [text for text in figure.findobj(Text) if text.get_text()]
        return {text.get_text(): text.get_fontsize() for text in texts}

    normal = sizes(data.plot(font_size=9, size=(9, 6)))
    large = sizes(data.plot(font_size=18, size=(9, 6)))
    shared = normal.keys() & large.keys()
    # Titles, labels, names in the legend, notes, and numbers at the ticks.
    assert len(shared) >= 7
    assert all(large[text] == pytest.approx(2 * normal[text]) for text in shared)


def test_a_figure_has_the_size_that_is_asked_for():
    figure = opened("ext_flights").plot(size=(4, 4), font_size=12)
    figure.draw_without_rendering()
    assert figure.get_size_inches().tolist() == [4, 4]


def test_a_figure_is_drawn_into_given_axes():
    figure, axes = plt.subplots(1, 3)
    try:
        with pytest.raises(
            bouncing_ball_beyond.inherited.ModelError, match="panels: give as many axes, not 1"
        ):
            opened("ext_impact").plot(ax=axes[0])
        assert opened("ext_impact").plot(ax=axes) is figure
        assert all(len(panel.lines) for panel in axes)
    finally:
        plt.close(figure)


def test_mistakes_have_one_line(recorded, tmp_path, refusal):
    data = opened("ext_impact")
    with refusal(
        bouncing_ball_beyond.inherited.ModelError, "'talk.jpg' does not end in .pdf or .png or .svg"
    ):
        data.plot("talk.jpg")
    with refusal(
        bouncing_ball_beyond.inherited.ModelError, "size = (0, 1) is not a width and a height"
    ):
        data.plot(size=(0, 1))
    with refusal(bouncing_ball_beyond.inherited.ModelError, "size = 3 is not a width and a height"):
        data.plot(size=3)
    with refusal(
        bouncing_ball_beyond.inherited.ModelError, "font_size = -1 is not a number of points > 0"
    ):
        data.plot(font_size=-1)
    with refusal(bouncing_ball_beyond.inherited.ModelError, "no dataset"):
        bouncing_ball_beyond.inherited.open(tmp_path / "nowhere.nc")
    write_dataset(recorded["ext_release"], tmp_path / "table1.nc")
    with refusal(
        bouncing_ball_beyond.inherited.ModelError,
        "'Bifurcations and thresholds under both release rules' has no",
    ):
        bouncing_ball_beyond.inherited.open(tmp_path / "table1.nc").plot()


@pytest.mark.parametrize(
    "name",
    [
        *("os:system", "bouncing_ball_beyond.inherited.drawing.style", "os.path:join", "x\x1b[2J"),
        "bouncing_ball_beyond.inherited.datasets.files:write_text",
        # In a module of figures, but not of it, or no figure.
        "bouncing_ball_beyond.exhibits.stiffness_map_figures:canvas",
        "bouncing_ball_beyond.exhibits.stiffness_map_figures:Figure",
    ],
)
def test_only_functions_that_draw_are_called(name, refusal):
    data = opened("ext_impact").assign_attrs({DRAWING: name})
    with refusal(
        bouncing_ball_beyond.inherited.ModelError, "is no function of this package that draws"
    ):
        data.plot()


def test_a_result_is_drawn_as_that_of_a_call_that_exists(refusal):
    data = opened("ext_impact").assign_attrs({MADE_BY: "os.system"})
    with refusal(
        bouncing_ball_beyond.inherited.ModelError,
        "unknown call 'os.system': one of simulate, history",
    ):
        data.plot()


def test_a_function_that_is_gone_is_named(refusal):
    data = opened("ext_impact").assign_attrs(
        {DRAWING: "bouncing_ball_beyond.exhibits.gone_figures:figure"}
    )
    with refusal(
        bouncing_ball_beyond.inherited.ModelError,
        "this version of the package has no bouncing_ball",
    ):
        data.plot()


def test_threads_that_draw_leave_the_settings_of_the_user(tmp_path):
    """Each draws the same figure at the same time, and changes the settings while it draws."""
    data = opened("ext_impact")
    before = dict(plt.rcParams)
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda k: data.plot(tmp_path / f"{k}.svg"), range(2)))
    assert dict(plt.rcParams) == before
    assert len({path.read_bytes() for path in tmp_path.iterdir()}) == 1
