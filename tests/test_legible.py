"""Every figure is legible at the ends of what the schema accepts."""

from itertools import combinations
from unittest import mock

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from tests.reference import CONFIG, reference, stage, with_parameters

from bouncing_ball import restitution
from carbonelli2011 import figures
from paper_replication.configuration import stages
from paper_replication.datasets import computed
from paper_replication.drawing import POINTS, ink

STAGES = {name: section for section, names in stages(CONFIG).items() for name in names}
"""The stage of each entry."""


def drawn(figure: Figure) -> list[Text | Line2D]:
    """The texts and lines that a figure shows. An axis also has numbers that it does not show."""
    shown: list[Text | Line2D] = []

    def recorded(kind):
        draw = kind.draw

        def draw_and_record(self, renderer):
            if self.get_visible():
                shown.append(self)
            draw(self, renderer)

        return mock.patch.object(kind, "draw", draw_and_record)

    with recorded(Text), recorded(Line2D):
        figure.draw_without_rendering()
    return list(dict.fromkeys(shown))


def marks(line: Line2D) -> list[Bbox]:
    """The boxes of the marks of a line inside its panel. Those of curves are no marks."""
    if line.get_marker() == "None" or line.get_markevery() is not None:
        return []
    half = line.get_markersize() / 2 * line.figure.dpi / POINTS
    inside = line.axes.bbox if line.axes else line.figure.bbox
    places = line.get_transform().transform(line.get_xydata())
    return [Bbox([at - half, at + half]) for at in places if inside.contains(*at)]


def crossed(line: Line2D, box: Bbox) -> bool:
    """Whether the line passes through a box inside its panel. The lines of a legend do not."""
    if line.axes is None or line.get_linestyle() == "None" or not box.overlaps(line.axes.bbox):
        return False
    path = line.get_transform().transform_path(line.get_path())
    return len(path) > 2 and path.intersects_bbox(box, filled=False)


def faults(figure: Figure) -> set[str]:
    """Texts that meet, that leave the page, or on which a mark or a curve is."""
    artists = drawn(figure)
    texts = {
        artist: ink(artist) for artist in artists if isinstance(artist, Text) and artist.get_text()
    }
    page = figure.bbox.padded(1)
    messages = set()
    for text, box in texts.items():
        if not (page.contains(*box.min) and page.contains(*box.max)):
            messages.add(f"{text.get_text()} leaves the page")
        for line in artists:
            if isinstance(line, Line2D):
                if any(box.overlaps(mark) for mark in marks(line)):
                    messages.add(f"{line.get_marker()} is on {text.get_text()}")
                if crossed(line, box):
                    messages.add(f"a curve is on {text.get_text()}")
    for (one, box), (other, beside) in combinations(texts.items(), 2):
        if box.overlaps(beside):
            messages.add(f"{one.get_text()} meets {other.get_text()}")
    return messages


def amplitude(n: int, r: float, place: float) -> float:
    """Λ at a place from the saddle-node (0) to the period doubling (1) of the restitution model."""
    first = restitution.saddle_node(n, r)
    return float(first + place * (restitution.period_doubling(n, r) - first))


def ratios(low: float, high: float, samples: int = 31) -> dict:
    return {"min": low, "max": high, "samples": samples}


def cases(n: int, *pairs: tuple[float, float]) -> list[dict]:
    """Curves or columns at some r and places."""
    return [{"restitution": r, "amplitude": amplitude(n, r, place)} for r, place in pairs]


def orbit(n: int, r: float, place: float = 0.4) -> dict:
    return {"n": n, "restitution": r, "amplitude": amplitude(n, r, place)}


