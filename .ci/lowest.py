"""Print the lowest allowed version of every dependency as constraints for pip: ``name==version``, from pyproject.toml."""

import re
import tomllib
from pathlib import Path

project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
extras = project["optional-dependencies"]
# benchmarks and documentation are built with what is newest
wanted = [*project["dependencies"], *(each for name, extra in extras.items() if name not in ("bench", "docs") for each in extra)]
for each in dict.fromkeys(wanted):
    if bounds := re.fullmatch(r"([\w-]+)>=([\d.]+)", each):
        print(f"{bounds[1]}=={bounds[2]}")
