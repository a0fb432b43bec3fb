r"""The Hertz contact of two elastic bodies, with the damping of Tsuji, in SI units.

It has the force ``k x^{3/2} + C √(mk) x^{1/4} x′``, k = (4/3) E* √R. Its r is the same at every
speed (:mod:`bouncing_ball_beyond.models.laws.hertzian`), so that E*, R and r determine it. For two
elastic bodies, the ball and the table (Hertz), ::

    1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂
"""

import math

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.quantities import given
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.inherited.errors import ParameterError
from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping

MATERIALS = ("youngs_modulus", "poissons_ratio", "table_youngs_modulus", "table_poissons_ratio")
"""Moduli E and Poisson's ratios ν of the ball and of the table, from which E* follows."""
# What gives the stiffness of a linear contact, or of another law.
_NOT_HERTZ = ("stiffness", "contact_time", "penetration")


def reduced_modulus(contact: Contact) -> float | None:
    """E* of a Hertz contact in Pa, given or computed from the materials of both bodies.

    None if the contact is not a Hertz contact.

    Raises
    ------
    ModelError
        If one of the parameters that are needed together is missing.

    Examples
    --------
    For two bodies of the same material with ν = 0, E* is half of Young's modulus; on a much
    stiffer table it is Young's modulus of the ball:

    >>> same = dict.fromkeys(MATERIALS, 0.0) | {"radius": 1.0, "youngs_modulus": "2 GPa"}
    >>> round(reduced_modulus(Contact(**same | {"table_youngs_modulus": "2 GPa"})), 3)
    1000000000.0
    >>> round(reduced_modulus(Contact(**same | {"table_youngs_modulus": 1e30})), 3)
    2000000000.0
    """
    data = given(contact)
    known = [name for name in MATERIALS if name in data]
    if known:
        missing = " and ".join(f"{{{name}}}" for name in MATERIALS if name not in data)
        if missing:
            raise ParameterError(
                f"{{{known[0]}}} needs {missing}: both bodies are elastic, each with E and ν"
            )
    elastic = "youngs_modulus" if known else "reduced_modulus"
    # Beside a stiffness the radius says how deep a ball may sink in.
    by_itself = elastic not in data and not data.keys().isdisjoint(_NOT_HERTZ)
    if not by_itself and (elastic in data) != ("radius" in data):
        ways = "{reduced_modulus}, or {youngs_modulus} and the other data of both materials"
        raise ParameterError(
            f"{{{elastic}}} needs {{radius}}, the radius of curvature at the contact"
            if elastic in data
            else f"{{radius}} of a Hertz contact needs {ways}"
        )
    if not known:
        return contact.reduced_modulus
    ball, ball_ratio, table, table_ratio = (data[name] for name in MATERIALS)
    return 1 / ((1 - ball_ratio**2) / ball + (1 - table_ratio**2) / table)


def rayleigh_time(contact: Contact) -> float | None:
    r"""The time in s in which a Rayleigh wave passes half of the circumference of a ball.

    Codes for granular matter take a share of it as their time step. With the density ρ and the
    shear modulus G = E/(2(1 + ν)) it is ``πR √(ρ/G)/(0.1631ν + 0.8766)``. None if E, ν or the
    radius is not known.

    Examples
    --------
    A glass bead of 1 mm, as in LIGGGHTS' ``fix check/timestep/gran``:

    >>> mass = 2500 * 4 / 3 * math.pi * 0.5e-3**3
    >>> bead = Contact(mass=mass, radius="0.5 mm", youngs_modulus="70 GPa", poissons_ratio=0.25)
    >>> f"{rayleigh_time(bead):.4g}"
    '5.116e-07'
    """
    e, nu, radius = contact.youngs_modulus, contact.poissons_ratio, contact.radius
    if e is None or nu is None or radius is None:
        return None
    density = contact.mass / (4 / 3 * math.pi * radius**3)
    slowness = math.sqrt(density * 2 * (1 + nu) / e)
    return math.pi * radius * slowness / (0.1631 * nu + 0.8766)


def hertz(
    mass: float, modulus: float, radius: float, restitution: float, table: TableMotion
) -> Tsuji:
    """The dimensionless law of a Hertz contact with E* in Pa and R in m.

    Its stiffness is K = k √g/(mΩ³), and its damping C follows from r.

    Examples
    --------
    >>> law = hertz(1.0, 0.75, 4.0, 1.0, TableMotion(1.0, 1.0, 1.0))
    >>> float(law.stiffness), float(law.damping)
    (2.0, 0.0)
    """
    stiffness = 4 / 3 * modulus * math.sqrt(radius)
    unit = mass * table.angular_frequency**3 / math.sqrt(table.gravity)
    return Tsuji(stiffness / unit, float(tsuji_damping(restitution)))
