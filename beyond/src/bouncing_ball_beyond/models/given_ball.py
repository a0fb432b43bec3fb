"""The first argument of a call: a ball of beyond, or a ball of the inherited library that becomes
one."""

from __future__ import annotations

from typing import Any

from bouncing_ball_beyond.inherited.datasets.arguments import is_array
from bouncing_ball_beyond.inherited.errors import ParameterError, shortened
from bouncing_ball_beyond.inherited.models import model as root
from bouncing_ball_beyond.inherited.models import restitution, spring_damper
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper


def a_ball(ball: Any) -> Ball:
    """A ball that is given to a call, or a :exc:`.ParameterError` if it is none.

    A ball of the inherited library becomes one of beyond, with the same parameters.

    Examples
    --------
    >>> from bouncing_ball_beyond import inherited
    >>> a_ball(inherited.spring_damper(frequency_ratio=10.0, damping_ratio=0.1))
    ContactModel(law=SpringDamper(frequency_ratio=10, damping_ratio=0.1, release='displacement'))

    >>> a_ball(0.85)
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: the ball = 0.85 is not a ball: it is \
not made by rigid, \
spring_damper, contact_law, corrected or ContactModel(law)
    """
    if isinstance(ball, root.Model):
        return _of_root(ball).labelled(ball.parameters)
    if not isinstance(ball, Ball):
        how = "rigid, spring_damper, contact_law, corrected or ContactModel(law)"
        raise ParameterError(
            f"the ball = {{}} is not a ball: it is not made by {how}", shortened(ball)
        )
    return ball


def _of_root(ball: root.Model) -> Ball:
    if isinstance(ball, restitution.RestitutionModel):
        return RestitutionModel(ball.restitution)
    if isinstance(ball, spring_damper.SpringDamper):
        release = Release.of(ball.release)
        return ContactModel(SpringDamper(ball.frequency_ratio, ball.damping_ratio, release))
    raise ParameterError("the ball = {} is of a model that is unknown here", shortened(ball))


def a_known_ball(ball: Any) -> Any:
    """The first argument of a call that needs a model but has no speed.

    Raises
    ------
    ParameterError
        If it is no ball, or its model is not known without a speed.
    """
    given = a_ball(ball)
    if not given.is_known:
        raise ParameterError(
            "{duration} needs {speed}: the r and D of a free impact are those of a speed"
        )
    return given


def a_single_ball(ball: Any) -> Any:
    """The first argument of a call that takes one ball, whose model must be known.

    Raises
    ------
    ParameterError
        If it is no ball, a parameter is an array, or the model is not known without a speed.
    """
    given = a_ball(ball)
    for name, value in given.parameters.items():
        if is_array(value):
            raise ParameterError(f"{{{name}}} must be a single number here")
    return a_known_ball(given)
