"""The replication article from its templates, with every number from a dataset."""
