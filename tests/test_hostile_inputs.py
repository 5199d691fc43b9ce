"""Small inputs made to hang or to crash: each is one clear error of ours, within a second."""

import gc
import importlib.util
import itertools
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import numpy as np
import pint
import pytest
from scene_text import ONE_LEVEL

import hystrip
from hystrip.dma import DynamicModulus, fit_prony, read_dma
from hystrip.roughness import read_surface
from hystrip.scene import load_scene, parse_scene
from hystrip.sweeps.over import over_of

DIGITS = "9" * 5000
ROUGHNESS = importlib.util.find_spec("SurfaceTopography") is not None
scans = pytest.param(read_surface, marks=pytest.mark.skipif(not ROUGHNESS, reason="needs the extra roughness"))


@contextmanager
def within_a_second(seconds=1.0):
    """Of processor time; what waits for ever is woken."""

    def wake(number, frame):
        raise AssertionError("hangs")

    before = signal.signal(signal.SIGALRM, wake)
    signal.alarm(30)
    # looking through what other tests have left in memory is none of its work
    gc.freeze()
    start = time.process_time()
    try:
        yield
        assert time.process_time() - start < seconds
    finally:
        gc.unfreeze()
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture(autouse=True, scope="module")
def loaded():
    """What is imported at the first call is not what is timed."""
    parse_scene(ONE_LEVEL.replace("pressure = 100", 'pressure = "0.1 kPa"'))
    if ROUGHNESS:
        import SurfaceTopography  # noqa: F401


@contextmanager
def refused(*said):
    with within_a_second(), pytest.raises(hystrip.HystripError) as error:
        yield
    message = str(error.value)
    assert len(message) < 1500 and message.isprintable(), message[:2000]
    for part in said:
        assert part in message


SCENES = [  # what stands in place of "K = 1e9", what the message says
    ("K = '1" + " " * 100_000 + "x'", ["material.K", "at most 100 characters"]),
    ("K = '1" + " " * 40 + "x" * 40 + "'", ["material.K", "x"]),
    ("K = '1 GPa/m**9**9**9'", ["material.K", "cannot be read as a unit"]),
    ("K = '1 Pa/(9 m)**9**9**9'", ["material.K", "cannot be read as a unit"]),
    ("K = '1 Pa/m**99999999'", ["material.K", "cannot be read as a unit"]),
    (f"K = {DIGITS}", ["not valid TOML", "4300 digits"]),
    (f"K = 0x{DIGITS}", ["material.K", "an integer of"]),
    (f"K = {'9' * 400}", ["material.K"]),
    ("K = " + "[" * 2000 + "]" * 2000, ["nested", "at most 16 deep"]),
    ("K = " + "[" * 100_000, ["nested", "at most 16 deep"]),
    ("K = " + "{a=" * 60 + "1" + "}" * 60, ["nested", "at most 16 deep"]),
    ("K = " + "[" * 12 + "1" + "]" * 12, ["material.K"]),
    ("a" + ".a" * 100_000 + " = 1", ["a key of at most 16 parts"]),
    ("[" + ".".join("a" * 100_000) + "]", ["a key of at most 16 parts"]),
    ('"' + "k" * 100_000 + '" = 1', ["unknown key"]),
    ("K = 1e9\nx = '" + "a" * 2_000_000 + "'", ["at most 512 KiB"]),
    ("K = [" + "1," * 200_000 + "]", ["at most 25000 values"]),
    ("K = [" + "1," * 24_900 + "]", ["material.K", "single number"]),
    ("[[levels]]\nl = 1\nh = 1\n" * 20_000, ["at most 25000 values"]),
    ("[[levels]]\nl = 1\nh = 1\n" * 12_400, ["levels", "at most 100"]),
    ("K = 1e9\n" + "".join(f"a{i} = 1\n" for i in range(30_000)), ["at most 25000 values"]),
    ('K = "' + '\\"' * 260_000, ["not valid TOML"]),
    ('K = """' + '\\"""' * 130_000, ["not valid TOML"]),
    ("K = '''" + "''" * 260_000, ["not valid TOML"]),
]


@pytest.mark.parametrize(("line", "said"), SCENES, ids=[line[:16] for line, _ in SCENES])
def test_scene(line, said):
    with refused(*said):
        parse_scene(ONE_LEVEL + line if line.startswith("[[levels") else ONE_LEVEL.replace("K = 1e9", line))


