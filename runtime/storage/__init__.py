"""Results in files: written with everything they were solved from, read back equal to the bit."""
