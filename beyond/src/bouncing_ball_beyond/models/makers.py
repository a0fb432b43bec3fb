"""Balls by their parameters: models of the impact, whose parameters are checked and are labels.

:func:`rigid` makes a ball of the restitution model, :func:`spring_damper` one on a spring-damper
contact, and :func:`corrected` one of the corrected restitution model of a contact. Parameters that
are arrays make several balls.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bouncing_ball.datasets.arguments import (
    DAMPING_RATIO,
    FREQUENCY_RATIO,
    RESTITUTION,
    Axis,
    DampingRatioAxis,
    FrequencyRatioAxis,
    ReleaseName,
    RestitutionAxis,
    checked,
    chosen,
    is_array,
)
from bouncing_ball.errors import ModelError, ParameterError, suggesting
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

LOSSES = ("restitution", "damping_ratio", "measured_restitution")
"""The parameters that determine the loss of an impact; exactly one of them is needed."""


@suggesting
def rigid(*, restitution: RestitutionAxis) -> RestitutionModel:
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
    >>> rigid(restitution=0.85)
    RestitutionModel(restitution=0.85)
    """
    given = {"restitution": checked("restitution", restitution, RESTITUTION)}
    return RestitutionModel(flattened(given)["restitution"]).labelled(given)


@suggesting
def spring_damper(
    *,
    frequency_ratio: FrequencyRatioAxis,
    restitution: RestitutionAxis | None = None,
    damping_ratio: DampingRatioAxis | None = None,
    measured_restitution: RestitutionAxis | None = None,
    release: ReleaseName = "displacement",
) -> ContactModel:
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
    >>> spring_damper(frequency_ratio=10.0, damping_ratio=0.1).law
    SpringDamper(frequency_ratio=10, damping_ratio=0.1, release='displacement')
    """
    chosen("release", release, [str(each) for each in LINEAR])
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
    return ContactModel(contact).labelled({**parameters, "release": str(release)})


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
    from bouncing_ball.datasets.labelled import Grid

    return Grid(**parameters).flat
