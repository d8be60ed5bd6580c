"""The growing body of a configuration: its mesh, tissue, terms of energy, and the problem that is solved."""
