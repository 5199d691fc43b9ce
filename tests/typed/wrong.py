"""Every line behind a colon has a mistake that a type checker finds."""

import hystrip

material = hystrip.KelvinVoigt(K=1e9, T_eps=1e-2)
adhesion = hystrip.Dugdale(gamma=0)
level = hystrip.Level(l=10e-6, h=1e-6)
result = hystrip.solve(material, adhesion, level, pressure=100.0, velocity=[1e-3, 2e-3])

hystrip.solve(material, adhesion, level, pressure="100 Pa", velocity=1e-3)  #: a pressure as text
hystrip.solve(material, adhesion, level, pressure=100.0, velocity=1e-3, edge="continous")  #: the name of an edge
hystrip.solve(material, adhesion, level, pressure=100.0, velocity=1e-3, branch="unload")  #: the name of a branch
hystrip.solve(material, adhesion, level, velocity=1e-3)  #: no load
hystrip.solve(material, adhesion, level, pressure=100.0)  #: no velocity
hystrip.solve(material, adhesion, level, pressure=100.0, penetration=1e-7, velocity=1e-3)  #: two loads
hystrip.solve(material, adhesion, level, pressure=100.0, velocity=1e-3, rtoll=1e-3)  #: an option
hystrip.solve_level(material, adhesion, level, V=1e-3)  #: no load of a level
hystrip.solve_strip(material, adhesion, l=1e-6, A=1e-7, D="3", V=1e-3)  #: a penetration as text
hystrip.Dugdale()  #: nothing
hystrip.Dugdale(delta_0=1e-8)  #: a range alone
hystrip.Level(l="10 um", h=1e-6)  #: a length as text
hystrip.Prony(K=1e9, moduli=1e9, times=[1e-3])  #: one number for a sequence
hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2)  #: a missing time
result.plot("map of it")  #: the name of a picture
print(result.mmu)  #: an attribute
print(hystrip.slove)  #: a function
