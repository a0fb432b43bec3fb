"""The reference orbits solve the equations, in the stable range and beyond, under both rules."""

import numpy as np

from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits
from bouncing_ball_beyond.inherited.pipeline.job import typed
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

GIVEN = {"frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 40}, "seed": 31}


def test_the_reference_orbits_satisfy_the_equations_of_the_contact():
    data = typed(reference_orbits)(GIVEN)
    for rule in ("displacement", "force"):
        part = data.sel(release=rule)
        contact = SpringDamper.from_restitution(
            part.restitution.values, part.frequency_ratio.values, rule
        )
        names = ("amplitude", "phase", "contact_duration", "impact_velocity")
        orbit = Orbit.of(
            ContactModel(contact),
            part.n.values.astype(int),
            *(part[name].values for name in names),
        )
        there = np.isfinite(part.phase.values)
        assert there.mean() > 0.8
        # Rounding of a velocity of order 10.
        assert np.nanmax(orbit.defect()) < 1e-12
        stable = orbit.is_stable()[there]
        assert 0.5 < stable.mean() < 1
        # The force in the middle of the contact pushes.
        assert np.nanmin(part.contact_force) > 0
