"""Two models of a ball that bounces on a vibrating table, and their differences.

In the restitution model an impact is an instant. In the spring-damper model an impact is a contact
of finite duration. The models are those of A. Carbonelli, J. Perret-Liaudet, E. Rigaud and M.-S.
Feki, *Investigation of restitution coefficient and spring-damper models for the bouncing ball
problem*, DETC2011-47870 (2011); the package `carbonelli2011` replicates the paper with them.

Read the modules in this order:

`restitution`
    map of the restitution model, its n-T orbits and their stability
`spring_damper`
    contact with a spring and a damper, its two release conditions, and permanent contact
`orbits`
    n-T orbits of the spring-damper model and their stability
`continuation`
    search for these orbits, and continuation of families of orbits
`errors`
    relative errors of the restitution model, and the stiffness that keeps them within a tolerance

Equations of the paper and the functions that implement them:

=========  =====================================================================================
Eq. 2      `restitution.impact_map`, the velocity after an impact
Eqs. 1, 3  `restitution.velocity`, velocity in flight
Eq. 4      `restitution.height`, height in flight
Eq. 5      `restitution.flight_time`, `restitution.impact_map`
Eq. 6      `restitution.bounce_velocity`, `restitution.impact_phase`
Eq. 7      `restitution.saddle_node`
Eq. 8      `restitution.holmes_period_doubling`; for Eq. 5, `restitution.period_doubling`
Eq. 9      `restitution.PERMANENT_CONTACT`, the threshold Λ_CR
Eqs. 10-11 `spring_damper.Contact`, the equation of motion in contact
Eqs. 12-13 `spring_damper.Contact.motion`
Eqs. 14-15 `orbits.Family.motion`, height and velocity in flight
Eq. 16     `spring_damper.damping_ratio`
Eq. 17     `orbits.Family.apparent_restitution`
Eqs. 18-27 `orbits.Family.equations`
Eqs. 28-33 `spring_damper.permanent_contact`
Eqs. 34-35 `spring_damper.permanent_contact_ratios`
Eq. 36     `spring_damper.lowest_permanent_contact`
Eqs. 37-38 `errors.relative_error`, `errors.threshold`
=========  =====================================================================================
"""

__version__ = "0.1.0"
