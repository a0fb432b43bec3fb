"""The corrected restitution model: an impact is an instant at the centroid of the contact force."""
