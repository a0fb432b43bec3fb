"""Balls on contacts of any law, made by :func:`contact_law`.

A contact law may be given by the r and D of a free impact. r and D may depend on the speed of the
impact, so that such a ball has a model only at a speed: :meth:`.Ball.at_orbit` and
:meth:`.Ball.at_speed` return this model, and a model returns itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import (
    FREQUENCY_RATIO,
    POSITIVE,
    RESTITUTION,
    Axis,
    PositiveAxis,
    ReleaseName,
    checked,
    checked_number,
    chosen,
    is_array,
)
from bouncing_ball_beyond.inherited.errors import ParameterError, Range, shortened, suggesting
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact, reference
from bouncing_ball_beyond.models.makers import corrected, flattened
from bouncing_ball_beyond.models.named_laws import law_named
from bouncing_ball_beyond.periodic.one_impact.law_at_orbit import orbit_of_law
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed

if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

# A Hertzian contact of stiffness K lasts as long as a spring with ϖ ~ K^(2/5), at speeds of order
# one.
_RANGES = {"frequency_ratio": FREQUENCY_RATIO, "stiffness": Range(1e-20, 1e20, "[]")}


@dataclass(frozen=True, eq=False)
class FreeImpactBall(Ball):
    """A ball on the contact of a law that is given by the r and D of a free impact.

    Parameters
    ----------
    law_type : type of ContactLaw
    restitution : float
        r of the free impact.
    duration : float or array
        D of the free impact.
    is_corrected : bool
        Whether the ball obeys the corrected restitution model of the contact.
    """

    law_type: type[ContactLaw]
    restitution: float
    duration: Any
    is_corrected: bool = False

    is_known = False

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        found = {
            "law": self.law_type.name,
            "restitution": self.restitution,
            "duration": self.duration,
        }
        return found | ({"model": "corrected"} if self.is_corrected else {})

    def at_speed(self, speed: ArrayLike) -> Any:
        return self._with(law_of_impact(self.law_type, self.restitution, self.duration, speed))

    def at_orbit(self, n: int, amplitude: float, side: str = "stable") -> Any:
        given = self.law_type, self.restitution, self.duration
        return self._with(orbit_of_law(*given, n, amplitude, Side(side)).law)

    def at_limits(self, n: ArrayLike) -> Any:
        return self.at_speed(rigid_speed(n, self.restitution))

    def _with(self, law: ContactLaw) -> Ball:
        model = ContactModel(law).labelled(self.parameters)
        return corrected(model) if self.is_corrected else model

    def corrected(self) -> FreeImpactBall:
        """The ball of the corrected restitution model of this contact."""
        return replace(self, is_corrected=True)

    def row(self, grid: Grid) -> FreeImpactBall:
        return replace(self, duration=grid.flat["duration"])

    def take(self, which: int) -> FreeImpactBall:
        if not is_array(self.duration):
            return self
        return replace(self, duration=float(self.duration[which]))


@suggesting
def contact_law(
    law: str | ContactLaw,
    *,
    speed: PositiveAxis | None = None,
    restitution: float | None = None,
    duration: PositiveAxis | None = None,
    release: ReleaseName | Literal["approach"] | None = None,
    **parameters: Axis,
) -> Ball:
    """A ball on a contact of any law by its name.

    The law is given by its parameters, such as ``stiffness=1000.0, damping=0.08``, or by the
    restitution coefficient and the duration of a free impact. The ball of the linear law is that of
    :func:`spring_damper` if ζ < 1 and the release is linear.

    Parameters
    ----------
    law : str or ContactLaw
        Name of a contact law, in place of the linear spring and damper; or a law that you have
        written, with its parameters.
    speed : float, optional
        Speed of this free impact. The default is the impact speed of the orbit; for limits, the
        impact speed of the restitution model, 2πn/(1 + r); for a simulation, the first one.
    restitution : float, optional
        Restitution coefficient r in (0, 1] of a free impact.
    duration : float or array, optional
        Duration D of a free impact. With the restitution coefficient it replaces the
        parameters of the contact law.
    release : str, optional
        Where a contact of the linear law ends, "displacement" or "force", or "approach" if its
        damper acts on approach only; other laws determine it.
    **parameters : float or array
        The parameters of the law.

    Raises
    ------
    ModelError
        If the law is unknown, or a parameter is missing, unknown, of a wrong type or shape, out of
        range or contradicts another.

    Examples
    --------
    >>> contact_law("hunt-crossley", stiffness=1000.0, damping=0.08)
    ContactModel(law=HuntCrossley(stiffness=1000, damping=0.08))
    >>> contact_law("linear", frequency_ratio=10.0, damping_ratio=1.5).law
    SpringDamper(frequency_ratio=10, damping_ratio=1.5, release='displacement')
    >>> contact_law("linear", frequency_ratio=10.0, damping_ratio=0.5)
    ContactModel(law=SpringDamper(frequency_ratio=10, damping_ratio=0.5, \
release='displacement'))
    >>> ball = contact_law("hunt-crossley", restitution=0.8, duration=0.2)
    >>> ball.at_speed(3.0)
    ContactModel(law=HuntCrossley(stiffness=641.257, damping=0.124382))
    """
    if isinstance(law, ContactLaw):
        given = {"speed": speed, "restitution": restitution, "duration": duration}
        _refuse_beside(law, given | {"release": release} | parameters)
        model = ContactModel(law)
        return model.labelled({"law": law.name, **model.parameters})
    kind = law_named(law if isinstance(law, str) else shortened(law))
    if parameters:
        _refuse_free_impact(kind, parameters, restitution, duration, speed)
        found, labels = _law_of_parameters(kind, parameters, release)
        return ContactModel(found).labelled(labels)
    if restitution is None or duration is None:
        raise ParameterError(
            f"{{law}} {kind.name} needs {_needs(kind)}, or {{restitution}} and {{duration}}"
        )
    if release is not None:
        raise ParameterError("{release} is allowed with {parameters} of {law} linear only")
    if is_array(restitution):
        raise ParameterError(f"{{restitution}} must be a single number with {{law}} {kind.name}")
    ball = FreeImpactBall(
        law_type=kind,
        restitution=checked("restitution", restitution, RESTITUTION),
        duration=checked("duration", duration, POSITIVE),
    )
    # An r that no contact of this law has is refused here.
    reference(kind, ball.restitution)
    if speed is None:
        return ball
    at = checked_number("speed", speed, POSITIVE)
    known = replace(ball, duration=flattened({"duration": ball.duration})["duration"]).at_speed(at)
    return known.labelled({**ball.parameters, "speed": at})


def _refuse_beside(law: ContactLaw, given: Mapping[str, Any]) -> None:
    """Raise an error if a number is given beside a law that has its parameters already."""
    for name, value in given.items():
        if value is not None:
            raise ParameterError(
                f"{{{name}}} is not allowed with a law that has its parameters: {law.label}"
            )


def _needs(kind: type[ContactLaw]) -> str:
    return ", ".join(f"{{{name}}}=NUMBER" for name in kind.parameter_names())


def _refuse_free_impact(
    kind: type[ContactLaw],
    parameters: Mapping[str, Any],
    restitution: float | None,
    duration: Axis | None,
    speed: Axis | None,
) -> None:
    """Raise an error if a law has both parameters and a free impact."""
    free_impact = {"restitution": restitution, "duration": duration, "speed": speed}
    for name, value in free_impact.items():
        if value is not None:
            first = next(iter(parameters))
            raise ParameterError(
                f"{{{name}}} is not allowed with {{{first}}}: {_needs(kind)} determine {kind.name}"
            )


def _law_of_parameters(
    kind: type[ContactLaw], parameters: Mapping[str, Any], release: str | None
) -> tuple[ContactLaw, dict[str, Any]]:
    """The law, and its parameters as labels of a ball."""
    known = kind.parameter_names()
    for name in parameters:
        if name not in known:
            all_of = f"its parameters are {', '.join(known)}"
            raise ParameterError(f"unknown parameter {{}} of {kind.name}: {all_of}", repr(name))
    for name in known:
        if name not in parameters:
            raise ParameterError(f"{kind.name} also needs {{{name}}}=NUMBER")
    values = {name: checked(name, x, _RANGES.get(name, Range())) for name, x in parameters.items()}
    flat = flattened(values)
    labels = {"law": kind.name, **values}
    if release is None:
        return kind(**flat), labels
    if "release" not in kind.__dataclass_fields__:
        raise ParameterError(
            f"{{release}} is not allowed: {kind.name} determines where a contact ends"
        )
    rule = chosen("release", release, [str(each) for each in Release])
    law = kind(**flat, **{"release": Release.of(rule)})
    return law, labels | {"release": rule}
