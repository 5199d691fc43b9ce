"""Eq. 1 to 16 as the paper prints them, and what each is about: ``printed.toml``."""

import tomllib
from pathlib import Path

_EQUATIONS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
PRINTED = {int(number): row["latex"] for number, row in _EQUATIONS.items()}
SUBJECTS = {int(number): row["subject"] for number, row in _EQUATIONS.items()}
