"""Contacts of a ball: restitution coefficients, springs and dampers, and force laws."""
