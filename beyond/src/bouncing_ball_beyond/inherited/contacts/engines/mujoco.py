r"""MuJoCo's contact, in MuJoCo, Newton and Genesis: a spring and damper of accelerations.

They are weighted by the impedance d: ``solref`` and ``solimp``.

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
:mod:`bouncing_ball_beyond.inherited.contacts.engines.impedance`.

*Newton*, SolverMuJoCo, has ``timeconst = 2/kd`` and ``dampratio = kd/(2√ke)``, so that ke = k/m in
1/s² and kd = c/m in 1/s, as in the direct form of ``solref``. Its impedance is the attribute
``mujoco:geom_solimp``, which exists after ``SolverMuJoCo.register_custom_attributes``. Contacts
with friction are pyramids of several rows, which with a small impedance add up to another contact:
``mujoco:condim`` must be 1. Without friction, or with very little, these pyramids are singular: in
Newton 1.8.0 the ball's state is not a number after one step, or with a small impedance the ball is
thrown out. With ``mujoco:condim`` = 1 a friction of 0 is right. A kd of 0 is not a contact without
damping, but MuJoCo's default. Newton computes with single precision.

*Genesis*, ``sol_params`` of a geometry, has the positive form and the five numbers of the
impedance. The option ``constraint_timeconst`` of its rigid solver sets T only, with ζ = 1, where a
free impact has r = e⁻² for every T: it cannot set the bounce. Genesis raises T to two time steps.
Its scheme is MuJoCo's, and so are its bounces at every time step. A ball that sinks in deeper than
its radius falls through the plane.

Sources: the kernels of Newton 1.8, and the rigid solver of Genesis 1.4.5, read with the engines
themselves.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.contacts.engines.engine import (
    Engine,
    EngineParameters,
    LawInSI,
    at_speeds,
)
from bouncing_ball_beyond.inherited.contacts.engines.impedance import Impedance
from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.inherited.contacts.engines.scheme import Scheme
from bouncing_ball_beyond.inherited.errors import ModelError, shortened
from bouncing_ball_beyond.models.damping import Release

# What is written between numbers and around them elsewhere.
_BETWEEN = re.compile(r"[\s,;()\[\]]+")
# The defaults of MuJoCo: dmin, dmax, width in m, midpoint and power.
_DEFAULT = (0.9, 0.95, 0.001, 0.5, 2.0)
# The limits that MuJoCo imposes on an impedance.
_LEAST = 1e-4
_MOST = 0.9999
# A contact with an impedance up to this value is treated as a spring and damper.
_FELT = 0.01
# The longest time constant in s that is taken for one; more is a stiffness without its sign.
_LONGEST = 100.0


def _numbers(name: str, value: str | Sequence[float], counts: range) -> list[float]:
    """The numbers of an attribute, given as a text, as in XML, or as a sequence."""
    parts = value.split() if isinstance(value, str) else np.ravel(value).tolist()
    allowed = f"{counts[0]} to {counts[-1]} numbers"
    hint = ""
    if len(counts) == 1:
        allowed = "2 numbers"
        hint = ": '0.02 0.5' (s, damping ratio) or '-1e4 -20' (-k/m, -c/m)"
    try:
        found = [float(part) for part in parts]
    except (TypeError, ValueError):
        found = [np.nan]
    if len(found) not in counts or not np.all(np.isfinite(found)):
        shown = value if isinstance(value, str) else " ".join(map(str, parts))
        apart = " ".join(_BETWEEN.sub(" ", shown).split())
        how = "without commas" if apart == " ".join(shown.replace(",", " ").split()) else "plainly"
        hint = hint if apart == shown else f": write it {how}, {apart!r}"
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


def _parameters(contact: Physical, law: LawInSI | None = None) -> EngineParameters:
    # Differences, because -c/m of a contact without damping would be -0.0.
    stiffness = 0.0 - contact.stiffness / contact.mass
    damping = 0.0 - contact.damping / contact.mass
    return {"solref": [stiffness, damping], "solimp": [_LEAST, _LEAST, 0.001]}


def _solref(engine: Engine, parameters: Mapping[str, Any]) -> tuple[float, float]:
    """The two numbers of ``solref``, after a check of ``solimp``."""
    impedance(parameters.get("solimp", ()))
    if "solref" not in parameters:
        raise ModelError("solref is missing: give it, such as the default of MuJoCo, '0.02 1'")
    first, second = _numbers("solref", parameters["solref"], range(2, 3))
    return first, second


def _contact_of(m: float, first: float, second: float) -> tuple[float, float]:
    """k and c of either form of ``solref``.

    Examples
    --------
    >>> _contact_of(0.5, -1e5, -20.0), _contact_of(1.0, 0.02, 0.5)
    ((50000.0, 10.0), (10000.0, 100.0))
    """
    if first < 0 and second <= 0:
        return -first * m, abs(second) * m
    if first > _LONGEST and second > 0:
        raise ModelError(
            f"solref = '{first:g} {second:g}' is a time constant of {first:g} s, which no "
            f"simulation has: -k/m and -c/m are written '-{first:g} -{second:g}'"
        )
    if first > 0 and second > 0:
        return m / (first * second) ** 2, 2 * m / first
    raise ModelError(
        f"solref = '{first:g} {second:g}' is neither two negative numbers, -k/m and -c/m, nor "
        "two positive ones, a time constant and a damping ratio"
    )


def _law(
    parameters: Mapping[str, Any], mass: float = 1, time: float = 1, length: float = 1
) -> Impedance | None:
    """The law of an impedance of which the load is felt.

    Examples
    --------
    The frequency of 100 rad/s is ϖ = 50 if the unit of time 1/Ω is half a second:

    >>> _law({"solref": "0.02 0.5"}, time=0.5).frequency_ratio
    50.0
    """
    at_surface, deep, width, midpoint, power = impedance(parameters.get("solimp", ()))
    contact = MUJOCO.read(parameters, 1.0)
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


def _remarks(parameters: Mapping[str, Any]) -> tuple[str, ...]:
    law = _law(parameters)
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
        # Impacts as deep as a tenth of the width, as the width, and as ten of it.
        speeds = law.width * law.frequency_ratio * np.array([0.1, 1, 10])
        found += (
            f"this is the contact below the depth of {law.width:g} m; at the surface the "
            f"spring is {share**2:.2g} and the damper {share:.2g} of it",
            f"a free impact has {at_speeds(law, speeds)}, and {spring.restitution:.4f} "
            "where it is much deeper than that",
        )
    return found


MUJOCO = Engine(
    name="mujoco",
    names=("solref", "solimp"),
    releases=(Release.FORCE,),
    scheme=Scheme.SEMI_IMPLICIT,
    parameters=_parameters,
    contact_of=_contact_of,
    numbers=_solref,
    law=_law,
    remarks=_remarks,
    defaults={"solref": "0.02 1", "solimp": " ".join(f"{number:g}" for number in _DEFAULT)},
)
"""The direct form of ``solref``, with the smallest impedance."""


def _genesis_parameters(contact: Physical, law: LawInSI | None = None) -> EngineParameters:
    constant = time_constant("genesis", contact)
    return {"timeconst": constant, "dampratio": contact.damping_ratio}


def _genesis_contact(m: float, constant: float, zeta: float) -> tuple[float, float]:
    if zeta == 0:
        raise ModelError("dampratio = 0 is no contact of genesis: its time constant is 2 m/c")
    return m / (constant * zeta) ** 2, 2 * m / constant


GENESIS = Engine(
    name="genesis",
    names=("timeconst", "dampratio"),
    releases=(Release.FORCE,),
    scheme=Scheme.SEMI_IMPLICIT,
    parameters=_genesis_parameters,
    contact_of=_genesis_contact,
)
"""``set_sol_params``: T and ζ, with the smallest impedance."""


def _newton_parameters(contact: Physical, law: LawInSI | None = None) -> EngineParameters:
    # Raises for a contact without damping.
    time_constant("newton-mujoco", contact)
    return {"ke": contact.stiffness / contact.mass, "kd": contact.damping / contact.mass}


def _newton_contact(m: float, stiffness: float, damping: float) -> tuple[float, float]:
    if damping == 0:
        raise ModelError(
            "kd = 0 of newton-mujoco is no contact without damping, but the default of MuJoCo: "
            "kd is c/m in 1/s"
        )
    return stiffness * m, damping * m


NEWTON_MUJOCO = Engine(
    name="newton-mujoco",
    names=("ke", "kd"),
    releases=(Release.FORCE,),
    scheme=Scheme.SEMI_IMPLICIT,
    parameters=_newton_parameters,
    contact_of=_newton_contact,
    remarks=lambda _: (
        "ke and kd are per unit of mass in SolverMuJoCo: k/m in 1/s^2 and c/m in 1/s",
        "without mujoco:condim = 1 a friction mu of 0 gives no numbers in Newton 1.8.0",
    ),
)
"""SolverMuJoCo: ke = k/m and kd = c/m."""
