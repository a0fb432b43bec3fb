"""The claims of the paper: what is printed, a second computation of it, and the verdicts.

=========================================== ======================================
verdicts: the claims in three chapters      :mod:`.impact_models`,
                                            :mod:`.periodic_orbits`,
                                            :mod:`.both_models`
numbers that decide them, from the datasets :mod:`.evidence`
the printed formulas, computed again        :mod:`.formulas`
every orbit shown, by three routes          :mod:`.witness`
Table 1 under other readings of the paper   :mod:`.forensics`
=========================================== ======================================
"""
