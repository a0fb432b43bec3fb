"""A ball on a vibrating table: a restitution coefficient, or a spring and a damper.

A replication of A. Carbonelli, J. Perret-Liaudet, E. Rigaud and M.-S. Feki, *Investigation of
restitution coefficient and spring-damper models for the bouncing ball problem*, DETC2011-47870
(2011). The chapters, in the order in which one reads them:

`restitution`
    the map of the restitution model, its n-T orbits and their stability
`spring_damper`
    the contact, its two conditions of release, and permanent contact
`orbits`
    the n-T orbits of the spring-damper model and their stability
`continuation`
    how these orbits are found and followed
`errors`
    relative errors of the restitution model, and from which stiffness on they are tolerable
`datasets`
    what the variables mean, how they are saved, and from which code they come
`drawing`, `figures`
    the pictures
`paper`, `verdicts`, `claims`
    what the paper has and prints, how a claim is judged, and what the paper claims
`tables`, `article`
    the texts that say what we find
`differences`, `compare`
    how files differ, and the comparison of results with the reference

From the equations of the paper to the code:

=========  =====================================================================================
Eq. 2      `restitution.impact_map`, the velocity after an impact
Eqs. 1, 3  `restitution.velocity`, velocity in flight
Eq. 4      `restitution.height`, height in flight
Eq. 5      `restitution.flight_time`, `restitution.impact_map`
Eq. 6      `restitution.bounce_velocity`, `restitution.impact_phase`
Eq. 7      `restitution.saddle_node`
Eq. 8      `restitution.holmes_period_doubling`; of Eq. 5 it is `restitution.period_doubling`
Eq. 9      `restitution.PERMANENT_CONTACT`
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
