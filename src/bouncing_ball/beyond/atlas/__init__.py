"""The atlas: how stiff a contact must be, for all orbits; computed in shards."""
