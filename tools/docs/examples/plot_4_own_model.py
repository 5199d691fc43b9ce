r"""
A material model of one's own
=============================

A model is written down as a file of a few lines; SymPy derives the equations of every regime from it, integrates them,
checks each step, and emits a NumPy solver with a certificate of its rounding. Nothing is typed in by hand.
"""

import tempfile
from pathlib import Path

import numpy as np

import hystrip
import hystrip.derivation

folder = Path(tempfile.mkdtemp())

# %%
# The model
# ---------
#
# Relaxation times with moduli of their own, under a name. ``hystrip regenerate my_rubber.py --out my_solver`` does on
# the command line what is done here.

(folder / "my_rubber.py").write_text(
    "from hystrip.derivation import prony_model\n\n"
    'MODEL = prony_model("my_rubber", modes=2)\n'
)  # fmt: skip
models = hystrip.derivation.load_model(folder / "my_rubber.py")
hystrip.derivation.regenerate(folder / "my_solver", models=models)
print(*sorted(path.name for path in (folder / "my_solver").iterdir()), sep="\n")

# %%
# The certificate
# ---------------
#
# Every emitted function was compared with its expression at 50 digits; the bound of each is kept beside the code.

import json  # noqa: E402

certificates = json.loads((folder / "my_solver" / "certificates.json").read_text())
print(json.dumps(certificates, indent=1)[:600], "...")

# %%
# It solves
# ---------
#
# A solver is code that runs, so it is loaded by name and never by a scene alone.

solver = hystrip.load_solver(folder / "my_solver")
rubber = hystrip.Prony(K=1e9, moduli=[4e9, 2e10], times=[1e-2, 1e-4], solver=solver)
result = hystrip.solve(
    rubber, hystrip.Dugdale(gamma=0), [hystrip.Level(l=1e-5, h=1e-6)], pressure=2e4, velocity=np.geomspace(1e-5, 1, 25),
    edge="constitutive", rtol=1e-3,
)  # fmt: skip
curve = result.plot()

# %%
# The audit
# ---------
#
# ``generated/audit/index.html`` in the repository shows for the models that come with hystrip what ``hystrip audit`` writes
# for any: every equation of the paper by its number, the step that derives it, the check that proved it, the function that
# computes it.
