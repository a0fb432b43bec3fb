"""The replication article, made from templates that take every number from a dataset."""
