"""The origin of an artifact: what the artifact records of it, and the answer of ``explain``."""
