"""Figures in the axes, the size and the font size that a user asks for.

The functions that draw make their panels by
:func:`~bouncing_ball_beyond.inherited.drawing.canvas.canvas`, which returns the axes of the user
inside :func:`drawn_into`.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from bouncing_ball_beyond.inherited.drawing.canvas import GIVEN
from bouncing_ball_beyond.inherited.errors import ModelError


def axes_in(given: Axes | Iterable[Axes] | None) -> tuple[Axes, ...]:
    """Axes, or an array of them, in a row; none for None.

    Raises
    ------
    ModelError
        If something else than axes of matplotlib is given.

    Examples
    --------
    >>> axes_in("left")
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: ax = 'left' is no axes of matplotlib
    """
    found = () if given is None else tuple(np.ravel(np.asarray(given, dtype=object)))
    if wrong := [each for each in found if not isinstance(each, Axes)]:
        raise ModelError(f"ax = {wrong[0]!r} is no axes of matplotlib")
    return found


@contextmanager
def drawn_into(axes: Axes | Iterable[Axes] | None) -> Iterator[None]:
    """A context in which a figure is drawn into given axes, one for each of its panels."""
    token = GIVEN.set(axes_in(axes))
    try:
        yield
    finally:
        GIVEN.reset(token)


def fit_figure(
    figure: Figure, axes: Iterable[Axes], size: tuple[float, float] | None, font_size: float | None
) -> None:
    """Give a figure a size in inches, and scale all its texts, or those of the axes of a user.

    The font size is that of titles and labels; smaller texts, such as the numbers at the ticks,
    remain smaller in proportion.

    Raises
    ------
    ModelError
        If a size is not positive.
    """
    if size is not None:
        if np.shape(size) != (2,) or not all(0 < x < np.inf for x in size):
            raise ModelError(f"size = {size!r} is not a width and a height in inches, both > 0")
        figure.set_size_inches(*size)
    panels = tuple(axes)
    if font_size is not None:
        _scale_texts(figure, panels, font_size)
    if not panels:
        _fit_legends(figure)


def _scale_texts(figure: Figure, panels: tuple[Axes, ...], font_size: float) -> None:
    if not 0 < font_size < np.inf:
        raise ModelError(f"font_size = {font_size!r} is not a number of points > 0")
    scale = font_size / rcParams["font.size"]
    scaled = panels or (figure,)
    texts = {id(text): text for part in scaled for text in part.findobj(Text)}
    for text in texts.values():
        text.set_fontsize(scale * text.get_fontsize())
    # Ticks are made anew whenever the limits change, with the size of their axis.
    for each in panels or figure.axes:
        for axis, default in (
            (each.xaxis, rcParams["xtick.labelsize"]),
            (each.yaxis, rcParams["ytick.labelsize"]),
        ):
            now = axis.get_tick_params().get("labelsize", default)
            axis.set_tick_params(which="both", labelsize=scale * now)


def _fit_legends(figure: Figure) -> None:
    """Give each legend of a figure as few columns as its width needs."""
    for legend in list(figure.legends):
        now = legend
        handles = legend.legend_handles
        texts = legend.get_texts()
        columns = len(texts)
        while now.get_window_extent().width > figure.bbox.width and columns > 1:
            columns -= 1
            now.remove()
            now = figure.legend(
                handles=handles,
                labels=[text.get_text() for text in texts],
                loc="outside lower center",
                ncols=columns,
                fontsize=texts[0].get_fontsize(),
            )
