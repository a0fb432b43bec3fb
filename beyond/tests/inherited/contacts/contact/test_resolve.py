"""Stiffness and damping from every sufficient set, by two ways each."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.hertz import hertz
from bouncing_ball_beyond.inherited.contacts.contact.resolve import resolve
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper

STEEL_ON_GLASS = {
    "youngs_modulus": 2.1e11,
    "poissons_ratio": 0.3,
    "table_youngs_modulus": 6.4e10,
    "table_poissons_ratio": 0.2,
}
MASS = 0.02
TABLE = TableMotion(300.0, 1e-4, 9.81)


def found(release=Release.DISPLACEMENT, **given):
    case = resolve(Contact(**given, mass=MASS, release=release), TABLE)
    return case.stiffness, case.damping


def rise(contact, drop):
    """The height in m to which a ball rises on the table at rest, by the package's simulation."""
    speed = math.sqrt(2 * drop / TABLE.length)
    run = ContactModel(contact).simulate(0.0, 0.0, -speed, 1)
    up = float(run.relative_bounce_velocity[0])
    return TABLE.length * (float(run.release_displacement[0]) + up * up / 2)


@given(st.sampled_from(LINEAR), st.floats(1e2, 1e9), st.floats(1e-3, 0.6))
def test_every_set_gives_the_contact_it_was_taken_from(release, k, zeta):
    c = 2 * zeta * math.sqrt(k * MASS)
    ratio = math.sqrt(k / MASS) / TABLE.angular_frequency
    spring = SpringDamper(ratio, zeta, release)
    case = ResolvedContact(Contact(mass=MASS), TABLE, spring, spring)
    own = float(case.equivalent.restitution)
    time = case.contact_time
    printed = math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    for loss in (
        {"damping_ratio": zeta},
        {"restitution": printed},
        {"measured_restitution": own},
        {"drop_height": 2.0, "rebound_height": rise(case.equivalent, 2.0)},
    ):
        for stiff in ({"stiffness": k}, {"contact_time": time}):
            assert found(release, **stiff, **loss) == pytest.approx((k, c), rel=1e-9), loss
    assert found(release, stiffness=k, damping=c) == pytest.approx((k, c), rel=1e-14)


@pytest.mark.parametrize("release", LINEAR)
def test_the_contact_time_is_that_of_the_flow(release):
    k, c = found(release, contact_time=1e-3, restitution=0.6)
    # In seconds, without table and gravity: the flow is linear in the speed, and
    # so large a one leaves the weight below rounding.
    omega = math.sqrt(k / MASS)
    zeta = c / (2 * math.sqrt(k * MASS))
    end = SpringDamper(omega, zeta).flow(1e-3, 0.0, -1e12, 0.0, 0.0)
    held = end.displacement + (c / k) * end.velocity * (release is Release.FORCE)
    assert abs(held) < 1e-9 * end.velocity / omega