def test_what_is_harmless_stays_allowed():
    text = ONE_LEVEL.replace(
        "pressure = 100", f'title = "{"." * 150}"\ndescription = """{"[" * 3000} "." {"." * 3000}"""\npressure = 100'
    )
    assert parse_scene(text).title == "." * 150
    assert parse_scene(ONE_LEVEL.replace("K = 1e9", "K = '1 N/(m)**2/m' # [[[[[[[[[[[[[[[[[[[[[[[ . . .")).material.K == 1.0


def test_many_quantities_with_units_are_read_in_no_time():
    with within_a_second():
        assert parse_scene(ONE_LEVEL.replace("5e-3", "[" + "'1 mm/s', " * 20_000 + "]")).velocity.size == 20_000


OVER = [
    ("material.K=" + "[" * 2000 + "]" * 2000, ["material.K"]),
    ("material.K=" + "[" * 20 + "]" * 20, ["material.K"]),
    ("material.K='1" + " " * 100_000 + "x'", ["material.K", "at most 100 characters"]),
    (f"material.K={DIGITS}", ["material.K"]),
    (f"material.K=0x{DIGITS}", ["material.K"]),
    ("a." * 100_000 + "K=1", ["over"]),
    (f"levels[{DIGITS}].h=1", ["over"]),
    ("material.K=" + "a" + ".a" * 100_000, ["material.K"]),
]


