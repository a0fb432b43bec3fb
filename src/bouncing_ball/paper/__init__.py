"""The replication: exhibits and claims. The equations are those of the library.

============ ========================================= ===========================================
Eqs. 1-5     flight, impact, map of the restitution model :mod:`..models.restitution`
Eqs. 6-8     its n-T orbits and their bifurcations     :mod:`..periodic.restitution_branch`
Eq. 9        Λ_CR, rest and lift-off                   :mod:`..models.sticking`
Eqs. 10-13   the contact                               :mod:`..models.spring_damper`
Eqs. 14-15   the flight                                :mod:`..models.flight`
Eq. 16       damping from restitution                  :mod:`..models.damping`
Eqs. 17-27   n-T orbits                                :mod:`..periodic.orbit`
..           their equations for the continuation      :mod:`..periodic.equations`
..           their branch in closed form               :mod:`..periodic.spring_damper_branch`
..           saddle-nodes, period doublings            :mod:`..periodic.spring_damper_bifurcations`
Eqs. 28-36   permanent contact, Λ_SD and its inverse   :mod:`..models.permanent_contact`
Eqs. 37-38   errors                                    :mod:`..accuracy.errors`
..           their thresholds, ϖ_h and ϖ_PC            :mod:`..accuracy.thresholds`
Figs., Table one module for each, listed at their top  :mod:`.exhibits`
in words     what is claimed, with a verdict           :mod:`.claims`
============ ========================================= ===========================================

The force release, at which the contact force vanishes, is a variant of the paper's release; it
costs one symbol, κ.
"""
