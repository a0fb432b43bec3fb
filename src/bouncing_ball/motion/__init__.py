"""Event-driven simulation of both models, from any initial state."""
