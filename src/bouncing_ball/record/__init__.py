"""Provenance of artifacts, the accepted record and the comparison with it."""
