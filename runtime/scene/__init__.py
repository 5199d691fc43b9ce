"""Scenes: a surface, a material and an operating range in a TOML file.

Reading one needs the extra ``cli`` (msgspec), and ``units`` (Pint) if a quantity is written with a unit.
"""

from hystrip.scene.load import BUILTIN, load_scene, parse_scene
from hystrip.scene.model import Scene

__all__ = ["BUILTIN", "Scene", "load_scene", "parse_scene"]
