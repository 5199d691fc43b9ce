"""What the pages say in words, beside what the derivation says of its steps: ``words.toml``."""

import tomllib
from pathlib import Path

WORDS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
