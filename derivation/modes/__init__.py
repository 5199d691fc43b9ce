"""The pipeline for a foundation with any number of relaxation times."""
