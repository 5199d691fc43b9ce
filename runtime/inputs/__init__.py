"""What a user describes: the material of the foundation, the adhesion, and the levels of the surface."""