@pytest.mark.parametrize(("text", "said"), OVER, ids=[text[:20] for text, _ in OVER])
def test_over(text, said, tmp_path):
    with refused(*said):
        hystrip.sweep("paper_fig7", over=over_of([text]), out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_more_combinations_than_any_integer_of_the_machine(tmp_path):
    over = {key: np.linspace(1, 2, 100_000) for key in ("pressure", "velocity", "material.K", "adhesion.gamma")}
    over |= {"adhesion.delta_0": np.linspace(1, 2, 2**16)}
    with refused("1e+08 points"):
        hystrip.sweep("paper_fig7", over=over, out=tmp_path / "out")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize(
    "read",
    [
        load_scene,
        lambda path: hystrip.sweep(path),
        read_dma,
        scans,
        hystrip.load_solver,
    ],
    ids=["load_scene", "sweep", "read_dma", "read_surface", "load_solver"],
)
def test_a_pipe_in_place_of_a_file(read, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with refused("pipe"):
        read(tmp_path / "pipe")


@pytest.mark.parametrize("given", [None, 3, b"bytes", "a\0b", "", ["x"]], ids=repr)
@pytest.mark.parametrize(
    ("read", "field"),
    [
        (load_scene, ""),
        (hystrip.sweep, ""),
        (lambda path: hystrip.sweep("paper_fig7", out=path), "out"),
        (hystrip.load_solver, "solver"),
        (read_dma, "path"),
        pytest.param(*scans.values, "path", marks=scans.marks),
    ],
    ids=["load_scene", "sweep", "out", "load_solver", "read_dma", "read_surface"],
)
def test_what_is_no_path(read, field, given, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with refused(field):
        read(given)
    assert not list(tmp_path.iterdir())


class Lying(list):
    """An empty list that says it has two entries."""

    def __len__(self):
        return 2


SLS = dict(K=1e9, T_eps=1e-2, T_sigma=1e-4)
DMA = dict(omega=[1.0, 10.0, 100.0], storage=[1e6, 2e6, 3e6], loss=[1e5, 2e5, 1e5])
CALLS = [
    ("workers", lambda: hystrip.sweep("paper_fig7", workers=1_000_000), "workers"),
    ("workers of many digits", lambda: hystrip.sweep("paper_fig7", workers=10**5000), "workers"),
    ("empty times", lambda: hystrip.Prony(K=1e9, moduli=[1e9, 1e9], times=[[], 1e-2]), "material.times[0]"),
    ("empty moduli", lambda: hystrip.Prony(K=1e9, moduli=[[], 1e9], times=[1e-3, 1e-2]), "material.moduli[0]"),
    ("endless moduli", lambda: hystrip.Prony(K=1e9, moduli=itertools.count(1), times=[1e-3]), "material.moduli"),
    ("endless times", lambda: hystrip.Prony(K=1e9, moduli=[1.0], times=itertools.repeat(1.0)), "material.times"),
    ("many times", lambda: hystrip.Prony(K=1e9, moduli=np.ones(10**6), times=np.ones(10**6)), "material.moduli"),
    ("endless levels", lambda: surface(levels=itertools.repeat(hystrip.Level(1e-6, 1e-7))), "levels"),
    ("endless velocity", lambda: surface(velocity=itertools.count()), "velocity"),
    ("endless K", lambda: hystrip.StandardLinearSolid(**(SLS | {"K": itertools.count(1)})), "material.K"),
    ("loss that says it has entries", lambda: DynamicModulus(**(DMA | {"loss": Lying()})), "dma"),
    ("K of many digits", lambda: hystrip.StandardLinearSolid(**(SLS | {"K": 10**5000})), "material.K"),
    ("a range without end", lambda: hystrip.StandardLinearSolid(**(SLS | {"K": range(10**12)})), "material.K"),
    ("nested K", lambda: hystrip.StandardLinearSolid(**(SLS | {"K": nested(5000)})), "material.K"),
    ("arrays with units", lambda: surface(velocity=[pint.Quantity(np.ones(2), "mm/s")] * 2), "velocity"),
    ("a shift that is not made", lambda: hystrip.StandardLinearSolid(**SLS, shift=hystrip.WLF), "material.shift"),
    ("where WLF ends", lambda: hystrip.WLF(C_1=8.86, C_2=101.6, T_ref=293.15).factor(191.55), "temperature"),
    ("moduli beyond numbers", lambda: hystrip.Arrhenius(E_a=1e5, T_ref=300.0, vertical=10).modulus_factor(1e38), "temperature"),
    ("progress", lambda: surface(progress=1), "progress"),
    ("skip", lambda: surface(skip="no"), "skip"),
    ("no point", lambda: surface(velocity=[1.0, 2.0]).contact_map(""), "at"),
    ("an empty point", lambda: surface(velocity=[1.0, 2.0]).contact_map(()), "at"),
    ("over with a number", lambda: hystrip.sweep("paper_fig7", over={1: [1]}), "over"),
    ("over as a list", lambda: hystrip.sweep("paper_fig7", over=[1]), "over"),
    ("over as a text", lambda: hystrip.sweep("paper_fig7", over="velocity=1"), "over"),
    ("over endless", lambda: hystrip.sweep("paper_fig7", over={"velocity": itertools.count()}), "velocity"),
    ("no data to fit", lambda: fit_prony(None), "data"),
    ("tiny storage", lambda: DynamicModulus(**(DMA | {"storage": [1e-39, 1e-39, 1e-39]})), "dma.storage"),
    ("tiny loss", lambda: DynamicModulus(**(DMA | {"loss": [1e-39, 1e-39, 1e-39]})), "dma.loss"),
    ("tinier loss", lambda: DynamicModulus(**(DMA | {"loss": [1e-300, 0, 5e-324]})), "dma.loss"),
    ("endless times to fit", lambda: fit_prony(DynamicModulus(**DMA), times=itertools.count(1)), "times"),
]  # fmt: skip


def surface(**changed):
    given = {"levels": [hystrip.Level(1e-6, 1e-7)], "pressure": 1.0, "velocity": 1.0, **changed}
    return hystrip.solve(hystrip.StandardLinearSolid(**SLS), hystrip.Dugdale(gamma=0), given.pop("levels"), **given)


def nested(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


def test_integers_of_more_than_64_bits_are_numbers():
    many = hystrip.StandardLinearSolid(K=[10**20, 1], T_eps=10**30, T_sigma=0)
    assert many.K.tolist() == [1e20, 1.0] and many.T_eps == 1e30


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("call", "field"), [each[1:] for each in CALLS], ids=[each[0] for each in CALLS])
def test_call(call, field, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with refused(field):
        call()
    assert not list(tmp_path.iterdir())


def test_command_line(tmp_path):
    """All at once: an option of 5,000 digits, a pipe, and text that no terminal should get."""
    os.mkfifo(tmp_path / "pipe")
    for arguments in (["sweep", "paper_fig7", "--batch", DIGITS], ["solve", "pipe"], ["regenerate", "pipe", "--out", "x"]):
        command = [sys.executable, "-m", "hystrip", *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
        assert done.returncode == 2 and "Traceback" not in done.stderr and done.stdout == "", done.stderr
