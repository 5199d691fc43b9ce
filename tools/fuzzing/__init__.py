"""Hostile inputs, made at random and made again from a seed and a number."""
