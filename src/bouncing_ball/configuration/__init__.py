"""The configuration of a run: reading YAML, checking it, and documenting it from the types."""
