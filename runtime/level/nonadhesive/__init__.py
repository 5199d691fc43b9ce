"""Levels without adhesion: all strips of a level at one velocity are one family, solved in closed form over the width of
their contact."""
