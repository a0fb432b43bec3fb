"""The figures: what is drawn is what the datasets have."""

import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
import yaml
from matplotlib.contour import QuadContourSet
from matplotlib.text import Text
from tests.reference import with_more

from bouncing_ball import restitution
from carbonelli2011 import curves, figures, paper
from carbonelli2011.stages import apparent_restitution, restitution_model, time_histories
from paper_replication import datasets, drawing

REFERENCE = Path(__file__).parents[1] / "figures"
NAMES = sorted(figures.FIGURES)
DOMAINS = ("fig08", "fig09", "fig15")
PHASES = ("phase", "release_phase")


@cache
def reference(name):
    """A dataset of the reference, with the curves of the paper."""
    path = REFERENCE / f"{name}.nc"
    if not path.exists():
        pytest.skip(f"{name} is not in the reference yet: snakemake --cores 2 {name} accept")
    return paper.of_paper({name: datasets.read(path)})[name]


def data_of(name):
    """The datasets that a figure shows, to be changed."""
    shown = "fig12" if name == "motion" else name
    return [reference(shown).copy(deep=True)] if name in figures.PLOTS else []


@cache
def of_reference(name):
    """A figure of the reference."""
    return figures.draw(name, *data_of(name))


def words(figure):
    """All texts of a figure."""
    return [text.get_text() for text in figure.findobj(Text)]


def with_parameters(data, **changed):
    given = datasets.parameters(data) | changed
    return data.assign_attrs(parameters=datasets.json.dumps(given))


def branches(name, data):
    """The branches of a figure of domains, and the phases that it shows."""
    if name == "fig03":
        families = [data.sel(n=n) for n in data.n]
        exact = [family.sel(impact_map="exact") for family in families]
        return [curves.restitution_branch(*pair) for pair in zip(families, exact, strict=True)]
    contacts = [data.sel(frequency_ratio=ratio) for ratio in data.frequency_ratio]
    drawn = [curves.spring_damper_branch(contact) for contact in contacts]
    if name == "fig15":
        variables = ("amplitude", "phase", "stable", "admissible")
        rigid = xr.Dataset({variable: data[f"restitution_{variable}"] for variable in variables})
        drawn.append(curves.restitution_branch(rigid, data))
    return drawn


def lines_of(figure, label):
    return [line for axes in figure.axes for line in axes.lines if line.get_label() == label]


def at(line, x, y):
    """The places of a point on a line."""
    return np.flatnonzero((line.get_xdata() == x) & (line.get_ydata() == y))


@pytest.mark.parametrize("name", ["fig03", *DOMAINS])
def test_line_styles_are_the_stability(name):
    data = reference(name)
    figure = of_reference(name)
    for branch in branches(name, data):
        kinds = np.where(branch.stable, "stable", "unstable")
        for phase in PHASES[: 1 if name == "fig03" else 2]:
            for k in range(0, branch.sizes["point"] - 1, 25):
                x = float(branch.amplitude[k])
                y = float(branch[phase][k]) / np.pi
                # A line begins or ends where the kind changes, so that the part beyond decides.
                beyond = [
                    line
                    for kind in curves.KINDS
                    for line in lines_of(figure, kind)
                    if (at(line, x, y) < len(line.get_xdata()) - 1).any()
                ]
                assert {line.get_label() for line in beyond} == {kinds[k]}
    dashes = {kind: lines_of(figure, kind)[0].get_linestyle() for kind in ("stable", "unstable")}
    assert dashes == {"stable": "-", "unstable": "--"}


@pytest.mark.parametrize("name", ["fig03", *DOMAINS])
def test_marks_are_at_the_special_points(name):
    data = reference(name)
    figure = of_reference(name)
    count = 0
    for branch in branches(name, data):
        special = branch.isel(special=np.flatnonzero(branch.special_amplitude.notnull()))
        durations = special.get("special_contact_duration", xr.zeros_like(special.special_phase))
        for phase in (special.special_phase, special.special_phase + durations):
            for kind, x, y in zip(
                special.special_kind.values,
                special.special_amplitude.values,
                phase.values / np.pi,
                strict=True,
            ):
                marks = lines_of(figure, kind)
                assert any(at(line, x, y).size for line in marks)
                assert {line.get_marker() for line in marks} == {curves.MARKS[kind]["marker"]}
                # The line of the branch passes through it too.
                drawn = [line for orbits in curves.KINDS for line in lines_of(figure, orbits)]
                assert any(at(line, x, y).size for line in drawn)
                count += 1
    assert count >= 4


