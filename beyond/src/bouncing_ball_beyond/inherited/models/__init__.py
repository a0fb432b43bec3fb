"""The ball and the table: the flight, two models of the impact, permanent contact, simulation.

============================ ==========================================================
:mod:`.flight`               the table w = Λ sin τ, and the flight under gravity
:mod:`.damping`              damping from restitution (Eq. 16), the two release rules
:mod:`.model`                what both models share: what an impact does to a ball
:mod:`.restitution`          impacts with a restitution coefficient (Eqs. 2, 9)
:mod:`.spring_damper`        contacts with a spring and a damper (Eqs. 10-13, 23)
:mod:`.permanent_contact`    the thresholds Λ_CR and Λ_SD (Eqs. 9, 28-36)
:mod:`.simulation`           balls from impact to impact: the Poincaré map (Eq. 5)
:mod:`.history`              balls over time: the calls ``simulate``, ``history``, ``drop``
============================ ==========================================================

All quantities are dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g, phases in radians. The
displacement of the ball relative to the table is δ = z - w.
"""
