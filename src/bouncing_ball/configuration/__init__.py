"""The configuration: one reader of YAML, one checker, and one description made from the types."""
