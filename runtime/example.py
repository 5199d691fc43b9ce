"""A tread compound on a rough road, as files to try everything with: what an instrument would export, made from a formula."""

import numpy as np

from .dma.read import shift_remark
from .inputs.shift import WLF

#: of a tread compound: relaxed modulus, Pa; a log-normal spectrum about 1e-7 s, two decades wide; WLF constants about 20 degC
_RELAXED, _HEIGHT, _CENTRE, _WIDTH, _SLOW = 2e6, 4e7, -7.0, 2.2, 5e4
_SHIFT = WLF(C_1=8.86, C_2=101.6, T_ref=293.15, vertical=1.0)
#: noise of the instrument, relative
_NOISE = 0.01
#: scan: points, length in um, rms height in um, Hurst exponent
_POINTS, _LENGTH, _RMS, _HURST = 256, 4000.0, 25.0, 0.8

SCENE = """\
# A tread compound on a rough road. Make it yours, step by step:
#   hystrip master raw.csv --vertical                        isotherms -> hystrip-out/raw.master.csv, for the next step in
#                                                            place of rubber.csv, which is a master curve already
#   hystrip fit rubber.csv --nu 0.49 --scene scene.toml      its relaxation times -> hystrip-out/rubber.fitted.toml
#   hystrip levels scan.txt --count 3 --scene hystrip-out/rubber.fitted.toml   the road -> hystrip-out/scan.levels.toml
#   hystrip solve hystrip-out/scan.levels.toml --summary     friction over velocity

title = "Tread compound on a rough road"
pressure = 3e5                                                     # nominal pressure [Pa]
velocity = { start = 1e-4, stop = 10, num = 60, spacing = "log" }  # sliding velocity [m/s]
edge = "constitutive"
rtol = 1e-3
# temperature = 313.15                                             # [K], with a [material.shift]; or text: "40 degC"

[material]                          # `hystrip fit` replaces it; here one relaxation time, roughly that of the compound
kind = "half-space"                 # every level gets the stiffness of its own wavelength
E = 2e6                             # relaxed Young's modulus [Pa]
nu = 0.49                           # Poisson ratio
moduli = [1e8]                      # Young's moduli of the branches [Pa]
times = [1e-6]                      # their relaxation times [s]

# Dry and clean the surfaces attract each other:
#   [adhesion]
#   gamma = 0.05                    # energy of adhesion [J/m^2]
#   p_0 = 5e5                       # adhesive stress [Pa]

[[levels]]                          # `hystrip levels` replaces it; here one wave
l = 1e-3                            # wavelength [m]
h = 5e-5                            # height from valley to summit [m]
"""


def rubber() -> dict[str, str]:
    """Files of the example by their names: a scene, a master curve, isotherms and a scan. Always the same bytes."""
    return {"scene.toml": SCENE, "rubber.csv": _master_curve(), "raw.csv": _isotherms(), "scan.txt": _scan()}


def _modulus(frequency: np.ndarray, T: float) -> np.ndarray:
    """``E*`` of the compound, Pa, at frequencies (n,), Hz, and a temperature, K."""
    times = np.geomspace(1e-11, 1e3, 57)
    moduli = 0.25 * (_HEIGHT * np.exp(-0.5 * ((np.log10(times) - _CENTRE) / _WIDTH) ** 2) + _SLOW * (times < 300))
    x = 2j * np.pi * float(_SHIFT.factor(T)) * np.multiply.outer(frequency, times)
    return (_RELAXED + (x / (1 + x)) @ moduli) * float(_SHIFT.modulus_factor(T))


def _master_curve() -> str:
    rng = np.random.default_rng(1)
    f = np.geomspace(1e-3, 1e9, 97)
    E = _modulus(f, _SHIFT.T_ref)
    rows = [
        f"{each:.6g},{1e-6 * storage:.6g},{1e-6 * loss:.6g}" for each, storage, loss in zip(f, *_measured(E, rng), strict=True)
    ]
    return "\n".join([f"# {shift_remark(_SHIFT)}", "f,E_stor,E_loss", "Hz,MPa,MPa", *rows]) + "\n"


def _isotherms() -> str:
    """As a European instrument writes them: semicolons, decimal comma, one row of names."""
    rng = np.random.default_rng(2)
    lines = ["Temperature [°C];Frequency [Hz];E' [MPa];E'' [MPa]"]
    for celsius in np.arange(-30, 61, 6):
        f = np.geomspace(0.1, 100, 13)
        storage, loss = _measured(_modulus(f, celsius + 273.15), rng)
        temperatures = celsius + 0.05 * rng.standard_normal(f.size)
        for row in zip(temperatures, f, 1e-6 * storage, 1e-6 * loss, strict=True):
            lines.append(";".join(f"{each:.5g}" for each in row).replace(".", ","))
    return "\n".join(lines) + "\n"


def _measured(E: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return np.array((E.real, E.imag)) * (1 + _NOISE * rng.standard_normal((2, E.size)))


def _scan() -> str:
    """Heights of a self-affine surface on a square, as Gwyddion exports them."""
    rng = np.random.default_rng(3)
    index = np.fft.fftfreq(_POINTS, 1 / _POINTS)
    q = np.hypot(*np.meshgrid(index, index))
    # waves from half of the length on, down to four points
    with np.errstate(divide="ignore"):
        amplitude = np.where((q >= 2) & (q <= _POINTS / 4), q ** -(1 + _HURST), 0.0)
    heights = np.fft.ifft2(amplitude * np.fft.fft2(rng.standard_normal(q.shape))).real
    heights *= _RMS / heights.std()
    head = ["# Channel: Height", f"# Width: {_LENGTH:g} µm", f"# Height: {_LENGTH:g} µm", "# Value units: m"]
    return "\n".join([*head, *("\t".join(f"{1e-6 * each:.4g}" for each in row) for row in heights)]) + "\n"
