"""Contacts of any law, their motion and their orbits.

A law is a subclass of :class:`.ContactLaw`: the paper's is
:class:`~bouncing_ball_beyond.models.spring_damper.SpringDamper`, others are in :mod:`.hertzian` and
:mod:`.elasto_backlash`. :mod:`.law_of_impact` finds the law with a given restitution coefficient
and duration. :mod:`.force_law` is what the numerical methods know of a law, and :mod:`.loaded` what
they know beyond it of a law whose force depends on the load. :mod:`.panel`, :mod:`.sweeps`,
:mod:`.march` and :mod:`.linearised` compute contacts and their derivatives, :mod:`.collocation`
answers questions about them, :mod:`.motion` simulates balls on them, and :mod:`.steady_contact`
finds the largest Λ at which a ball stays on the table. :mod:`bouncing_ball_beyond.models.instant`
holds the numbers by which a short contact is an instantaneous impact, and :mod:`.signature` derives
them for a law. The n-T orbits on a law begin in
:mod:`bouncing_ball_beyond.periodic.one_impact.searched_orbits`.
"""
