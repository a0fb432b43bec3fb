"""Datasets and their files: the same orbits come back; and what a picture shows."""

import numpy as np
import pytest

from bouncing_ball_beyond import (
    Rigid,
    SpringDamper,
    Table,
    cascade,
    follow,
    orbit,
    plot,
    special_curve,
    to_dataset,
)
from bouncing_ball_beyond.output.pictures import MARKS
from bouncing_ball_beyond.periodic.equations import KINDS


@pytest.fixture(scope="module")
def rigid():
    """A branch from a saddle-node to a period doubling, both ways."""
    return follow(orbit(Rigid(0.5), amplitude=1.4), to=(0.9, 1.8))


def test_quantities_are_those_of_the_orbits(rigid):
    data = to_dataset(rigid)
    assert data.amplitude.dims == ("point",)
    assert "amplitude" in data.coords
    for name, variable in data.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.attrs["units"] == ("rad" if "phase" in name else "1")
    # In the restitution model the ball leaves with πn, and falls with the same velocity.
    assert data.bounce_velocity.values == pytest.approx(np.pi, rel=1e-12)
    assert data.impact_velocity.values == pytest.approx(-np.pi, rel=1e-12)
    ordinary = data.kind.values == ""
    assert np.array_equal(data.stable.values[ordinary], rigid.stable)
    assert np.array_equal(data.admissible.values[ordinary], rigid.admissible)
    # Special orbits are where the branch passes them.
    assert data.kind.values[~ordinary].tolist() == [special.kind for special in rigid.special]
    phase = data.phase.values[:, 0]
    assert np.all(np.diff(phase) > 0) or np.all(np.diff(phase) < 0)
    modulus = np.hypot(data.multiplier_real, data.multiplier_imag)
    assert modulus.prod("multiplier").values == pytest.approx(0.25, rel=1e-12)


# Pictures


def boxes_of(figure):
    """The extents of all texts of a figure."""
    figure.draw_without_rendering()
    axes = figure.axes[0]
    texts = [axes.title, axes.xaxis.label, axes.yaxis.label, *figure.legends[0].get_texts()]
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        texts += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    return [text.get_window_extent() for text in texts if text.get_text()]


def test_texts_do_not_overlap_and_are_inside_the_picture(rigid):
    doubled = follow(rigid.first("period doubling"), to=1.8)
    table = Table([(1, 1.0, 0.0), (2, 0.0123, 0.7), (3, 0.05678, -1.1), (5, 0.012, 0.3)])
    several = follow(orbit(Rigid(0.5), amplitude=1.2, table=table), to=1.4)
    pictures = [plot(rigid), plot(rigid, doubled, quantity="relative_bounce_velocity")]
    for figure in (*pictures, plot(several)):
        boxes = boxes_of(figure)
        for i, box in enumerate(boxes):
            assert box.count_overlaps(boxes[:i]) == 0
            assert figure.bbox.count_contains(box.corners()) == 4


def test_a_title_has_the_constants_that_are_not_the_default_ones():
    table = Table([(1, 1.0, 0.0), (3, 0.05, 0.7)])
    branch = follow(orbit(Rigid(0.5), amplitude=1.2, table=table), to=1.3)
    title = plot(branch).axes[0].get_title()
    assert title == "1 impact in 1 T, r = 0.5, a₃ = 0.05, p₃ = 0.7"


def test_a_branch_that_returns_to_its_first_amplitude_has_no_constant_amplitude():
    balls = SpringDamper(frequency_ratio=[2.0, 10.0], restitution=0.85)
    branches = follow(orbit(balls, amplitude=0.9), to=(0.1, 1.3))
    assert branches[1].values[0] == branches[1].values[-1]
    texts = {text.get_text() for _, text in legend_of(plot(*branches))}
    assert {"ϖ = 2", "ϖ = 10"} <= texts


def test_an_orbit_alone_before_a_special_one_has_its_own_line():
    """The branch starts at a stable orbit, and doubles in its first step."""
    branch = follow(orbit(Rigid(0.5), amplitude=1.52), to=1.8)
    assert branch.special[0].kind == "period doubling"
    lines = plot(branch).axes[0].get_lines()
    looks = {round(float(line.get_xdata()[0]), 2): line.get_linestyle() for line in lines}
    assert looks[1.52] == "-"


def test_lines_are_solid_where_orbits_are_stable(rigid):
    axes = plot(rigid).axes[0]
    solid = [line for line in axes.lines if line.get_linestyle() == "-"]
    assert len(solid) == 1
    x, y = solid[0].get_data()
    ends = [rigid.first(kind) for kind in ("saddle-node", "period doubling")]
    assert sorted(x[[0, -1]]) == [special.amplitude for special in ends]
    assert sorted(y[[0, -1]]) == pytest.approx(
        [special.phase / np.pi for special in ends], abs=1e-12
    )
    # Between the orbits the line is the closed form Λ cos φ = π/3 to a thousandth of the axis.
    middle = (y[1:] + y[:-1]) / 2
    away = (x[1:] + x[:-1]) / 2 - np.pi / 3 / np.cos(np.pi * middle)
    assert np.abs(away).max() < 1e-3 * np.ptp(axes.get_xlim())
    marks = [line.get_marker() for line in axes.lines if line.get_linestyle() == "None"]
    assert sorted(marks) == ["o", "s"]


def test_a_legend_has_the_colours_of_curves(rigid):
    kinds = "period doubling", "saddle-node"
    curves = [special_curve(rigid.first(kind)) for kind in kinds]
    figure = plot(*curves)
    axes = figure.axes[0]
    colour = {text.get_text(): line.get_color() for line, text in legend_of(figure)}
    drawn = {line.get_color() for line in axes.lines if line.get_linestyle() != "None"}
    assert len({colour[kind] for kind in kinds} & drawn) == 2


def legend_of(figure):
    """The samples and the texts of a legend."""
    legend = figure.legends[0]
    return zip(legend.get_lines(), legend.get_texts(), strict=True)


def test_pictures_refuse_what_they_cannot_draw(rigid):
    with pytest.raises(ValueError, match="quantity = 'colour': must be one of max_height"):
        plot(rigid, quantity="colour")
    softer = follow(orbit(Rigid(0.5), amplitude=1.4), along="restitution", to=0.6)
    with pytest.raises(ValueError, match="all along the same parameters"):
        plot(rigid, softer)
    with pytest.raises(ValueError, match="plot draws branches, curves and lists of them"):
        plot(rigid.orbits[0])


def test_a_list_of_branches_has_a_dataset_for_each(rigid):
    with pytest.raises(ValueError, match="a dataset stores one orbit or branch"):
        to_dataset([rigid, rigid])


def test_all_kinds_have_marks():
    assert set(MARKS) == set(KINDS)


def test_a_stable_cascade_has_no_unstable_lines():
    doubling = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8).first("period doubling")
    branches = cascade(doubling, to=1.8, impacts=8)
    figure = plot(branches)
    # The lines of a branch begin at the orbit that doubles its period.
    starts = {line.get_xdata()[0] for line in figure.axes[0].lines if line.get_linestyle() == "-"}
    assert {branch.values[0] for branch in branches} <= starts
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts == [
        "stable",
        "period doubling",
        "2 impacts in 2 T",
        "4 impacts in 4 T",
        "8 impacts in 8 T",
    ]