@pytest.mark.parametrize("name", ["fig03", "fig15"])
def test_the_period_doublings_of_eq_8_are_marked(name):
    """They are orbits of Eq. 6, at the Λ of Eq. 8."""
    given = datasets.parameters(reference(name))
    n = np.unique(given["n"])
    r = given["restitution"]
    marks = lines_of(of_reference(name), "period doubling, Eq. 8")
    places = np.array([line.get_xydata()[0] for line in marks])
    amplitude = np.unique(places[:, 0])
    assert amplitude == pytest.approx(restitution.holmes_period_doubling(n, r))
    cosines = places[:, 0] * np.cos(np.pi * places[:, 1])
    assert np.unique(cosines.round(12)) == pytest.approx(n * np.pi * (1 - r) / (1 + r))


def test_the_end_of_a_branch_at_permanent_contact_is_marked():
    data = reference("fig08")
    marks = lines_of(of_reference("fig08"), "joins permanent contact")
    end = data.sel(frequency_ratio=2.0).isel(point=0)
    places = {(float(line.get_xdata()[0]), float(line.get_ydata()[0])) for line in marks}
    assert places == {(float(end.amplitude), float(end[phase]) / np.pi) for phase in PHASES}


def test_a_branch_that_ends_early_at_its_last_point_is_marked_there():
    """The branch of the most compliant contact, followed backwards, with unknown points at last."""
    (data,) = data_of("fig08")
    along = [name for name in data.data_vars if "point" in data[name].dims]
    for name in (*along, "end_kind"):
        data[name][-1] = data[name].values[-1, ::-1]
    data.special_arclength[-1] = 1 - data.special_arclength[-1]
    data.amplitude[-1, -3:] = data.phase[-1, -3:] = data.release_phase[-1, -3:] = np.nan
    marks = lines_of(figures.draw("fig08", data), "joins permanent contact")
    end = data.isel(frequency_ratio=-1, point=-4)
    expected = {(float(end.amplitude), float(end[phase]) / np.pi) for phase in PHASES}
    assert {tuple(line.get_xydata()[0]) for line in marks} == expected


def test_a_motion_repeats_before_and_after_its_cycle():
    data = reference("fig12")
    period = 2 * np.pi
    motions = [data.table.values, data.restitution_ball.values, *data.ball.values[::-1]]
    axes = of_reference("fig12").axes[0]
    for line, height in zip(axes.lines, motions, strict=True):
        for shift in (-1, 0, 1):
            at_times = np.interp(data.table_phase.values / period + shift, *line.get_data())
            assert at_times == pytest.approx(height)
    # The table is the body below its line.
    (body,) = axes.collections
    assert body.get_label() == "table $w$"
    edges = {tuple(point) for point in body.get_paths()[0].vertices}
    assert {tuple(point) for point in axes.lines[0].get_xydata()} <= edges


def moved(sheet, name):
    """The numbers of the keyframes of a part: shares of the cycle in per cent, and values."""
    (steps,) = re.findall(rf"@keyframes {name}\{{(.*)\}}", sheet)
    pairs = re.findall(r"([\d.]+)%\{(?:translate:0|scale:1) ([-\d.]+)(?:px)?\}", steps)
    return np.array(pairs, dtype=float).T


