"""The energy of the tissue as a sum of terms."""
