"""Levels without adhesion: at one velocity all strips are one family, solved in closed form over the width of their contact."""
