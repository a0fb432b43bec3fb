"""Motions of balls from impact to impact, and where they end."""
