"""The paper, whole, and nothing else; :mod:`bouncing_ball.beyond` is built on it.

============ ============================================ =========================================
Eqs. 1-5     flight, impact, map of the restitution model :mod:`.motion.restitution`
Eqs. 6-8     its n-T orbits and their bifurcations        :mod:`.orbits.restitution_branch`
Eq. 9        Λ_CR, rest and lift-off                      :mod:`.motion.sticking`
Eqs. 10-13   the contact                                  :mod:`.contact.spring_damper`
Eqs. 14-15   the flight                                   :mod:`.motion.flight`
Eq. 16       damping from restitution                     :mod:`.contact.damping`
Eqs. 17-27   n-T orbits                                   :mod:`.orbits.orbit`
..           their equations for the continuation         :mod:`.orbits.equations`
..           their branch in closed form                  :mod:`.orbits.spring_damper_branch`
..           saddle-nodes, period doublings               :mod:`.orbits.spring_damper_bifurcations`
Eqs. 28-36   permanent contact, Λ_SD and its inverse      :mod:`.contact.permanent_contact`
Eqs. 37-38   errors                                       :mod:`.comparison.errors`
..           their thresholds, ϖ_h and ϖ_PC               :mod:`.comparison.thresholds`
Figs., Table one module for each, listed at their top     :mod:`.exhibits`
in words     what is claimed, with a verdict              :mod:`.claims`
============ ============================================ =========================================

The force release, at which the contact force vanishes, is a variant of the paper's release; it
costs one symbol, κ.
"""
