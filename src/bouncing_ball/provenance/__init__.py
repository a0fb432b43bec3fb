"""Where an artifact comes from: what it carries, and the answer of ``explain``."""