def test_the_balls_of_the_moving_figure_move_as_in_the_dataset():
    """In a contact a ball is on its spring, and in flight as high above it as above the table."""
    data = reference("fig12")
    sheet = figures.moving("motion", data)
    parts = {part.get_gid(): part for part in of_reference("motion").axes[0].patches}
    heights = [data.restitution_ball, *data.ball.sortby("frequency_ratio", ascending=False)]
    unit = np.ptp(moved(sheet, "table")[1]) / np.ptp(data.table.values)
    for k, height in enumerate(heights):
        time, down = moved(sheet, f"ball{k}")
        phase = data.restitution_phase.item() + 2 * np.pi * time / 100
        table, ball = (
            np.interp(phase, data.table_phase, position, period=2 * np.pi)
            for position in (data.table, height)
        )
        # Positions have tenths of a point, and times hundredths of a per cent of the cycle.
        assert down == pytest.approx(unit * (ball[0] - ball), abs=0.2)
        foot, *_, plate = np.sort(parts[f"contact{k}"].get_xy()[:, 1])
        at, scale = moved(sheet, f"contact{k}") if k else (time, np.ones_like(time))
        spring = foot + unit * (table - table[0]) + (plate - foot) * np.interp(time, at, scale)
        bottom = parts[f"ball{k}"].center[1] - parts[f"ball{k}"].radius - down
        assert bottom - spring == pytest.approx(unit * np.maximum(ball - table, 0), abs=0.3)
    assert sheet.count("@media screen and (prefers-reduced-motion:no-preference)") == 1


def test_another_curve_of_figure_12_changes_no_byte_of_the_moving_figure():
    (data,) = data_of("fig12")
    more = with_more(data, paper.PARAMETERS["fig12"], 2)
    assert figures.moving("motion", more) == figures.moving("motion", data)
    assert words(figures.draw("motion", more)) == words(of_reference("motion"))


def test_the_poincare_map_shows_both_ends_of_contact_and_the_restitution_model():
    data = reference("fig13").isel(case=0)
    lines = [line.get_xydata() * np.pi for line in of_reference("fig13").axes[0].lines]
    phase = data.restitution_phase
    for x, y in (
        (data.phase, data.impact_velocity),
        (data.release_phase, data.bounce_velocity),
        ([phase, phase], [data.restitution_impact_velocity, data.restitution_bounce_velocity]),
    ):
        points = np.stack([x, y], axis=1)
        assert any(line.shape == points.shape and np.allclose(line, points) for line in lines)


def test_an_error_that_changes_its_sign_is_zero_between():
    data = reference("fig16")
    axes = of_reference("fig16").axes[1]
    ratio, error = axes.lines[0].get_data()
    zero = ratio[np.argmin(error)]
    assert error.min() == axes.get_ylim()[0]
    near = np.abs(np.log(data.frequency_ratio / zero)).argsort().values[:2]
    signs = np.sign(data.threshold_amplitude - data.restitution_threshold).values[near]
    assert sorted(signs) == [-1, 1]
    assert np.delete(error, np.argmin(error)) == pytest.approx(data.relative_error.values)


def test_velocities_of_the_cycle_are_tangents():
    data = reference("fig07")
    axes = of_reference("fig07").axes[0]
    arrows = [text for text in axes.texts if text.arrow_patch]
    slopes = [np.subtract(text.xy, text.xyann) for text in arrows]
    velocities = [dy / dx / (2 * np.pi) for dx, dy in slopes]
    expected = [data.impact_velocity, data.bounce_velocity, data.impact_velocity]
    assert velocities == pytest.approx([float(velocity) for velocity in expected])


# Other parameters


def test_a_branch_without_orbits_is_named_above():
    (data,) = data_of("fig08")
    data.amplitude[1] = data.phase[1] = data.release_phase[1] = np.nan
    data.special_amplitude[1] = data.special_phase[1] = np.nan
    data.special_kind[1] = ""
    figure = figures.draw("fig08", data)
    assert figure.axes[0].get_title().endswith("\nno branch for $\\varpi=10$")
    assert "$\\varpi=10$" not in words(figure)


