"""The replication: each figure and table (:mod:`.exhibits`), and each claim (:mod:`.claims`).

Less than half of the lines here show how each figure, number and verdict comes about. They are an
afternoon of reading, some four hours at ten lines a minute:

1. two hours for the figures and Table 1: the table in :mod:`.exhibits` leads to the module of each.
   :mod:`.exhibits.restitution_model` is the easiest, :mod:`.exhibits.continuation_of_orbits` the
   longest;
2. half an hour for the formulas, beside the paper: :mod:`.claims.as_printed` has them in its order;
3. an hour and a half for the claims, in the order of the paper: :mod:`.claims.impact_models`,
   :mod:`.claims.periodic_orbits` and :mod:`.claims.both_models`, and the numbers that decide them,
   :mod:`.claims.evidence`. One can also look them up, starting from ``figures/claims.md``.

The rest need not be read. In :mod:`.exhibits`, the modules ``…_figures`` draw datasets and compute
nothing, and ``orbit_parameters`` refuses parameters for which there is no orbit. In :mod:`.claims`,
``claim``, ``claims``, ``paper_parameters``, ``verdict``, ``places`` and ``claim_tables`` decide,
count and list the claims, and ``formulas``, ``formulas_in_use``, ``witness`` and ``forensics``
compute formulas, orbits and Table 1 once more, for those who doubt a number in the tables with
these names in ``figures``.

The library computes with the equations of the paper in the following functions and classes of
``bouncing_ball``. The docstring of each, or of its module, shows the equation as the paper writes
it and what its symbols are in the code. :mod:`.claims.formulas_in_use` compares each with the
printed form:

======= ========================= ==================================================================
Eqs.    what                      where
======= ========================= ==================================================================
1, 3, 4 flight                    ``models.flight.Flight``
2       impact                    ``models.restitution.RestitutionModel.impact``
5       from impact to impact     ``models.simulation.next_impact``
..      its first line            ``paper.claims.as_printed.landing_defect``
..      its second line           ``paper.claims.as_printed.bounced_velocity``
6       phase of the n-T orbit    ``periodic.restitution_branch.RestitutionBranch.orbit``
7       its saddle-node           ``periodic.restitution_branch.restitution_saddle_node``
8       its period doubling       ``periodic.restitution_branch.restitution_period_doubling``
9       rest on the table, Λ_CR   ``models.permanent_contact.RESTITUTION_THRESHOLD``
..      where a ball lifts off    ``models.restitution.lift_off_phase``
10, 11  force of the contact      ``models.spring_damper.force``
12, 13  motion in contact         ``models.spring_damper.flow``
..      with its A and B          ``periodic.continuation.PaperEquations.point``
..      as printed                ``paper.claims.as_printed.contact``
14, 15  flight after it           ``periodic.orbit.flight_path``
16      damping from restitution  ``models.damping.damping_ratio``
..      its inverse               ``models.damping.restitution_coefficient``
17      apparent restitution      ``periodic.orbit.Orbit.apparent_restitution``
18-20   period of the n-T orbit   ``periodic.orbit.Orbit.flight_time``
21-26   the six, written out      ``periodic.continuation.PaperEquations.residual``
..      end of contact, Eq. 23    ``models.spring_damper.SpringDamper.impact``
..      at a given duration       ``periodic.spring_damper_branch.branch_point``
..      their bifurcations        ``periodic.spring_damper_branch.SpringDamperBranch.bifurcation``
27      bouncing-off velocity     ``periodic.orbit.Orbit.bounce_velocity``
28-31   only as printed           ``paper.claims.as_printed.steady_displacement``
32, 33  permanent contact, Λ_SD   ``models.permanent_contact.permanent_contact_threshold``
34, 35  the inverse of Λ_SD       ``models.permanent_contact.permanent_contact_frequency_ratios``
36      the smallest Λ_SD         ``models.permanent_contact.permanent_contact_minimum``
37, 38  errors                    ``accuracy.errors.relative_errors``
..      of the greatest height    ``periodic.orbit.Orbit.max_height``
..      thresholds ϖ_h, ϖ_PC      ``accuracy.thresholds.search``
======= ========================= ==================================================================

The library does not compute with Eqs. 28-31, the motion in permanent contact, because it needs only
the threshold that follows from them (Eqs. 32 and 33). The row of these equations leads to the
printed form of the last one. Eqs. 18 and 20 are conditions, which n-T orbits meet because they have
one impact in n periods; the function is that of Eq. 19. Eq. 8 is the period doubling of Holmes'
map: its function gives it for that map, and by default that of the exact return map.

Eqs. 1-3 and 10 are in metres and seconds, all others dimensionless. The paper solves the six
equations of an orbit, Eqs. 21-26, by continuation, as the library does; at a given duration of the
contact they are linear, so that the library also has their solutions in closed form. The force
release, at which the contact force vanishes, is a variant of the paper's release (Eq. 23) and costs
one symbol, κ.
"""
