"""How wrong one model of the impact is against another, and from which contact on it is right."""
