"""The figures and tables of the paper: one module for each stage, its pictures beside it.

========= ============================== =========================== ===========================
item      module                         study                       drawing
========= ============================== =========================== ===========================
Fig. 1    :mod:`.schematics_figures`     –                           ``restitution_model``
Fig. 2    :mod:`.restitution_model`      ``restitution_history``     ``restitution_history``
Fig. 3    :mod:`.restitution_model`      ``restitution_orbits``      ``restitution_families``
Fig. 4    :mod:`.schematics_figures`     –                           ``spring_damper_model``
Fig. 5, 6 :mod:`.apparent_restitution`   ``apparent_restitution``    ``apparent_restitution``
Fig. 7    :mod:`.time_histories`         ``contact_history``         ``contact_history``
Fig. 8, 9 :mod:`.continuation_of_orbits` ``orbit_branches``          ``domains``
Fig. 10   :mod:`.apparent_restitution`   ``frequency_sweep``         ``bounce_velocity``
Fig. 11   :mod:`.permanent_contact`      ``permanent_contact``       ``permanent_contact``
Fig. 12   :mod:`.time_histories`         ``both_histories``          ``both_histories``
Fig. 13   :mod:`.apparent_restitution`   ``poincare_map``            ``poincare_map``
Fig. 14   :mod:`.error_thresholds`       ``height_error``            ``height_error``
Fig. 15   :mod:`.continuation_of_orbits` ``both_domains``            ``both_domains``
Fig. 16   :mod:`.permanent_contact`      ``permanent_contact_error`` ``permanent_contact_error``
Table 1   :mod:`.continuation_of_orbits` ``stability_ranges``        ``table1``
========= ============================== =========================== ===========================

A study is a function ``study(parameters, …)`` of the module that returns a dataset, and a function
in the module ``…_figures`` draws this dataset and computes nothing. The rules in
``workflow/rules/datasets.smk`` and ``figures.smk`` run them. Two modules have no picture and decide
claims in words: :mod:`.lowest_period_doubling` and :mod:`.kinds_of_motion`. Modules share
:mod:`.orbit_parameters`, :mod:`.errors_along_ratio` and :mod:`.printed_table1`.
"""