@pytest.mark.parametrize("name", ["fig02", "fig05", "fig07", "fig12", "fig13", "fig14", "fig15"])
def test_a_figure_without_an_orbit_is_refused_with_its_parameters(name):
    """An empty picture was drawn, or matplotlib's error was shown."""
    (data,) = data_of(name)
    empty = [variable for variable in data.data_vars if data[variable].dtype.kind == "f"]
    nothing = data.assign({variable: np.nan * data[variable] for variable in empty})
    with pytest.raises(ValueError, match=rf"^{name} would be empty: no orbit has n = .*Eq\. 7"):
        figures.draw(name, nothing)


def test_the_inadmissible_part_of_a_curve_is_in_the_legend():
    (data,) = data_of("fig05")
    part = data.assign(admissible=data.admissible & (data.frequency_ratio > 5))
    figure = figures.draw("fig05", part)
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert entries.count("inadmissible") == 1 and entries[1] == "inadmissible"
    (data,) = data_of("fig13")
    assert "inadmissible" not in words(figures.draw("fig13", data))
    part = data.assign(admissible=data.admissible & (data.frequency_ratio > 5))
    assert "inadmissible" in words(figures.draw("fig13", part))


def test_inadmissible_orbits_are_dotted_and_grazing_is_marked():
    (data,) = data_of("fig09")
    data.admissible[2, :100] = False
    kinds = data.special_kind.astype(object)
    kinds[2, 0] = "grazing"
    data["special_kind"] = kinds
    figure = figures.draw("fig09", data)
    dotted = lines_of(figure, "inadmissible")
    assert [len(line.get_xdata()) for line in dotted] == [101, 101]
    assert {line.get_marker() for line in lines_of(figure, "grazing")} == {"^"}
    assert {"inadmissible", "grazing"} <= set(words(figure))


@pytest.mark.parametrize(("name", "threshold"), [("fig14", np.inf), ("fig16", np.nan)])
def test_no_threshold(name, threshold):
    (data,) = data_of(name)
    figure = figures.draw(name, data.assign(error_threshold=threshold))
    assert not any(r"\varpi_{" in text for text in words(figure))


@pytest.mark.parametrize(("name", "claim"), [("fig14", "height"), ("fig16", "permanent contact")])
def test_the_printed_threshold_is_a_diamond_at_the_error_that_the_paper_allows(name, claim):
    printed = paper.PRINTED[f"{claim} threshold"]
    (diamond,) = [line for line in of_reference(name).axes[1].lines if line.get_marker() == "D"]
    assert diamond.get_xydata().tolist() == [[float(printed), paper.LIMIT]]
    assert diamond.get_label() == f"printed: {printed}"


def test_the_advised_frequency_ratio_is_a_line_in_both_panels():
    for axes in of_reference("fig14").axes:
        (line,) = [line for line in axes.lines if line.get_label() == f"advised: {paper.STIFF:g}"]
        assert line.get_xdata() == [paper.STIFF, paper.STIFF]


def test_other_parameters_have_neither_a_printed_nor_an_advised_frequency_ratio():
    (data,) = data_of("fig14")
    texts = words(figures.draw("fig14", with_parameters(data, amplitude=0.9)))
    assert not any("printed" in text or "advised" in text for text in texts)


def test_another_tolerance_and_release_have_no_printed_value():
    (data,) = data_of("fig16")
    texts = words(figures.draw("fig16", with_parameters(data, tolerance=0.05)))
    assert "tolerance 5 %" in texts
    assert not any("printed" in text for text in texts)
    force = words(figures.draw("fig16", with_parameters(data, release="force")))
    assert r"spring-damper, $\Lambda_F$" in force
    assert not any("printed" in text or r"\sqrt" in text for text in force)


def test_a_case_without_orbits():
    (data,) = data_of("fig10")
    for variable in ("phase", "bounce_velocity"):
        data[variable][0] = np.nan
    figure = figures.draw("fig10", data)
    assert "$\\Lambda=1.1$ (no orbit)" in words(figure)
    assert "$\\Lambda=1$" in figure.axes[1].get_ylabel()


def test_one_case():
    (data,) = data_of("fig05")
    texts = words(figures.draw("fig05", data.isel(case=[1])))
    assert {"$n=1$, $r=0.85$, $\\Lambda=1$", "spring-damper model"} <= set(texts)


