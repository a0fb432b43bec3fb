"""The ledger of the paper's claims with a verdict on each, from datasets alone.

A verdict compares the *paper* with the replication, in printed digits. Whether a run agrees with
the accepted record is another question, with other tolerances: :mod:`bouncing_ball.compare`.
Functions called ``data`` take a mapping from a dataset's name to the dataset; all numbers are
dimensionless.
"""
