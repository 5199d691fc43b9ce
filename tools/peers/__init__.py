"""Other ways to the same numbers, for the benchmark."""
