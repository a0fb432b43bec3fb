"""The replication: each figure and table (:mod:`.exhibits`), and each claim (:mod:`.claims`).

:mod:`.claims.as_printed` has the formulas as the paper prints them, in its order, as far
as they are checked. The library computes with its equations in these functions and classes of
``bouncing_ball``. The motion in permanent contact (Eqs. 28-31) is only in its printed form, because
the library needs no more of it than the threshold that follows:

======== =========================== ==========================================================
Eqs.     what                        where
======== =========================== ==========================================================
1, 3, 4  flight                      ``models.flight.Flight``
2        impact                      ``models.restitution.RestitutionDynamics.depart``
5        from impact to impact       ``models.restitution.RestitutionDynamics``
6        phase of the n-T orbit      ``periodic.restitution_branch.phase``
7        its saddle-node             ``periodic.restitution_branch.saddle_node``
8        its period doubling         ``periodic.restitution_branch.period_doubling``
9        rest on the table, Λ_CR     ``models.sticking.lift_off_phase``
10, 11   force of the contact        ``models.spring_damper.SpringDamper.force``
12, 13   motion in contact           ``models.spring_damper.SpringDamper.flow``
14, 15   flight after it             ``periodic.orbit.Orbit.flight_path``
16       damping from restitution    ``models.damping.damping_ratio``
17       apparent restitution        ``periodic.orbit.Orbit.apparent_restitution``
18-20    period of the n-T orbit     ``periodic.orbit.Orbit.flight_time``
21, 22   its equations: the start    ``models.spring_damper.SpringDamper.flow``
23       the end of the contact      ``models.linear_contact.LinearContactDynamics.depart``
24-26    the return to the start     ``periodic.problem.PeriodicOrbits``
..       all, in unknowns of paper   ``periodic.paper_unknowns.PaperUnknowns``
..       solved at a given duration  ``periodic.spring_damper_branch.branch_point``
..       its saddle-node             ``periodic.spring_damper_bifurcations.saddle_node``
..       its period doubling         ``periodic.spring_damper_bifurcations.period_doubling``
27       bouncing-off velocity       ``periodic.orbit.Orbit.bounce_velocity``
28-31    permanent contact           ``paper.claims.as_printed.steady_displacement``
32, 33   its largest amplitude Λ_SD  ``models.permanent_contact.permanent_contact_threshold``
34, 35   the inverse of Λ_SD         ``models.permanent_contact.permanent_contact_frequency_ratios``
36       the smallest Λ_SD           ``models.permanent_contact.permanent_contact_minimum``
37, 38   errors                      ``accuracy.errors.relative_errors``
..       their thresholds, ϖ_h, ϖ_PC ``accuracy.thresholds.restitution_thresholds``
======== =========================== ==========================================================

Eqs. 1 and 10 are in metres and seconds, all others dimensionless. The paper solves Eqs. 21-26 by
continuation; at a given duration of the contact they are linear, so that the library also has
their solutions in closed form. The force release, at which the contact force vanishes, is a variant
of the paper's release (Eq. 23) and costs one symbol, κ.
"""