def test_several_cases_of_the_poincare_map():
    (data,) = data_of("fig13")
    softer = data.assign_coords(amplitude=("case", [1.2]), case=["r = 0.65, Λ = 1.2"])
    both = xr.concat([data, softer], "case", data_vars="minimal").assign_attrs(data.attrs)
    both.phase[1] += 0.3
    figure = figures.draw("fig13", both)
    assert {"$\\Lambda=1$", "$\\Lambda=1.2$"} <= set(words(figure))


def test_labels_at_the_right_do_not_overlap():
    figure, axes = drawing.panels(2.0)
    drawing.name_at_right(axes, [("low", 0.50, "black"), ("high", 0.55, "black")])
    figure.draw_without_rendering()
    low, high = (text.get_window_extent() for text in axes.texts)
    assert not low.overlaps(high)


def test_two_figures_have_the_same_axes():
    one = figures.draw("fig14", *data_of("fig14"))
    (data,) = data_of("fig14")
    other = figures.draw("fig14", data.isel(frequency_ratio=slice(60, None)))
    first, second = drawing.on_the_same_axes([one, other])
    assert first != second
    for axes, same in zip(one.axes, other.axes, strict=True):
        assert (axes.get_xlim(), axes.get_ylim()) == (same.get_xlim(), same.get_ylim())
        assert axes.get_xlim()[0] < float(data.frequency_ratio[1])


def test_two_figures_have_their_panels_in_the_same_place():
    """A legend of six more rows moves no panel, and makes no picture higher than the other."""
    with drawing.style():
        pair = [drawing.panels(3.0, rows=2) for _ in range(2)]
    for (figure, axes), count in zip(pair, (1, 13), strict=True):
        for n in range(count):
            axes[0].plot([0, 1], [0, n], label=f"a label {n}")
        drawing.legend_below(figure)
    drawing.on_the_same_axes([figure for figure, _ in pair])
    (one, _), (other, _) = pair
    assert one.get_size_inches().tolist() == other.get_size_inches().tolist()
    for axes, same in zip(pair[0][1], pair[1][1], strict=True):
        assert axes.get_position().bounds == same.get_position().bounds


# Files

SETTINGS = {
    "axes.grid": True,
    "axes.spines.left": False,
    "path.simplify": False,
    "font.size": 20,
    "font.family": "serif",
    "lines.linewidth": 5,
    "savefig.facecolor": "red",
    "savefig.bbox": "tight",
    "svg.fonttype": "none",
    "svg.hashsalt": "another",
    "axes.formatter.use_mathtext": True,
    "mathtext.fontset": "cm",
    "figure.constrained_layout.use": False,
}


def saved(folder, name):
    """The bytes of both pictures of a figure."""
    paths = folder / f"{name}.png", folder / f"{name}.svg"
    data = data_of(name)
    drawing.save_picture(
        figures.draw(name, *data), *paths, curves.SALT, figures.moving(name, *data)
    )
    return [path.read_bytes() for path in paths]


@pytest.mark.parametrize("name", ["fig04", "fig11"])
def test_settings_of_the_user_change_no_byte(tmp_path, name):
    usual = saved(tmp_path, name)
    with matplotlib.rc_context(SETTINGS):
        assert saved(tmp_path, name) == usual


def test_a_pdf_has_its_letters_as_text_in_the_font_and_the_size_that_are_given(tmp_path):
    own = {"font.family": "STIXGeneral", "mathtext.fontset": "stix", "figure.figsize": "6.4, 4.8"}
    for settings, font, size in (({}, b"DejaVuSans", b"252 302.4"), (own, b"STIX", b"460.8 345.6")):
        figure = figures.draw("fig14", *data_of("fig14"), own=settings)
        drawing.save_pdf(figure, tmp_path / "fig14.pdf", settings)
        content = (tmp_path / "fig14.pdf").read_bytes()
        assert b"/MediaBox [ 0 0 %s ]" % size in content
        names = re.findall(rb"/BaseFont /\w+\+([\w-]+)", content)
        assert names and all(name.startswith(font) for name in names)
        # Embedded TrueType, no outlines.
        assert b"/FontFile2" in content and b"/Type3" not in content


