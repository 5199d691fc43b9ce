"""The text of a small scene, for tests to change."""

ONE_LEVEL = """pressure = 100
velocity = 5e-3
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[adhesion]
gamma = 2.5e-5
delta_0 = 1e-8
[[levels]]
l = 1e-5
h = 1e-6
"""
