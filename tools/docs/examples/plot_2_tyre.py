r"""
A tyre tread, from DMA and a scan
=================================

Measured rubber and a measured road, to friction over velocity. Rubber is measured as storage and loss modulus over
frequency (dynamic mechanical analysis), the road as heights along a line. Here both files are made up on the spot, so
that the example runs anywhere; with your own it is the same calls.
"""

import tempfile
from pathlib import Path

import numpy as np

import hystrip

folder = Path(tempfile.mkdtemp())

# %%
# The rubber
# ----------
#
# A file with a row of names, a row of units, then numbers. This one has a broad transition.

f = np.geomspace(1e-1, 1e5, 49)
rates = np.geomspace(1e0, 1e5, 6)
weights = np.array([0.4, 0.9, 2.0, 4.0, 7.0, 9.0])
E = 4.0 + sum(w * (1j * f / r) / (1 + 1j * f / r) for w, r in zip(weights, rates, strict=True))
rows = "\n".join(f"{a:.6g},{b.real:.6g},{b.imag:.6g}" for a, b in zip(f, E, strict=True))
(folder / "rubber.csv").write_text(f"f,E_stor,E_loss\nHz,MPa,MPa\n{rows}\n")

data = hystrip.dma.read_dma(folder / "rubber.csv")
series = hystrip.dma.fit_prony(data, accuracy=0.05)
print(series.report())

# %%

fit = hystrip.plots.fitted_modulus(series, data)

# %%
# The road
# --------
#
# Heights along a line, with ever smaller waves on larger ones. Its spectrum is cut into bands, and each band becomes one
# level of waviness with the same rms height and gradient.

from hystrip.roughness import Scan, levels_of  # noqa: E402

n, length = 4096, 20e-3
q = 2 * np.pi * np.fft.rfftfreq(n, length / n)
rng = np.random.default_rng(7)
amplitude = np.where((q > 2 * np.pi / 6e-3) & (q < 2 * np.pi / 5e-5), np.where(q > 0, q, 1.0) ** -1.4, 0.0)
heights = np.fft.irfft(amplitude * np.exp(2j * np.pi * rng.random(q.size)), n)
scan = Scan(heights * 40e-6 / heights.std(), (length,), periodic=True)
found = levels_of(scan, count=2, longest=5e-3, shortest=1e-4)
print(found.report())

# %%

spectrum = hystrip.plots.roughness_levels(found, scan)

# %%
# Friction
# --------
#
# A tread is thick against the waves of the road, so the rubber is a half-space: every level gets the stiffness that a
# half-space shows at its wavelength. With several relaxation times the closure is ``constitutive``. Dry and clean rubber
# would stick; a wet or dusty road does not, so no adhesion here.

rubber = series.half_space(nu=0.49)
result = hystrip.solve(
    rubber, hystrip.Dugdale(gamma=0), found.levels, pressure=0.3e6, velocity=np.geomspace(1e-3, 10, 17),
    edge="constitutive", rtol=1e-2,
)  # fmt: skip
print(result)

# %%

tread = result.plot()
