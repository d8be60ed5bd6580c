"""The energy of gyrify's cells written for other finite element libraries."""
