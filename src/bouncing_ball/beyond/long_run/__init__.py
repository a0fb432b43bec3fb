"""The motions on which balls end: repeating, locked, chaotic; their means, exponents and cascades."""
