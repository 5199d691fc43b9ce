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
# A spring in series with two Kelvin-Voigt elements, as creep is measured: compliances and retardation times. A model is its
# operators, ``Q(d/dt) w = P(d/dt) p``, here the two sides of ``w/p = 1/K_g + J_1/(1 + T_1 s) + J_2/(1 + T_2 s)`` over one
# denominator; how many times it has, and what they are, follows. ``hystrip regenerate creep.py --out my_solver`` does on the
# command line what is done here.

(folder / "creep.py").write_text(
    """\
import sympy as sp

from hystrip.derivation import Parameter, operator_model

K_g, J_1, J_2, T_1, T_2 = sp.symbols("K_g J_1 J_2 T_1 T_2", positive=True)
s = sp.Symbol("s")
denominator = sp.expand((1 + T_1 * s) * (1 + T_2 * s))
numerator = sp.expand(denominator / K_g + J_1 * (1 + T_2 * s) + J_2 * (1 + T_1 * s))
MODEL = operator_model(
    "creep",
    [
        Parameter(K_g, "K_g", "Pa/m", "glassy stiffness"),
        Parameter(J_1, "J_1", "m/Pa", "compliance of the first element"),
        Parameter(J_2, "J_2", "m/Pa", "compliance of the second element"),
        Parameter(T_1, "T_1", "s", "its retardation time"),
        Parameter(T_2, "T_2", "s", "its retardation time"),
    ],
    Q=[denominator.coeff(s, i) for i in range(3)],
    P=[numerator.coeff(s, i) for i in range(3)],
)
"""
)
models = hystrip.derivation.load_model(folder / "creep.py")
hystrip.derivation.regenerate(folder / "my_solver", models=models)
print(*sorted(path.name for path in (folder / "my_solver").iterdir()), sep="\n")

# %%
# The certificate
# ---------------
#
# Every emitted function was compared with its expression at 420 digits; the bound of each is kept beside the code.

import json  # noqa: E402

certificates = json.loads((folder / "my_solver" / "certificates.json").read_text())
print(json.dumps(certificates, indent=1)[:600], "...")

# %%
# It solves
# ---------
#
# A solver is code that runs, so it is loaded by name and never by a scene alone.

solver = hystrip.load_solver(folder / "my_solver")
rubber = solver.material(K_g=2.5e10, J_1=9e-10, J_2=6e-11, T_1=1e-2, T_2=1e-4)
result = hystrip.solve(
    rubber, hystrip.Dugdale(gamma=0), [hystrip.Level(l=1e-5, h=1e-6)], pressure=200, velocity=np.geomspace(1e-5, 1, 25),
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
