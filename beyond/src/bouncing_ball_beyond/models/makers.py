"""Balls by their parameters: models of the impact, whose parameters are checked and are labels.

:func:`rigid` and :func:`spring_damper` are the functions of the inherited library, whose balls
become models of this house, and :func:`corrected` makes a ball of the corrected restitution model
of a contact. Parameters that are arrays make several balls.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, ParamSpec

from bouncing_ball_beyond.inherited.datasets.arguments import is_array
from bouncing_ball_beyond.inherited.errors import ModelError, suggesting
from bouncing_ball_beyond.inherited.models import model, restitution
from bouncing_ball_beyond.inherited.models import spring_damper as linear
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw

P = ParamSpec("P")


def _of_this_house(make: Callable[P, model.Model]) -> Callable[P, Any]:
    """The call that makes a ball of the inherited library and turns it into the model of this
    house."""

    @wraps(make)
    def made(*args: P.args, **kwargs: P.kwargs) -> Any:
        return a_ball(make(*args, **kwargs))

    return made


rigid = _of_this_house(restitution.rigid)
spring_damper = _of_this_house(linear.spring_damper)


@suggesting
def corrected(ball: Ball) -> Ball:
    """The ball whose impacts are instants at the centroid of the contact force of another ball.

    Parameters
    ----------
    ball : Ball
        A ball on a contact.

    Raises
    ------
    ModelError
        If the impacts of the ball have no contact, or the parameters of a law that is neither
        linear nor Hertzian are arrays.

    Examples
    --------
    >>> corrected(spring_damper(frequency_ratio=10.0, restitution=0.65)).label
    'ϖ = 10, ζ = 0.1359'
    """
    known: Any = a_ball(ball)
    if not known.is_known:
        return known.corrected()
    law = known.impact_law
    if not isinstance(law, ContactLaw):
        raise ModelError(f"{known.name} impacts have no contact that could be corrected")
    model = CorrectedModel.of_contact(law)
    return model.labelled({**known.parameters, "model": model.name})


def flattened(parameters: Mapping[str, Any]) -> Mapping[str, Any]:
    """The parameters at all places of the grid that their arrays span, one after another."""
    if not any(is_array(value) for value in parameters.values()):
        return parameters
    # Imported here, because a single ball needs no labels, and importing xarray takes longer than
    # computing its orbit.
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

    return Grid(**parameters).flat
