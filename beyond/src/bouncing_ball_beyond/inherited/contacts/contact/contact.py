"""An engineer's contact: a ball and its contact with a table, as a user gives them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from bouncing_ball_beyond.inherited.contacts.contact.quantities import (
    ContactTime,
    Damping,
    DampingRatio,
    DropHeight,
    Loss,
    Mass,
    Penetration,
    PoissonsRatio,
    Radius,
    ReboundHeight,
    ReducedModulus,
    Stiffness,
    YoungsModulus,
    convert,
    given,
    text_of_given,
)
from bouncing_ball_beyond.inherited.contacts.engines.choice import engine_named, engine_of
from bouncing_ball_beyond.inherited.contacts.engines.engine import Engine, without_step
from bouncing_ball_beyond.inherited.contacts.engines.laws import LAWS
from bouncing_ball_beyond.inherited.errors import ParameterError, shortened, suggesting
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.models.named_laws import law_named
from bouncing_ball_beyond.models.spring_damper import SpringDamper

STIFF = ("stiffness", "contact_time", "penetration", "reduced_modulus", "youngs_modulus")
"""Parameters that determine the stiffness of a contact; a modulus needs the radius, too."""
LOSSY = ("damping", "damping_ratio", "restitution", "measured_restitution", "rebound_height")
"""Parameters that determine its loss; the height of a rebound needs that of the drop, too."""
# Parameters of MuJoCo that are lists; each of them is a separate argument.
_OF_MUJOCO = ("solref", "solimp")


def _numbers_by_name(given: Mapping[Any, Any]) -> dict[str, Any]:
    """Parameters of an engine as plain numbers; those that are None are left out, and the lists of
    MuJoCo stay as they are.

    Raises
    ------
    ModelError
        If a name is no text, or a value no number.
    """
    found: dict[str, Any] = {}
    for name, value in given.items():
        if not isinstance(name, str):
            raise ParameterError(
                "{parameters} has the name {}, which is not a text", shortened(name)
            )
        if value is None:
            continue
        if name in _OF_MUJOCO:
            found[name] = value
            continue
        try:
            found[name] = math.nan if isinstance(value, bool) else float(value)
        except (TypeError, ValueError):
            found[name] = math.nan
        if not math.isfinite(found[name]):
            why = "is not a number: give it in the unit of the engine, such as 1e5"
            raise ParameterError(f"{{parameters}} {name} = {{}} {why}", shortened(value))
    return found


@suggesting
@dataclass(frozen=True, kw_only=True, repr=False)
class Contact:
    """A ball and its contact with a table, by any parameters that determine them.

    One parameter gives the stiffness: ``stiffness``, ``contact_time``, ``penetration``, or for
    Hertz ``radius`` with ``reduced_modulus`` or the data of both materials. Without any of these
    the contact is still to be chosen. Another one gives the loss: ``damping``, ``damping_ratio``,
    ``restitution``, ``measured_restitution``, or ``drop_height`` with ``rebound_height``. In place
    of both, a contact may have the parameters of a physics engine.

    Parameters
    ----------
    mass
        Mass m of the ball.
    stiffness
        Stiffness k of the contact. If no parameter gives a stiffness, a contact is chosen.
    contact_time
        Duration of a free impact, in place of the stiffness.
    penetration
        Greatest compression in an impact on a table at rest, in place of the stiffness; needs the
        speed, or the height of a drop.
    reduced_modulus
        Reduced modulus E* of a Hertz contact with the damping of Tsuji; needs the radius.
    youngs_modulus
        Young's modulus E of the ball, in place of E*, where 1/E* is the sum of (1 - ν²)/E of the
        ball and of the table.
    poissons_ratio
        Poisson's ratio ν of the ball.
    table_youngs_modulus
        Young's modulus of the table.
    table_poissons_ratio
        Poisson's ratio of the table.
    radius
        Radius of curvature R of a Hertz contact; for a ball on a plane, the radius of the ball.
    damping
        Damping c of the contact; needs the stiffness.
    damping_ratio
        Damping ratio ζ = c/(2√(km)) of the contact.
    restitution
        Restitution coefficient of a free impact that ends at the table's level,
        r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper. With an engine, a law or the release "approach"
        it is r under that release. Beside the parameters of an engine it is the r that is wanted:
        the answer says what keeps them from it.
    measured_restitution
        Restitution coefficient of a free impact, without gravity, under the given release.
    drop_height
        Height of the drop in a drop test, with gravity, onto a table at rest; needs the height of
        the rebound.
    rebound_height
        Height of the rebound in a drop test, above the table at rest.
    release
        Where a contact ends: "displacement" at the table's level, the default without an engine,
        or "force" where the contact force vanishes; both are the same under "approach", where the
        damper acts while the ball approaches only.
    law
        Name of a contact law, such as hunt-crossley, in place of the linear one. It has the given
        restitution coefficient and contact time at the impact speed of the orbit.
    from_engine
        Physics engine whose parameters are given, in place of stiffness and loss. Without any of
        them it has its defaults.
    solref
        For MuJoCo: "-K -B" per unit of mass, or "TIMECONST DAMPRATIO".
    solimp
        For MuJoCo: "DMIN DMAX WIDTH MIDPOINT POWER", or the first of these numbers.
    parameters
        For the other engines: a parameter by its name, such as kn=1e5; for PyBullet and Drake also
        time_step, in s.

    Raises
    ------
    ModelError
        If a quantity is out of range or of another dimension, if one height of a drop test is
        missing, or if the parameters of an engine are given without its name or beside others.

    Examples
    --------
    >>> contact = Contact(mass="20 g", stiffness="1e4 kN/m", restitution="85 %")
    >>> contact
    Contact(mass=0.02, stiffness=10000000.0, restitution=0.85)
    """

    mass: Mass = None
    stiffness: Stiffness = None
    contact_time: ContactTime = None
    penetration: Penetration = None
    reduced_modulus: ReducedModulus = None
    youngs_modulus: YoungsModulus = None
    poissons_ratio: PoissonsRatio = None
    table_youngs_modulus: YoungsModulus = None
    table_poissons_ratio: PoissonsRatio = None
    radius: Radius = None
    damping: Damping = None
    damping_ratio: DampingRatio = None
    restitution: Loss = None
    measured_restitution: Loss = None
    drop_height: DropHeight = None
    rebound_height: ReboundHeight = None
    release: Literal["displacement", "force", "approach"] | str | None = None
    law: str | None = None
    from_engine: str | None = None
    solref: str | Sequence[float] | None = None
    solimp: str | Sequence[float] | None = None
    parameters: Mapping[str, float] | None = None

    __repr__ = text_of_given

    def __post_init__(self) -> None:
        convert(self)
        named: Any = self.parameters
        if named is not None and not isinstance(named, Mapping):
            why = "is not a mapping from names to numbers, such as dict(kn=1e5)"
            raise ParameterError(f"{{parameters}} = {{}} {why}", shortened(named))
        if named is not None:
            object.__setattr__(self, "parameters", _numbers_by_name(named))
            if isinstance(one := named.get("solref"), float | int):
                why = "gives one number, and solref has two: give {solref}, such as '0.02 0.5'"
                raise ParameterError(f"{{parameters}} solref={one:g} {why}")
        if self.from_engine is not None and not isinstance(self.from_engine, str):
            raise ParameterError("{from_engine} = {} is not a name", shortened(self.from_engine))
        if self.from_engine is None and self.named_parameters:
            first = next(iter(self.named_parameters))
            what = f"{{{first}}}" if first in _OF_MUJOCO else f"{{parameters}} {first}"
            raise ParameterError(f"{what} needs {{from_engine}}, the name of the engine")
        if self.from_engine is not None:
            for other in (*STIFF, *LOSSY, "law"):
                # The restitution that is wanted of the parameters.
                if getattr(self, other) is not None and other != "restitution":
                    raise ParameterError(f"{{{other}}} is not allowed with {{from_engine}}")
        if (self.rebound_height is None) != (self.drop_height is None):
            raise ParameterError("{rebound_height} and {drop_height} are needed together")

    @property
    def law_unless_spring_damper(self) -> type[ContactLaw] | None:
        """The class of the contact law; None for a spring and a damper, named or not.

        Raises
        ------
        ModelError
            If there is no such law.
        """
        name = str(self.law)
        if name.casefold() in ("hertz", "hertzian"):
            raise ParameterError(
                f"{{law}} {name} has no damper: Hertz's spring with a damper is {{law}} tsuji, or "
                "give {radius} and {reduced_modulus} in place of {law}"
            )
        kind = SpringDamper if self.law is None else law_named(self.law, LAWS)
        return None if kind is SpringDamper else kind

    @property
    def rule(self) -> Release:
        """The release rule, by default that of the law.

        Raises
        ------
        ModelError
            If there is no such rule, or no such law.
        """
        law = self.law_unless_spring_damper or SpringDamper
        return Release.of(self.release or law.release)

    @property
    def is_stiff(self) -> bool:
        """Whether a parameter gives the stiffness; a contact without one is to be chosen."""
        return self.from_engine is not None or not given(self).keys().isdisjoint(STIFF)

    @property
    def named_parameters(self) -> dict[str, Any]:
        """The parameters of an engine that are given, by name."""
        values = {name: getattr(self, name) for name in _OF_MUJOCO}
        values |= self.parameters or {}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def defaults(self) -> Mapping[str, Any]:
        """The parameters that the engine has by default, if none but the time step is given."""
        if self.from_engine is None or without_step(self.named_parameters):
            return {}
        return engine_named(self.from_engine).defaults

    @property
    def engine_parameters(self) -> dict[str, Any]:
        """The parameters of an engine by name: those that are given, or its defaults.

        Examples
        --------
        >>> Contact(mass=1.0, from_engine="mujoco").engine_parameters["solref"]
        '0.02 1'
        """
        return {**self.defaults, **self.named_parameters}

    @property
    def engine(self) -> Engine | None:
        """The engine whose parameters are given, or the part of it to which they belong.

        Raises
        ------
        ModelError
            If there is no such engine.
        """
        if self.from_engine is None:
            return None
        return engine_of(self.from_engine, self.engine_parameters)

    def by_stiffness_and_loss(self, written: str | None = None) -> "Contact":
        """The contact by other parameters than those of an engine, and with the release that it has
        in the engine for which it is written, in its own engine, or by itself.

        If r depends on the speed in its own engine, the damping is 0.

        Raises
        ------
        ModelError
            If a parameter is missing or not allowed, or an engine has no such contact.

        Examples
        --------
        >>> solref = Contact(mass=0.5, from_engine="mujoco", solref="-200 -4", solimp="1e-4 1e-4")
        >>> found = solref.by_stiffness_and_loss()
        >>> found.stiffness, found.damping, found.release
        (100.0, 2.0, 'force')
        """
        if self.release is not None and self.law_unless_spring_damper is not None:
            raise ParameterError(
                f"{{release}} is not allowed with {{law}} {self.law}, which has its own"
            )
        own = self.engine
        if own is None:
            if self.mass is None:
                raise ParameterError("the mass is missing: give {mass}, such as 20 g")
            return self if written is None else self.in_engine(written)
        mass, stiffness, damping = own.contact(self.engine_parameters, self.mass)
        found = Contact(mass=mass, stiffness=stiffness, damping=damping, release=self.release)
        if written is not None:
            return found.in_engine(written)
        if own.needs_speed:
            return found
        return replace(found, release=str(own.release(self.release)))

    def with_measured_restitution(self) -> "Contact":
        """The contact whose restitution is the measured one, under the release that it has.

        A contact with both restitutions stays as it is, because they contradict each other.
        """
        return replace(self, **self._measured())

    def _measured(self) -> dict[str, Any]:
        """The restitution as the measured one, by the names of the fields that change."""
        if self.restitution is None or self.measured_restitution is not None:
            return {}
        return {"restitution": None, "measured_restitution": self.restitution}

    def in_engine(self, name: str) -> "Contact":
        """The contact as it ends in the engine with this name, in which r is the measured one.

        Raises
        ------
        ModelError
            If there is no such engine, or if it has no such release or no such contact.

        Examples
        --------
        >>> contact = Contact(mass=1.0, stiffness=1e5, restitution=0.8).in_engine("mujoco")
        >>> contact.release, contact.measured_restitution
        ('force', 0.8)
        """
        engine = engine_named(name)
        rule = str(engine.release(self.release))
        is_hertz = self.reduced_modulus is not None or self.youngs_modulus is not None
        written = engine.names_of_laws
        if is_hertz and Tsuji.name not in written.values():
            raise ParameterError(f"a Hertz contact is not written for {name}: give {{stiffness}}")
        law = written.get(str(self.law), self.law)
        if self.law_unless_spring_damper is not None and law not in written.values():
            raise ParameterError(f"{{law}} {law} is not written for {name}: leave {{law}} out")
        return replace(self, release=rule, law=law, **self._measured())