def test_the_hertz_contact_is_that_of_the_energy():
    # Without damping ½ m v² = ½ m x′² + (8/15) E* √R x^{5/2}; there and back.
    m, modulus, radius, v = 0.02, 1.15e11, 5e-3, 0.4
    rigid = 4 / 3 * modulus * math.sqrt(radius)
    deepest = (5 * m * v * v / (4 * rigid)) ** 0.4
    # x = deepest (1 - s²) takes the root out of the integrand.
    integral, _ = quad(lambda s: 2 * s / math.sqrt(1 - (1 - s * s) ** 2.5), 0, 1)
    law = hertz(m, modulus, radius, 1.0, TABLE)
    time = float(law.signature(v * TABLE.time / TABLE.length).duration) * TABLE.time
    assert time == pytest.approx(2 * deepest / v * integral, rel=1e-9)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"stiffness": 1e6}, "the loss of the contact is missing"),
        ({"stiffness": 1e6, "restitution": 0.5, "damping": 1.0}, "contradict each other"),
        ({"stiffness": 1e6, "contact_time": 1e-3, "restitution": 0.5}, "contradict each other"),
        ({"contact_time": 1e-3, "damping": 1.0}, "damping needs stiffness"),
        # Critical: 2√(km).
        ({"stiffness": 2.0, "damping": 0.4}, "= 1 is too large"),
        ({"stiffness": 1e6, "damping_ratio": 1.0}, "the critical damping 1"),
        ({"stiffness": 1e6, "rebound_height": 0.5}, "needed together"),
        ({"reduced_modulus": 1e11, "restitution": 0.5}, "reduced_modulus needs radius"),
        (
            {"radius": 1e-2, "restitution": 0.5},
            "radius of a Hertz contact needs reduced_modulus",
        ),
        ({**STEEL_ON_GLASS, "restitution": 0.5}, "youngs_modulus needs radius"),
        (
            {"youngs_modulus": 1e11, "restitution": 0.5},
            "youngs_modulus needs poissons_ratio and table",
        ),
        (
            {**STEEL_ON_GLASS, "radius": 1e-2, "reduced_modulus": 1e11, "restitution": 0.5},
            "reduced_modulus and youngs_modulus contradict each other",
        ),
        ({"stiffness": 1e6, "drop_height": 0.5, "rebound_height": 1.0}, "above drop_height"),
    ],
)
def test_data_that_do_not_suffice_or_contradict_each_other_are_refused(given, says):
    with pytest.raises(ModelError) as error:
        found(**given)
    assert says in str(error.value)


def test_a_drop_test_that_returns_to_its_height_has_no_damping():
    assert found(stiffness=1e6, drop_height=1.0, rebound_height=1.0) == pytest.approx((1e6, 0))


def test_both_bodies_of_a_hertz_contact_yield_by_boussinesq():
    radius, depth = 5e-3, 1e-6
    law = resolve(Contact(**STEEL_ON_GLASS, radius=radius, restitution=0.9, mass=MASS), TABLE).law
    # The law is in units of g/Ω² and of the weight.
    force = MASS * TABLE.gravity * float(law.stiffness) * (depth / TABLE.length) ** 1.5
    edge = math.sqrt(radius * depth)
    peak = 3 * force / (2 * math.pi * edge**2)
    # Point loads p dA on the surface of a half-space sink its middle by (1 - ν²) p dA/(π E r).
    spread = 2 * math.pi * quad(lambda r: peak * math.sqrt(1 - (r / edge) ** 2), 0, edge)[0]
    sunk = [
        (1 - STEEL_ON_GLASS[f"{of}poissons_ratio"] ** 2)
        / (math.pi * STEEL_ON_GLASS[f"{of}youngs_modulus"])
        * spread
        for of in ("", "table_")
    ]
    assert sum(sunk) == pytest.approx(depth, rel=1e-12)


def test_r_is_that_of_the_damper_that_acts_on_approach_only():
    """Eq. 16 is that of a damper that acts in both directions: its r would be the square."""
    asked = Contact(mass=0.2, contact_time=4e-3, restitution=0.6, release="approach")
    measured = Contact(mass=0.2, contact_time=4e-3, measured_restitution=0.6, release="approach")
    table = TableMotion(100.0, 1e-3, 9.81)
    found = resolve(asked, table)
    assert found.equivalent == resolve(measured, table).equivalent
    # Down to the greatest depth the energy falls by the work of the damper, then the spring alone.
    omega = math.sqrt(found.stiffness / 0.2)
    zeta = found.damping / (2 * math.sqrt(found.stiffness * 0.2))
    damped = omega * math.sqrt(1 - zeta**2)
    down = math.acos(zeta) / damped
    deepest = math.exp(-zeta * omega * down) * math.sin(damped * down) / damped
    assert deepest * omega == pytest.approx(0.6, rel=1e-12)
