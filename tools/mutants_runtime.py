"""Mutations of the runtime, one by one: which come through the tests that are to stop them.

    python tools/mutants_runtime.py [--only TEXT]

Each mutant is a copy of the library in which one line reads differently: a tolerance, a threshold, a bound, an error that is not
counted. The named tests run on the copy, and one of them has to fail, or take longer than a healthy run may. A mutant that comes
through is reported, and the command fails. Some minutes of CPU time.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: seconds after which tests count as failed: a healthy run takes a tenth of it
_PATIENCE = 400


@dataclass(frozen=True)
class Mutant:
    """One change of a file of ``runtime/``, and the tests that are to stop it."""

    what: str
    file: str
    before: str
    after: str
    tests: str


MUTANTS = (
    Mutant("slow strips are taken to be at rest", "orbit/at_rest.py", "SLOW = 3e-13,", "SLOW = 1e-3,", "test_at_rest.py"),
    Mutant(
        "strips at rest snap at the wrong end",
        "orbit/at_rest.py",
        "np.where(steps, d, b)",
        "np.where(steps, b, b)",
        "test_at_rest.py",
    ),
    Mutant(
        "a contact without length is one",
        "orbit/modes/engine.py",
        "np.abs(edges[:, k].sum(axis=0)) < np.pi",
        "np.abs(edges[:, k].sum(axis=0)) < 9",
        "test_at_rest.py",
    ),
    Mutant(
        "a march that begins in contact has none",
        "orbit/modes/extremal.py",
        "once & (np.isnan(near.edges[1]) == np.isnan(near.edges[2]))",
        "once",
        "test_modes_next_to_saturation.py",
    ),
    Mutant(
        "what rounding hides next to complete contact is refused",
        "orbit/modes/engine.py",
        "<= 64 * ROUNDING * (1 + np.abs(s.D)",
        "<= 0 * ROUNDING * (1 + np.abs(s.D)",
        "test_modes_next_to_saturation.py",
    ),
    Mutant(
        "flat levels rub like those above",
        "flat_levels.py",
        "np.where(kept[:, None], v[above], 0.0)",
        "np.where(True, v[above], 0.0)",
        "test_flat_levels.py",
    ),
    Mutant(
        "flat levels are pulled off like those below",
        "flat_levels.py",
        "points.pulled_off = p <",
        "points.pulled_off |= p <",
        "test_flat_levels.py",
    ),
    Mutant(
        "stability of an orbit to a tenth", "orbit/certificate.py", "STABLE = 1e-6", "STABLE = 1e-1", "test_injected_orbit.py"
    ),
    Mutant(
        "all saturated at 0.9 of the lift", "multilevel.py", "out[0].p + s.lift", "out[0].p + 0.9 * s.lift", "test_skipping.py"
    ),
    Mutant(
        "what is carried at another pressure is exact",
        "multilevel.py",
        "error += np.minimum(grown.sum(axis=1), 1.0)",
        "error += 0 * np.minimum(grown.sum(axis=1), 1.0)",
        "test_error_budget.py",
    ),
    Mutant(
        "a slope from a step within the errors",
        "level/inverse.py",
        "known = np.abs(steps[:, :1]) > unknown[:, :1]",
        "known = np.abs(steps[:, :1]) > errors[:, :1]",
        "test_error_estimate.py",
    ),
    Mutant(
        "a pressure that is not told from a turn is looked for there",
        "level/inverse.py",
        "stay = (within != step) & ",
        "stay = (within == np.inf) & ",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "a slope next to a turn from beyond it",
        "level/walk.py",
        "np.clip(0.5 * min(t - part.t_low, part.t_high - t), *_STEPS)",
        "_STEPS[1]",
        "test_pull_off.py",
    ),
    Mutant(
        "a curve is not looked at up to its breaks",
        "level/look.py",
        "slopes = np.diff(p) / step[:, 1:-1]",
        "slopes = 0 * step[:, 1:-1]",
        "test_look.py",
    ),
    Mutant(
        "when loading, nothing happens where gaps open",
        "level/breaks.py",
        "c[OPENS] = columns.opens if columns.stretch > 0 else np.nan",
        "c[OPENS] = c[OPENS]",
        "test_pull_off.py",
    ),
    Mutant(
        "what clings before loading begins is followed",
        "level/curve.py",
        "- rises <= high.min(axis=1, keepdims=True)",
        "<= np.inf",
        "test_look.py",
    ),
    Mutant(
        "panels are halved, whatever has a kink in them",
        "level/averages.py",
        "0.5 * (panels.low + panels.high), kinks)",
        "0.5 * (panels.low + panels.high), np.nan)",
        "test_bounded_work.py",
    ),
    Mutant(
        "pressure right after entry is that at entry",
        "level/lower_levels.py",
        "contact.entered(_MEMORIES * memory[index])",
        "contact.entered(0 * memory[index])",
        "test_lower_levels.py",
    ),
    Mutant(
        "averages pass by strips whose contact all but closes",
        "level/regime_map.py",
        'if boundary.event != "peak"):',
        'if boundary.event == "fold"):',
        "test_next_to_jumps.py",
    ),
    Mutant(
        "next to a jump nothing is known of its other side",
        "level/walk.py",
        "self.other = self._apart(row, least, most, exhausted)",
        "self.other = 1e-3 * self._apart(row, least, most, exhausted)",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "islands do not move",
        "level/breaks.py",
        "moved = drift[:, None]",
        "moved = 0 * drift[:, None]",
        "test_law_digits.py",
    ),
    Mutant(
        "loading may end below the pressure",
        "level/walk.py",
        "if self.unloading or not self.waiting else",
        "if self.unloading else",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "a look below serves what is far above it",
        "level/averages.py",
        "if (V, k) not in seen}",
        "if not seen}",
        "test_shared_looks.py",
    ),
    Mutant(
        "velocities share where their curves have breaks",
        "level/inverse.py",
        "[(columns.V[walk.column], *walk.waiting[-1])",
        "[(0.0, *walk.waiting[-1])",
        "test_shared_looks.py",
    ),
    Mutant(
        "velocities share pieces of their curves",
        "level/inverse.py",
        "(columns.V[walk.column], walk.goal,",
        "(0.0, walk.goal,",
        "test_shared_looks.py",
    ),
    Mutant(
        "velocities share looks below",
        "level/averages.py",
        "looks |= {(V, (k",
        "looks |= {(0.0, (k",
        "test_shared_looks.py",
    ),
    Mutant(
        "a look is as rough as the greatest pressure allows",
        "level/inverse.py",
        "rtol * size[same]).min()",
        "rtol * size[same]).max()",
        "test_shared_looks.py",
    ),
    Mutant(
        "what is hidden is told as the greatest pressure allows",
        "level/inverse.py",
        "_CLOSEST * size[same].min()",
        "_CLOSEST * size[same].max()",
        "test_shared_looks.py",
    ),
    Mutant(
        "a coarse curve tells the side of a jump",
        "level/inverse.py",
        "in zip(same.tolist(), _CLOSEST * size[same], strict=True)",
        "in zip(same.tolist(), rtol * size[same], strict=True)",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "branches that overlap by less than they are known to are one",
        "level/walk.py",
        "return (k, k, k) if whole else",
        "return (k, k, k) if inside and all(a.inner_high and b.inner_low for a, b in joints) else",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "a later part of the way hides nothing, however rough",
        "level/walk.py",
        "least < most or bool(self._near(row, k, self._coarser(row)))",
        "least < most",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "below all branches but the last one is known exactly",
        "level/walk.py",
        "slice(max(k, 0) // 2)",
        "slice(k // 2)",
        "test_next_to_jumps.py",
    ),
    Mutant(
        "what is narrower than pressures are known is looked into",
        "level/curve.py",
        "np.where(parts.inner_high, 0.0, atol[parts.column] / K)",
        "0.0",
        "test_bounded_work.py",
    ),
    Mutant(
        "equal strips look at neither crest nor valley",
        "level/averages.py",
        "np.diff(around, axis=1)",
        "np.diff(values, axis=1)",
        "test_bounded_work.py",
    ),
    Mutant(
        "a misplaced jump costs nothing",
        "level/lower_levels.py",
        "return jumps[group[row], j] * np.minimum",
        "return 0 * jumps[group[row], j] * np.minimum",
        "test_lower_levels.py",
    ),
    Mutant(
        "a break is known as well as the segment at the far end of the interval",
        "level/law.py",
        "(self._ends[end, self._between[end][group, at]]",
        "(self._ends[end, self._between[1 - end][group, at]]",
        "test_error_budget.py",
    ),
    Mutant(
        "a law that is but cut ends at saturation",
        "level/law.py",
        "np.where(p_max < np.inf, np.inf, saturated.p), strict=True)",
        "saturated.p, strict=True)",
        "test_lower_levels.py",
    ),
    Mutant(
        "errors of a law cancel where all pressures are alike",
        "level/lower_levels.py",
        "np.maximum(_ALIKE / np.maximum(span, _ALIKE), _CANCELLED)",
        "_CANCELLED + 0 * span",
        "test_lower_levels.py",
    ),
    Mutant(
        "a jump is not misplaced where contact passes it at its exit only",
        "level/lower_levels.py",
        "np.minimum(contact.p_entry, contact.p_exit)[row]",
        "contact.p_entry[row]",
        "test_lower_levels.py",
    ),
    Mutant(
        "what is not known of a law's pressure costs nothing",
        "level/law.py",
        "np.minimum(slope * pressure",
        "0 * np.minimum(slope * pressure",
        "test_lower_levels.py",
    ),
    Mutant(
        "a turn that no node met is where its interpolant turns",
        "level/walk.py",
        "self.known[part.piece] * (self.known[part.piece] > self.finest)",
        "0.0",
        "test_pull_off.py",
    ),
    Mutant(
        "errors do not leave open what unloading comes to",
        "level/look.py",
        "(known + error)[here, ::-1]",
        "known[here, ::-1]",
        "test_look.py",
    ),
    Mutant(
        "all of a curve is interpolated, whatever unloading comes to",
        "level/interpolation.py",
        "meets.any(axis=1) & rises & ~stage.parts.rough",
        "~stage.parts.rough",
        "test_bounded_work.py",
    ),
    Mutant(
        "the curve below the crest's release is interpolated like the rest",
        "level/curve.py",
        "(intervals.high <= crest[intervals.column])",
        "(intervals.high < -np.inf)",
        "test_bounded_work.py",
    ),
    Mutant(
        "a curve ends at a break below which it goes on for a short way",
        "level/look.py",
        "(lowest > ceiling)[:, None]",
        "(lowest > -np.inf)[:, None]",
        "test_look.py",
    ),
    Mutant(
        "a tenth of a law's error in what it carries",
        "level/law.py",
        "return self._cells(u, which), self._errors",
        "return self._cells(u, which), 0.1 * self._errors",
        "test_lower_levels.py",
    ),
    Mutant(
        "a break changes friction by what it does right where it is said to be",
        "level/law.py",
        "zip(sides, (p - reach, p + reach)",
        "zip(sides, (p, p)",
        "test_error_budget.py",
    ),
    Mutant(
        "a tenth of a law's error in its own estimate", "level/law.py", "(_SAFE * error)", "(0.1 * error)", "test_lower_levels.py"
    ),
    Mutant("the tie of a snap is a matter of rounding", "orbit/groups.py", "(1 - ROUNDING)", "(1 + ROUNDING)", "test_limits.py"),
    Mutant(
        "speed is infinite too early", "orbit/single.py", "STANDS_STILL = 1e12", "STANDS_STILL = 1e4", "test_extreme_velocity.py"
    ),
    Mutant(
        "friction at high speed is not scaled back",
        "orbit/abstract_foundation.py",
        "np.where(falls, pace, 1.0)",
        "1.0",
        "test_extreme_velocity.py",
    ),
    Mutant(
        "loading saturates beyond what grows with V",
        "orbit/abstract_foundation.py",
        "np.minimum(self._forced(l, h, V), glassy)",
        "self._forced(l, h, V)",
        "test_extreme_velocity.py",
    ),
    Mutant(
        "bounds on snapped contacts begin without pressure",
        "orbit/orbit_bounds.py",
        "kernel, part, begins, part.q_on",
        "kernel, part, begins, 0.0 * part.q_on",
        "test_proofs.py",
    ),
    Mutant(
        "adhesion that is not let go of is taken to be wider at the crest than it is",
        "orbit/orbit_bounds.py",
        "-part.strips.D - part.strips.p_0",
        "-1.02 * part.strips.D - part.strips.p_0",
        "test_proofs.py",
    ),
    Mutant(
        "islands below a given penetration are not looked for",
        "level/averages.py",
        "for below in _BELOW if columns",
        "for below in () if columns",
        "test_islands.py",
    ),
    Mutant(
        "a dip that a first look passed over is not asked for",
        "level/walk.py",
        "turns >= D)]",
        "turns >= D)][:0]",
        "test_pull_off.py",
    ),
    Mutant(
        "few nodes tell how fractions of the surface end",
        "numerics/quadrature.py",
        " & ((n >= _MANY) | ~layered[:, None])",
        "",
        "test_error_estimate.py",
    ),
    Mutant(
        "a pressure that a penetration takes is taken to be exact",
        "solve.py",
        "np.abs(np.where(loaded, mu, 0.0)) * points.p_error",
        "0.0",
        "test_error_estimate.py",
    ),
    Mutant(
        "a point whose mu may be anything has converged",
        "multilevel.py",
        "& ~points.of_unknown_mu",
        "",
        "test_error_estimate.py",
    ),
    Mutant(
        "contact ends earlier than in the orbit that is always engaged",
        "orbit/engine.py",
        "orbit.a + STABLE",
        "orbit.a - 0.1",
        "test_proofs.py",
    ),
    Mutant(
        "a later onset forgets how early its adhesion may end",
        "orbit/sensitivity.py",
        "M = np.minimum(release_margin(kernel, cycle, left.c), release_margin(kernel, cycle, right.c))",
        "M = release_margin(kernel, cycle, left.c)",
        "test_proofs.py",
    ),
    Mutant(
        "twice as much is excluded",
        "orbit/search.py",
        "near + far > width",
        "2 * (near + far) > width",
        "test_proofs.py test_extremal.py test_reference_strips.py",
    ),
    Mutant(
        "errors of an average are a hundredth",
        "level/averages.py",
        "error = width * (sum_errors(values,",
        "error = 0.01 * width * (sum_errors(values,",
        "test_reference_levels.py",
    ),
    Mutant(
        "contact may begin behind the onset of a strip that snaps into it",
        "orbit/modes/forced.py",
        "together = ~here.s.snaps |",
        "together = True |",
        "test_modes_far_apart.py",
    ),
    Mutant(
        "layers where a contact vanishes are not feared",
        "level/averages.py",
        "_LAYER, _MEMORIES = 0.4, 4.5, 5.0",
        "_LAYER, _MEMORIES = 0.4, 0.0, 5.0",
        "test_error_estimate.py",
    ),
    Mutant(
        "next to saturation the strips left are told by a difference of what is all but equal",
        "level/nonadhesive/average.py",
        "self.low = self.high - self.length",
        "self.length = self.high - np.minimum(np.arcsinh(low), self.high * (1 - EPS)); self.low = self.high - self.length",
        "test_nonadhesive.py",
    ),
    Mutant(
        "work that was cut short is not told",
        "level/strips.py",
        "self.limits.setdefault((v, wavelength), what)",
        "pass",
        "test_bounded_work.py",
    ),
)


def survives(mutant: Mutant) -> bool:
    """Whether all tests of a mutant pass. ``LookupError``: the line that it changes is not there, once."""
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder) / "hystrip"
        shutil.copytree(ROOT / "runtime", package, ignore=shutil.ignore_patterns("__pycache__"))
        for part in ("generated", "derivation"):
            shutil.copytree(ROOT / part, package / part, ignore=shutil.ignore_patterns("__pycache__", "audit"))
        file = package / mutant.file
        text = file.read_text("utf-8")
        if text.count(mutant.before) != 1:
            raise LookupError(f"{mutant.what}: {mutant.file} has {text.count(mutant.before)} times {mutant.before!r}")
        file.write_text(text.replace(mutant.before, mutant.after), "utf-8")
        tests = [str(Path("tests") / name) for name in mutant.tests.split()]
        command = [sys.executable, "-c", _RUN.format(folder=folder), "-x", "-q", "-p", "no:cacheprovider", *tests]
        try:
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=_PATIENCE, env=dict(os.environ))
        except subprocess.TimeoutExpired:
            return False
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{mutant.what}: the tests did not run\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.returncode == 0


#: the copy stands in for an installed library
_RUN = """
import sys
sys.path.insert(0, {folder!r})
import hystrip
assert hystrip.__file__.startswith({folder!r}), hystrip.__file__
import pytest
sys.exit(pytest.main(sys.argv[1:]))
"""


def main(argv: list[str] | None = None) -> int:
    """The command. Returns its exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="TEXT", help="mutants with this in their description or file")
    options = parser.parse_args(argv)
    chosen = [each for each in MUTANTS if options.only in each.what or options.only in each.file]
    survivors = 0
    for each in chosen:
        alive = survives(each)
        survivors += alive
        print(f"{'survives' if alive else 'stopped':9} {each.what} ({each.file}; {each.tests})", flush=True)
    print(f"{survivors} of {len(chosen)} survive")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
