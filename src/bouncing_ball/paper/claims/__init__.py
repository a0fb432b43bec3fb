"""The claims of the paper: what is printed, a second computation of it, and the verdicts.

=============================================== ==================================
what is printed                                 :mod:`.as_printed`
the claims in three chapters                    :mod:`.impact_models`,
                                                :mod:`.periodic_orbits`,
                                                :mod:`.both_models`
numbers that decide them, from the datasets     :mod:`.evidence`
whether a dataset has the paper's parameters    :mod:`.paper_parameters`
verdicts by printed digits and conditions       :mod:`.verdict`
the printed formulas, computed again            :mod:`.formulas`
and as the package uses them                    :mod:`.formulas_in_use`
every orbit shown, by three routes              :mod:`.witness`
Table 1 under other readings of the paper       :mod:`.forensics`
=============================================== ==================================

A claim is a function (:mod:`.claim`), :mod:`.claims` decides all of them, and
:mod:`.claim_tables` lists them, also by the figures that they name (:mod:`.places`). To read the
claims, the first three rows are enough; the second computations, in the last four rows, stand each
for itself.
"""

FORMULA = "continuation and formula"
"""The two routes to an orbit whose comparison in :mod:`.witness` decides a claim."""
