r"""MuJoCo: ``solref`` and ``solimp``, a spring and damper of accelerations, weighted by d.

The acceleration in contact is ``a₁ = (1 - d) a₀ - d (b v + κ x)``, where a₀ is the acceleration by
all other forces, x < 0 in contact, and d is the impedance of ``solimp`` (dmin at the surface, dmax
from the depth ``width`` on). If ``solref`` consists of two negative numbers (-K, -B), the direct
form, MuJoCo takes ``κ = K d/dmax²`` and ``b = B/dmax``. If it consists of two positive numbers, the
time constant T and the damping ratio ζ, MuJoCo takes ``κ = d/(dmax² T² ζ²)`` and
``b = 2/(dmax T)``. Where d = dmax, the impedance cancels, and the contact has ::

    k/m = K = 1/(T² ζ²),   c/m = B = 2/T,   c/(2√(km)) = ζ

per unit of mass. The impedance then affects the load only: in contact only the share 1 - d of
gravity and of the table's acceleration acts on the ball. A spring and damper corresponds to d = 0,
and the smallest d that MuJoCo allows is 10⁻⁴. Contacts with any impedance are the law
:mod:`bouncing_ball_contacts.engines.impedance`.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bouncing_ball.errors import ModelError, shortened
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import Engine, Physical, at_speeds
from bouncing_ball_contacts.engines.impedance import Impedance
from bouncing_ball_contacts.engines.scheme import Scheme
from bouncing_ball_contacts.engines.steps import ImpedanceStep

# What is written between numbers and around them elsewhere.
_BETWEEN = re.compile(r"[\s,;()\[\]]+")
# The defaults of MuJoCo: dmin, dmax, width in m, midpoint and power.
_DEFAULT = (0.9, 0.95, 0.001, 0.5, 2.0)
# The limits that MuJoCo imposes on an impedance.
_LEAST = 1e-4
_MOST = 0.9999
# A contact with an impedance up to this value is treated as a spring and damper.
_FELT = 0.01
# The smallest time constant that MuJoCo allows by default, in time steps.
_SAFE = 2
# The longest time constant in s that is taken for one; more is a stiffness without its sign.
_LONGEST = 100.0


def _numbers(name: str, value: str | Sequence[float], counts: range) -> list[float]:
    """The numbers of an attribute, given as a text, as in XML, or as a sequence."""
    parts = value.split() if isinstance(value, str) else np.ravel(value).tolist()
    allowed = f"{counts[0]} numbers" if len(counts) == 1 else f"{counts[0]} to {counts[-1]} numbers"
    try:
        found = [float(part) for part in parts]
    except (TypeError, ValueError):
        found = [np.nan]
    if len(found) not in counts or not np.all(np.isfinite(found)):
        shown = value if isinstance(value, str) else " ".join(map(str, parts))
        apart = " ".join(_BETWEEN.sub(" ", shown).split())
        how = "without commas" if apart == " ".join(shown.replace(",", " ").split()) else "plainly"
        hint = "" if apart == shown else f": write it {how}, {apart!r}"
        raise ModelError(f"{name} = {shortened(shown)} is not {allowed}{hint}")
    return found


def impedance(solimp: str | Sequence[float] = ()) -> list[float]:
    """dmin, dmax, width, midpoint and power of ``solimp``; missing numbers are MuJoCo's defaults.

    Raises
    ------
    ModelError
        If there are more than five numbers, or an impedance is not between 0 and 1.

    Examples
    --------
    >>> impedance("1e-4 1e-4")
    [0.0001, 0.0001, 0.001, 0.5, 2.0]
    >>> impedance("0.25 0.75 0")
    [0.5, 0.5, 0.0, 0.5, 2.0]
    """
    given = _numbers("solimp", solimp, range(6))
    for value in given[:2]:
        if not 0 <= value <= 1:
            raise ModelError(f"solimp has the impedance {value:g}, which is not in [0, 1]")
    found = given + list(_DEFAULT[len(given) :])
    at_surface, deep, width, midpoint, power = found
    at_surface = float(np.clip(at_surface, _LEAST, _MOST))
    deep = float(np.clip(deep, _LEAST, _MOST))
    if width <= 0:
        # MuJoCo then takes the mean of dmin and dmax.
        at_surface = deep = (at_surface + deep) / 2
    return [at_surface, deep, width, midpoint, power]


def time_constant(engine: str, contact: Physical) -> float:
    """T = 2m/c in s of a contact, for engines that know no other form of its damping.

    Raises
    ------
    ModelError
        If the contact has no damping.

    Examples
    --------
    >>> time_constant("genesis", Physical(mass=2.0, stiffness=200.0, damping=4.0))
    1.0
    """
    if contact.damping == 0:
        raise ModelError(f"{engine} has no contact without damping: its time constant is 2 m/c")
    return 2 * contact.mass / contact.damping


class MuJoCo(Engine):
    """Contacts by the direct form of ``solref``, with the smallest impedance.

    Examples
    --------
    >>> contact = Physical(mass=0.5, stiffness=5e4, damping=10.0)
    >>> MuJoCo().parameters(contact)
    {'solref': [-100000.0, -20.0], 'solimp': [0.0001, 0.0001, 0.001]}
    >>> MuJoCo().read(MuJoCo().parameters(contact), 0.5) == contact
    True

    The form with two positive numbers, whose default is 20 ms and critical damping:

    >>> MuJoCo().read({"solref": "0.02 0.5"}, 1.0)
    Physical(mass=1.0, stiffness=10000.0, damping=100.0)

    Its frequency of 100 rad/s is ϖ = 50 if the unit of time 1/Ω is half a second:

    >>> MuJoCo().law({"solref": "0.02 0.5"}, time=0.5).frequency_ratio
    50.0
    """

    name = "mujoco"
    names = ("solref", "solimp")
    releases = (Release.FORCE,)
    scheme = Scheme.SEMI_IMPLICIT

    def parameters(self, contact: Physical) -> dict[str, list[float]]:
        # Differences, because -c/m of a contact without damping would be -0.0.
        stiffness = 0.0 - contact.stiffness / contact.mass
        damping = 0.0 - contact.damping / contact.mass
        return {"solref": [stiffness, damping], "solimp": [_LEAST, _LEAST, 0.001]}

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        values = {name: value for name, value in parameters.items() if value is not None}
        m = self._given(values, mass)
        impedance(values.get("solimp", ()))
        if "solref" not in values:
            raise ModelError("solref is missing: give it, such as '-10000 -20'")
        first, second = _numbers("solref", values["solref"], range(2, 3))
        if first < 0 and second <= 0:
            return Physical(m, -first * m, abs(second) * m)
        if first > _LONGEST and second > 0:
            raise ModelError(
                f"solref = '{first:g} {second:g}' is a time constant of {first:g} s, which no "
                f"simulation has: -k/m and -c/m are written '-{first:g} -{second:g}'"
            )
        if first > 0 and second > 0:
            return Physical(m, m / (first * second) ** 2, 2 * m / first)
        raise ModelError(
            f"solref = '{first:g} {second:g}' is neither two negative numbers, -k/m and -c/m, nor "
            "two positive ones, a time constant and a damping ratio"
        )

    def law(
        self, parameters: Mapping[str, Any], mass: float = 1, time: float = 1, length: float = 1
    ) -> Impedance | None:
        at_surface, deep, width, midpoint, power = impedance(parameters.get("solimp", ()))
        contact = self.read(parameters, 1.0)
        if max(at_surface, deep) <= _FELT:
            return None
        return Impedance(
            frequency_ratio=contact.angular_frequency * time,
            damping_ratio=contact.damping_ratio,
            share=deep,
            at_surface=at_surface,
            width=(width or 1.0) / length,
            midpoint=midpoint,
            power=power,
        )

    def at_parameters(
        self, parameters: Mapping[str, Any], mass: float | None, time_step: float
    ) -> tuple[Engine, Physical]:
        contact, _ = self.stepped(parameters, mass, time_step)
        direct = [-contact.stiffness / contact.mass, -contact.damping / contact.mass]
        law = self.law({**parameters, "solref": direct})
        return self if law is None else _MuJoCoOfLaw(law), contact

    def stepped(
        self, parameters: Mapping[str, Any], mass: float | None, time_step: float
    ) -> tuple[Physical, tuple[str, ...]]:
        """The contact that MuJoCo computes with parameters and a time step in s.

        By default MuJoCo raises a positive time constant to two time steps (``refsafe``).

        Examples
        --------
        >>> found = MuJoCo().at_step_of({"solref": "0.001 0.1"}, 1.0, 0.002)
        >>> found.is_stable, found.remarks[0]
        (False, 'MuJoCo raises the time constant of 0.001 s to 0.004 s, two time steps (refsafe)')
        """
        first, second = _numbers("solref", parameters.get("solref", ()), range(2, 3))
        contact = self.read(parameters, mass)
        remarks: tuple[str, ...] = ()
        safe = _SAFE * time_step
        if 0 < first < safe:
            contact = self.read({**parameters, "solref": [safe, second]}, mass)
            remarks = (
                f"MuJoCo raises the time constant of {first:g} s to {safe:g} s, two time steps "
                "(refsafe)",
            )
        law = self.law(parameters)
        if law is not None and law.has_kink:
            remarks += (
                f"this holds for impacts much deeper than {law.width:g} m, the width of solimp",
            )
        return contact, remarks

    def at_depth(self, parameters: Mapping[str, Any], depth: float) -> str:
        law = self.law(parameters)
        if law is None:
            return super().at_depth(parameters, depth)
        return f"where the impedance is {float(law.impedance(np.array(depth))):.3g}"

    def remarks(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        law = self.law(parameters)
        if law is None:
            return ()
        # Deep in, where the impedance is constant, a free impact is that of a spring and damper.
        spring = Impedance(law.frequency_ratio, law.damping_ratio, 0.0).signature(1.0)
        found: tuple[str, ...] = (
            f"with the impedance {law.share:g} a contact feels {1 - law.share:.2g} of the load "
            '(gravity, table), and a spring and a damper all of it: solimp = "1e-4 1e-4 0.001"',
        )
        if law.has_kink:
            share = law.at_surface / law.share
            speeds = law.width * law.frequency_ratio * np.array([0.1, 1, 10])
            found += (
                f"this is the contact below the depth of {law.width:g} m; at the surface the "
                f"spring is {share**2:.2g} and the damper {share:.2g} of it",
                f"a free impact has {at_speeds(law, speeds)}, and {spring.restitution:.4f} "
                "where it is much deeper than that",
            )
        return found


class _MuJoCoOfLaw(MuJoCo):
    """MuJoCo with an impedance of which the load is felt, in SI units."""

    def __init__(self, law: Impedance):
        self._law = law

    def step(self, contact: Physical, release: Release, time_step: float) -> ImpedanceStep:
        return ImpedanceStep(self._law, time_step)