@pytest.mark.parametrize(
    ("own", "words"),
    [
        ({"font.sise": 9}, "font.sise"),
        ({"font.size": "big"}, "big"),
        ({"font.family": "Palatina"}, "Palatina"),
    ],
)
def test_a_setting_that_would_have_no_effect_is_refused(own, words):
    with pytest.raises((KeyError, ValueError), match=words):
        figures.draw("fig01", own=own)


def test_a_picture_appears_whole_or_not_at_all(tmp_path):
    (tmp_path / "fig01.svg").mkdir()
    with pytest.raises(OSError, match=r"fig01\.svg"):
        saved(tmp_path, "fig01")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fig01.png", "fig01.svg"]


def test_drawing_imports_neither_pyplot_nor_scipy():
    code = (
        "import sys, carbonelli2011.figures\n"
        "print([name for name in ('matplotlib.pyplot', 'scipy') if name in sys.modules])"
    )
    answer = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert answer.stdout.strip() == "[]"


# The validity map


def panels_of_map(data, figure):
    """Quantity, n and axes of each panel."""
    pairs = [(quantity, n) for quantity in data.quantity.values for n in data.n.values]
    assert len(figure.axes) == len(pairs)
    return [(*pair, axes) for pair, axes in zip(pairs, figure.axes, strict=True)]


def test_the_dark_region_of_each_panel_holds_the_orbits_that_fail():
    data = reference("validity_map")
    for quantity, n, axes in panels_of_map(data, of_reference("validity_map")):
        error = data.stiff_error.sel(n=n, quantity=quantity)
        orbits = error.stack(orbit=("restitution", "place"))
        points = np.stack([orbits.restitution, orbits.place], axis=-1)
        fails = (orbits > 0.01).values
        filled = [
            collection for collection in axes.collections if isinstance(collection, QuadContourSet)
        ]
        regions = [collection.get_paths()[0] for collection in filled if collection.filled]
        assert len(regions) == fails.any()
        for region in regions:
            inside = region.contains_points(points, radius=1e-9)
            # Between two orbits the border is interpolated, so orbits near it are left out.
            far = (abs(orbits - 0.01) > 1e-3).values
            assert far.sum() > 700
            assert np.array_equal(inside[far], fails[far])


def test_the_light_region_of_each_panel_is_where_the_period_has_doubled():
    data = reference("validity_map")
    for _, n, axes in panels_of_map(data, of_reference("validity_map")):
        (light,) = [
            collection
            for collection in axes.collections
            if not isinstance(collection, QuadContourSet)
        ]
        edge = {tuple(point) for point in light.get_paths()[0].vertices}
        share = data.doubled_share.sel(n=n).values
        assert edge.issuperset(zip(data.restitution.values, 1 - share, strict=True))
        assert edge.issuperset(zip(data.restitution.values, np.ones_like(share), strict=True))
        # No panel counts its orbits as failing, so it is drawn above the dark region.
        assert axes.collections[-1] is light
        assert all(light.get_zorder() >= collection.get_zorder() for collection in axes.collections)
        assert matplotlib.colors.to_rgba(light.get_facecolor()[0])[3] == 1


def test_each_panel_of_the_map_has_the_share_of_the_failing_orbits():
    data = reference("validity_map")
    for quantity, n, axes in panels_of_map(data, of_reference("validity_map")):
        (share,) = [text.get_text() for text in axes.texts]
        mean = float(data.failing_mean.sel(quantity=quantity, n=n))
        if share == "none":
            assert mean == 0
        elif share.startswith("<"):
            assert 0 < 100 * mean < float(share.strip("< %"))
        else:
            # Half a unit of the printed digit, with a rounding error.
            assert float(share.strip(" %")) == pytest.approx(100 * mean, abs=0.05 + 1e-9)


