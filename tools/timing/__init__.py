"""Scenes, contestants and claims of the benchmark of run time against error."""
