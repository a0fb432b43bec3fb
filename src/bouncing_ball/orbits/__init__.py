"""n-T periodic orbits of both models: existence, stability, observables."""
