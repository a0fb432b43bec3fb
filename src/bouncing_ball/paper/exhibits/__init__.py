"""The figures and tables of the paper: one module for each stage, its pictures beside it.

============= ==========================================
Fig. 1, 4     :mod:`.schematics_figures`
Fig. 2, 3     :mod:`.restitution_model`
Fig. 5, 6     :mod:`.apparent_restitution`
Fig. 7, 12    :mod:`.time_histories`
Fig. 8, 9, 15 :mod:`.continuation_of_orbits`
Fig. 10, 13   :mod:`.apparent_restitution`
Fig. 11, 16   :mod:`.permanent_contact`
Fig. 14       :mod:`.error_thresholds`
Table 1       :mod:`.continuation_of_orbits`
============= ==========================================

A stage is a function ``study(parameters, …)`` that returns a dataset; the function of the same
stage in the module ``…_figures`` draws it and computes nothing. Two stages have no picture and
decide claims in words: :mod:`.lowest_period_doubling` and :mod:`.kinds_of_motion`. Stages share
:mod:`.orbit_parameters`, :mod:`.errors_along_ratio` and :mod:`.printed_table1`.
"""
