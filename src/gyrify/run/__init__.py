"""From a configuration to a stored run: simulation, limits, onset, warnings, measures and the summary."""