TEN = [2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0, 123456.0]
DEAD_TO_LIVELY = [(0.1234 + 0.09 * k, 2.56789) for k in range(10)]
EXTREMES = [
    ("fig02", orbit(20, 0.98) | {"periods": 20}),
    ("fig03", {"n": [*range(1, 11)], "restitution": 0.5, "amplitude_max": 30.0}),
    ("fig03", {"n": [*range(1, 11)], "restitution": 0.98, "points": 101}),
    ("fig03", {"n": [3, 1], "restitution": 0.3, "amplitude_max": 6.0, "points": 101}),
    ("fig05", {"cases": cases(1, *DEAD_TO_LIVELY), "frequency_ratio": ratios(0.2, 123456.0)}),
    ("fig05", {"cases": cases(1, (0.05, 0.5), (0.98, 0.5)), "frequency_ratio": ratios(0.1, 1e6)}),
    (
        "fig10",
        {
            "n": 5,
            "restitution": 0.98,
            "amplitude": [amplitude(5, 0.98, k / 5) for k in range(1, 11)],
            "frequency_ratio": ratios(0.1, 1e6),
        },
    ),
    (
        "fig13",
        {
            "restitution": 0.05,
            "amplitude": [amplitude(1, 0.05, k / 10) for k in range(1, 11)],
            "frequency_ratio": ratios(1.0, 1e6),
        },
    ),
    ("fig13", {"frequency_ratio": ratios(100.0, 1e6)}),
    ("fig11", {"restitution": 0.14, "release": "force", "frequency_ratio": ratios(0.1, 1e6)}),
    ("fig16", {"restitution": 0.98, "frequency_ratio": ratios(0.1, 1e6)}),
    ("fig07", orbit(5, 0.05) | {"frequency_ratio": 1e6, "samples": 101}),
    ("fig07", orbit(1, 0.98) | {"frequency_ratio": 2.0, "samples": 101}),
    ("fig12", orbit(1, 0.65, 3.0) | {"frequency_ratio": TEN, "samples": 101}),
    ("motion", orbit(1, 0.65, 3.0) | {"frequency_ratio": TEN, "samples": 101}),
    ("fig14", orbit(5, 0.05) | {"frequency_ratio": ratios(0.1, 1e6), "tolerance": 0.000123}),
    (
        "impact_instant",
        {
            "n": 20,
            "cases": [
                case | {"frequency_ratio": ratio}
                for case, ratio in zip(
                    cases(20, (0.65, 0.5), (0.9, 0.5), (0.98, 0.5)),
                    (20.0, 1000.0, 345.6),
                    strict=True,
                )
            ],
            "samples": 101,
        },
    ),
    (
        "regimes",
        {
            "quantity": "apparent_restitution",
            "n": 5,
            "restitution": 0.05,
            "places": 5,
            "frequency_ratio": ratios(10, 1e6, 7),
        },
    ),
    ("regimes", {"restitution": 0.3, "places": 5, "frequency_ratio": ratios(50.0, 200.0, 7)}),
    ("regimes", {"restitution": 0.98, "places": 5, "advised": 12345.0}),
]
"""Figures with parameters at the ends of what is accepted: r, n, ϖ, and long lists."""


@pytest.mark.parametrize(("name", "changes"), EXTREMES)
def test_a_figure_is_legible_at_the_ends_of_what_is_accepted(name, changes):
    shown = "fig12" if name == "motion" else name
    settings = {key: CONFIG[key] for key in ("release", "largest_step")}
    given = settings | CONFIG[STAGES[shown]][shown] | changes
    assert faults(figures.draw(name, computed(stage(STAGES[shown]).STAGE[shown], given))) == set()


@pytest.mark.parametrize(
    ("name", "contacts"), [("fig08", TEN[-5:]), ("fig08", [1e6]), ("fig09", TEN)]
)
def test_branches_are_legible_as_many_as_are_accepted(name, contacts):
    """Their numbers are those of the reference, repeated, because branches take long to follow."""
    known = reference()[name]
    repeated = known.isel(frequency_ratio=np.arange(len(contacts)) % known.sizes["frequency_ratio"])
    data = repeated.assign_coords(frequency_ratio=contacts)
    assert faults(figures.draw(name, with_parameters(data, frequency_ratio=contacts))) == set()


def test_six_families_on_a_short_range_of_r_are_legible_on_the_map():
    """The numbers are those of the reference, repeated: a map takes long to compute."""
    known = reference()["validity_map"].isel(n=[0, 1, 2, 0, 1, 2], restitution=slice(5))
    r = np.linspace(0.9, 0.98, 5)
    data = known.assign_coords(n=[1, 2, 3, 5, 10, 20], restitution=r)
    assert faults(figures.draw("validity_map", with_parameters(data, advised=250000.0))) == set()


def test_a_branch_and_the_restitution_model_are_legible():
    data = reference()["fig15"].assign_coords(frequency_ratio=[123456.0])
    assert faults(figures.draw("fig15", data)) == set()
