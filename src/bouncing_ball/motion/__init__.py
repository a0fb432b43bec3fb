"""Event-driven simulation of every model, from any initial state."""