def test_an_orbit_of_the_validity_map_without_an_answer_leaves_the_share_unknown():
    data = reference("validity_map").copy(deep=True)
    data.failing_mean[1, 0] = np.nan
    for quantity, n, axes in panels_of_map(data, figures.draw("validity_map", data)):
        there = (quantity, n) == (data.quantity[1], data.n[0])
        assert ("unknown" in {text.get_text() for text in axes.texts}) == there


def test_each_point_of_the_regimes_lies_in_the_region_of_its_answer():
    data = reference("regimes")
    line, axes = of_reference("regimes").axes
    names = ("within 1 %", "off by more", "period doubled", "in this model only")
    regions = [
        collection.get_paths()[0]
        for name in names
        for collection in axes.collections
        if name in collection.get_label()
    ]
    contact = data[["saddle_node_amplitude", "period_doubling_amplitude"]]
    for ratio in (5.0, 50.0, 500.0):
        node, doubling = contact.interp(frequency_ratio=ratio).to_array().values
        for amplitude in np.linspace(0.55, 1.25, 71):
            is_rigid = data.amplitude[0] < amplitude < data.amplitude[-1]
            enough = np.interp(amplitude, data.amplitude, data.enough_from)
            wanted = [
                is_rigid and ratio > enough and amplitude < doubling,
                is_rigid and ratio < enough and amplitude < doubling,
                is_rigid and amplitude > doubling,
                not is_rigid and node < amplitude < doubling,
            ]
            inside = [region.contains_point((amplitude, ratio)) for region in regions]
            # The region of the doubled period covers the first two.
            inside[:2] = [is_inside and not inside[2] for is_inside in inside[:2]]
            assert inside == wanted, (amplitude, ratio)
    bars = {(bar.get_x(), bar.get_x() + bar.get_width()) for bar in line.patches}
    assert bars == {(0, 1), tuple(data.amplitude.values[[0, -1]])}


def test_the_inset_of_figure_3_has_both_period_doublings_of_the_last_family():
    data = reference("fig03")
    (inset,) = of_reference("fig03").axes[0].child_axes[:1]
    last = data.isel(n=-1)
    for kind, mark in {"exact": "s", "holmes": "x"}.items():
        of_map = last.sel(impact_map=kind)
        point = of_map.period_doubling_amplitude, of_map.period_doubling_phase / np.pi
        (marks,) = [line.get_xydata() for line in inset.lines if line.get_marker() == mark]
        assert marks[np.isfinite(marks).all(axis=1)] == pytest.approx(np.array([point]))
        assert inset.viewLim.contains(*point)


@pytest.mark.parametrize(
    ("stage", "name", "change", "words"),
    [
        (time_histories, "fig12", {"amplitude": 3.0}, "restitution model (unstable)"),
        (time_histories, "fig07", {"amplitude": 1.3}, "ball $z$ (unstable)"),
        (restitution_model, "fig02", {"amplitude": 1.5}, "ball $z$ (unstable)"),
        (restitution_model, "fig02", {"restitution": 0.01, "amplitude": 3.08}, "(inadmissible)"),
        (apparent_restitution, "fig10", {"amplitude": [1.5, 1.0]}, r"$\Lambda=1.5$ (unstable)"),
        (apparent_restitution, "fig10", {"amplitude": [1.3]}, "unstable"),
        (apparent_restitution, "fig13", {"amplitude": [1.0, 3.0]}, r"$\Lambda=3$ (unstable)"),
    ],
)
def test_an_orbit_that_no_ball_follows_or_keeps_is_named_and_looks_different(
    stage, name, change, words
):
    given = yaml.safe_load((REFERENCE.parent / "config/config.yaml").read_text("utf-8"))
    given = given[stage.__name__.rpartition(".")[2]][name] | change
    more = () if stage is restitution_model else ("displacement",)
    data = stage.STAGE[name](given, *more)
    data.attrs["parameters"] = json.dumps(given)
    figure = figures.draw(name, data)
    (legend,) = figure.legends
    assert any(words in text.get_text() for text in legend.get_texts())
    assert "--" in {line.get_linestyle() for line in figure.axes[0].lines}
