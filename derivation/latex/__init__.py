"""LaTeX read back as SymPy."""
