"""The ledger of the paper's claims and the verdict on each, from datasets alone.

This compares the *paper* with the replication, in printed digits. Whether a run
still says what the accepted record says is another question, with tolerances
of its own.
"""
