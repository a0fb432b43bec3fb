"""The replication article from its templates: every number from a dataset."""
