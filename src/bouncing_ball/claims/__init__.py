"""The ledger of the paper's claims with a verdict on each, from datasets alone.

A verdict compares the *paper* with the replication, in units of the printed digits. Whether a run
agrees with the accepted record is another question, with other tolerances
(:mod:`bouncing_ball.compare`). An argument ``data`` is a mapping from the names of datasets to the
datasets; all numbers are dimensionless.
"""
