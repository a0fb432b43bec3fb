"""Balls, which all calls take: a model of the impact with its parameters.

:func:`rigid` makes a ball of the restitution model, :func:`spring_damper` one on a spring-damper
contact, and :func:`corrected` one of the corrected restitution model of a contact. Balls on
contacts of other laws are made in :mod:`~bouncing_ball.calls.law_balls`. Parameters that are arrays
make several balls.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from bouncing_ball.datasets.arguments import (
    DAMPING_RATIO,
    FREQUENCY_RATIO,
    RESTITUTION,
    Axis,
    DampingRatio,
    FrequencyRatio,
    Restitution,
    Rule,
    checked,
    chosen,
    is_array,
)
from bouncing_ball.errors import ModelError, ParameterError
from bouncing_ball.models.damping import Release
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.corrected_orbits import CorrectedModel
from bouncing_ball.periodic.model import ImpactModel
from bouncing_ball.periodic.restitution_model import RestitutionModel
from bouncing_ball.periodic.spring_damper_model import SpringDamperModel

if TYPE_CHECKING:
    from bouncing_ball.datasets.labelled import Grid

LOSSES = ("restitution", "damping_ratio", "measured_restitution")
"""The parameters that determine the loss of an impact; exactly one of them is needed."""


class Ball(ABC):
    """One ball, or several if parameters are arrays, whose impacts obey one model."""

    is_known: bool
    """Whether the model is known without a speed."""

    parameters: Mapping[str, Any]
    """The parameters by name. They become axes and attributes of results."""

    @abstractmethod
    def at_speed(self, speed: ArrayLike) -> ModelBall:
        """The ball with its model, where a law that is given by the r and D of a free impact has
        them at this impact speed.
        """

    @abstractmethod
    def at_orbit(self, n: int, amplitude: float, side: str = "stable") -> ModelBall:
        """The ball with its model, where a law that is given by the r and D of a free impact has
        them at the impact speed of this n-T orbit.

        Raises
        ------
        NoOrbitError
            If the law depends on the orbit and there is none.
        """

    @abstractmethod
    def at_limits(self, n: ArrayLike) -> ModelBall:
        """The ball with its model, where a law that is given by the r and D of a free impact has
        them at the impact speed of the restitution model's n-T orbits, 2πn/(1 + r).
        """

    @abstractmethod
    def corrected(self) -> Ball:
        """The ball of the corrected restitution model of this contact."""

    def grid(self, **arguments: Any) -> Grid:
        """The grid that arguments of a call and the parameters span, in this order."""
        # Imported here, because a single orbit needs no labels.
        from bouncing_ball.datasets.labelled import Grid

        return Grid(**arguments, **self.parameters)

    @abstractmethod
    def row(self, grid: Grid) -> Ball:
        """The balls at the places of a grid of which the parameters are arguments, one after
        another.
        """

    @abstractmethod
    def take(self, number: int) -> Ball:
        """One ball of a row; a single ball is unchanged."""


@dataclass(frozen=True, eq=False)
class ModelBall(Ball):
    """A ball whose model is known.

    Parameters
    ----------
    model : ImpactModel
        One model, or a row of models, one for each place of the grid of the parameters.
    parameters : mapping
        The parameters by name; empty for a model that was made without this module.

    Examples
    --------
    >>> ModelBall(RestitutionModel(0.5)).at_speed(3.0).model
    RestitutionModel(restitution=0.5)
    """

    model: ImpactModel
    parameters: Mapping[str, Any] = field(default_factory=dict)

    is_known = True

    def at_speed(self, speed: ArrayLike) -> ModelBall:
        return self

    def at_orbit(self, n: int, amplitude: float, side: str = "stable") -> ModelBall:
        return self

    def at_limits(self, n: ArrayLike) -> ModelBall:
        return self

    def corrected(self) -> ModelBall:
        law = self.model.impact_law
        if isinstance(self.model, SpringDamperModel):
            model: CorrectedModel = CorrectedModel.of_contact(self.model.contact)
        elif isinstance(law, ContactLaw):
            model = CorrectedModel(Signature(law))
        else:
            raise ModelError(f"{self.model.name} impacts have no contact that could be corrected")
        return ModelBall(model, {**self.parameters, "model": "corrected"})

    def row(self, grid: Grid) -> ModelBall:
        number = grid.numbers_of(self.parameters)
        return replace(self, model=self.model.take(number))

    def take(self, number: int) -> ModelBall:
        return replace(self, model=self.model.take(number))


def rigid(*, restitution: Restitution) -> ModelBall:
    """A ball of the restitution model, whose impacts are instants (Eqs. 1-9).

    Parameters
    ----------
    restitution : float or array
        Restitution coefficient r in (0, 1].

    Raises
    ------
    ModelError
        If r is no number in its range.

    Examples
    --------
    >>> rigid(restitution=0.85).model
    RestitutionModel(restitution=0.85)
    """
    r = checked("restitution", restitution, RESTITUTION)
    flat = flattened({"restitution": r})
    return ModelBall(RestitutionModel(flat["restitution"]), {"restitution": r})


def spring_damper(
    *,
    frequency_ratio: FrequencyRatio,
    restitution: Restitution | None = None,
    damping_ratio: DampingRatio | None = None,
    measured_restitution: Restitution | None = None,
    release: Rule = "displacement",
) -> ModelBall:
    """A ball on a contact with a spring and a damper (Eqs. 10-27).

    Exactly one of the parameters restitution, damping_ratio and measured_restitution is needed.

    Parameters
    ----------
    frequency_ratio : float or array
        Frequency ratio ϖ of a spring-damper contact; the restitution model has none.
    restitution : float or array, optional
        Restitution coefficient r in (0, 1]. A spring-damper contact then has the damping ratio
        ζ with r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper.
    damping_ratio : float or array, optional
        Damping ratio ζ in [0, 1) of the contact, in place of the restitution coefficient.
    measured_restitution : float or array, optional
        Restitution coefficient of a free impact under the given release, in place of the
        parameter restitution, which always refers to the displacement release.
    release : str
        Where a contact ends: "displacement" at the table's level, as in the paper (default), or
        "force" where the contact force vanishes.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, out of range or contradicts another.

    Examples
    --------
    >>> spring_damper(frequency_ratio=10.0, damping_ratio=0.1).model.contact
    SpringDamper(frequency_ratio=10, damping_ratio=0.1, release='displacement')
    """
    chosen("release", release, [str(each) for each in Release])
    loss = the_loss(restitution, damping_ratio, measured_restitution)
    value = {
        "restitution": restitution,
        "damping_ratio": damping_ratio,
        "measured_restitution": measured_restitution,
    }[loss]
    allowed = DAMPING_RATIO if loss == "damping_ratio" else RESTITUTION
    parameters = {
        loss: checked(loss, value, allowed),
        "frequency_ratio": checked("frequency_ratio", frequency_ratio, FREQUENCY_RATIO),
    }
    flat = flattened(parameters)
    ratio = flat["frequency_ratio"]
    if loss == "damping_ratio":
        contact = SpringDamper(ratio, flat[loss], Release.of(release))
    else:
        measured = loss == "measured_restitution"
        contact = SpringDamper.from_restitution(flat[loss], ratio, release, measured=measured)
    return ModelBall(SpringDamperModel(contact), {**parameters, "release": str(release)})


def the_loss(
    restitution: Axis | None, damping_ratio: Axis | None, measured_restitution: Axis | None
) -> str:
    """The name of the one of the :data:`LOSSES` that is given.

    Raises
    ------
    ParameterError
        If none of them is given, or several.
    """
    values = (restitution, damping_ratio, measured_restitution)
    given = [name for name, value in zip(LOSSES, values, strict=True) if value is not None]
    if not given:
        names = " ".join(f"{{{name}}}" for name in LOSSES)
        raise ParameterError(f"one of the arguments {names} is required")
    if len(given) > 1:
        raise ParameterError(f"argument {{{given[1]}}}: not allowed with argument {{{given[0]}}}")
    return given[0]


def corrected(ball: Ball) -> Ball:
    """The ball whose impacts are instants at the centroid of the contact force of another ball.

    Parameters
    ----------
    ball : Ball
        A ball on a contact.

    Raises
    ------
    ModelError
        If the impacts of the ball have no contact, or the contacts of a law that is not linear
        have arrays of parameters.

    Examples
    --------
    >>> corrected(spring_damper(frequency_ratio=10.0, restitution=0.65)).model.label
    'linear with frequency ratio 10, damping ratio 0.135851'
    """
    return a_ball(ball).corrected()


def a_ball(ball: Any) -> Ball:
    """The first argument of a call, after a check of its type.

    Raises
    ------
    ParameterError
        If it is no ball.

    Examples
    --------
    >>> a_ball(0.85)
    Traceback (most recent call last):
    bouncing_ball.errors.ParameterError: the ball = 0.85 is not made by rigid, spring_damper, \
