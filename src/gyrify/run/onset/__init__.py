"""Where the smooth equilibrium of the tissue loses stability, and what a state becomes without drag."""
