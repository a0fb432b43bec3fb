"""The origin of an artifact: its record in the artifact, and the answer of ``explain``."""
