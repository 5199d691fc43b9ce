"""Scenes: a surface, a material and an operating range in a TOML file.

Reading one needs the extra ``cli`` (msgspec), and ``units`` (Pint) if a quantity is written with a unit.

>>> text = '''
... pressure = "0.2 MPa"
... velocity = "1 mm/s"
... material = { K = "2 GPa/m", T_eps = "5 ms", T_sigma = "0.1 ms" }
... levels = [{ l = "20 um", h = "1 um" }]
... '''
>>> parse_scene(text).material
StandardLinearSolid(K=2000000000.0, T_eps=0.005, T_sigma=0.0001)
"""

from .load import BUILTIN, load_scene, parse_scene
from .model import Scene

__all__ = ["BUILTIN", "Scene", "load_scene", "parse_scene"]
