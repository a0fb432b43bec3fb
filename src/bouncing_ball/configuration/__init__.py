"""The configuration: one reader of YAML, one checker, one description."""