contact_law or corrected
    """
    if not isinstance(ball, Ball):
        how = "rigid, spring_damper, contact_law or corrected"
        raise ParameterError(f"the ball = {{}} is not made by {how}", repr(ball))
    return ball


def a_known_ball(ball: Any) -> ModelBall:
    """The first argument of a call that needs a model but has no speed.

    Raises
    ------
    ParameterError
        If it is no ball, or its model is not known without a speed.
    """
    if not a_ball(ball).is_known:
        raise ParameterError("{duration} needs {speed}")
    return ball


def a_single_ball(ball: Any) -> ModelBall:
    """The first argument of a call that takes one ball, whose model must be known.

    Raises
    ------
    ParameterError
        If it is no ball, a parameter is an array, or the model is not known without a speed.
    """
    for name, value in a_ball(ball).parameters.items():
        if is_array(value):
            raise ParameterError(f"{{{name}}} must be a single number here")
    return a_known_ball(ball)


def flattened(parameters: Mapping[str, Any]) -> Mapping[str, Any]:
    """The parameters at all places of the grid that their arrays span, one after another."""
    if not any(is_array(value) for value in parameters.values()):
        return parameters
    # Imported here, because a single ball needs no labels, and importing xarray takes longer than
    # computing its orbit.
    from bouncing_ball.datasets.labelled import Grid

    return Grid(**parameters).flat
