"""Mutations of the derivation, one by one: which step refuses each.

    python tools/mutants_derivation.py [--only TEXT] [--jobs 1]

Each mutant is a copy of the derivation in which one piece of one file reads differently: a sign, a factor, an index, an inequality, a
closure, a display, a tag, a printed equation, a template, a bound. The derivation of the copy is run as far as it gets (or, for templates
and certificates, every function that is emitted is measured against the true derivation) and must fail, in the step that is named here. A mutant that
comes through is reported, and the command fails. About twelve minutes of CPU time; tests/test_mutants.py runs a few of them.
"""

from __future__ import annotations

import argparse
import importlib
import multiprocessing
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "derivation"


@dataclass(frozen=True)
class Mutant:
    """One change. ``by``: what must refuse it, the name of a step, or of a gate of the texts or of the certificates."""

    subject: str
    file: str
    before: str
    after: str
    by: str
    run: str = "derive"


m = Mutant
EITHER_WAY = (
    ("regimes.py", 'edges.all_along(adhesion, ">=", sp.Integer(0))', 'edges.all_along(adhesion, "<=", sp.Integer(0))'),
    ("regimes.py", 'edges.all_along(adhesion, "<=", delta_0)', 'edges.all_along(adhesion, ">=", delta_0)'),
    ("regimes.py", 'relation(">=", D, threshold)', 'relation("<=", D, threshold)'),
    ("regimes.py", 'relation("<=", delta_0 - edges.step, 0)', 'relation(">=", delta_0 - edges.step, 0)'),
)
"""Inequalities that are the same on any foundation: file, before, after."""

MUTANTS: tuple[Mutant, ...] = (
    # operators of the material
    m("operator", "models.py", "T_sigma / K)", "-T_sigma / K)", "admissibility"),
    m("operator", "models.py", "Q=(sp.Integer(1), T_eps)", "Q=(sp.Integer(1), T_sigma)", "model"),
    m("operator", "models.py", "Q=(sp.Integer(1), T_eps)", 'Q=(sp.Integer(1), T_eps * sp.Symbol("x"))', "model"),
    m("operator", "models.py", "viscosity=T_eps", "viscosity=2 * T_eps", "Prony series", "series"),
    m("operator", "strip.py", "(-V) ** n", "V ** n", "moving frame"),
    m("operator", "strip.py", "sp.cancel((q * (k * V) ** n)", "sp.cancel((q * (-k * V) ** n)", "dimensionless groups"),
    m(
        "operator",
        "model.py",
        "compliance = sp.limit(1 / model.transfer(), rate, sp.oo)",
        "compliance = sp.limit(1 / model.transfer(), rate, 0)",
        "instantaneous compliance",
    ),
    # flows
    m("flow", "flows.py", "(entry - particular.subs(along, since))", "(entry + particular.subs(along, since))", "contact flow"),
    m("flow", "flows.py", "+ gap_0) - strip.u", "- gap_0) - strip.u", "gap flow"),
    m(
        "stable form",
        "stable.py",
        "PROFILE(s, D) + beta * PROFILE_SLOPE(s)",
        "PROFILE(s, D) - beta * PROFILE_SLOPE(s)",
        "forcing",
    ),
    m("stable form", "stable.py", "rise**2 / 2", "-(rise**2) / 2", "contact_work"),
    m("stable form", "stable.py", "(-sp.atan(beta), arc_half(", "(-sp.atan(beta), -arc_half(", "forcing_arc", "harmonics"),
    m(
        "stable form",
        "events.py",
        "sp.atan(loss_factor / STORAGE(alpha, beta)) / 2",
        "sp.atan(loss_factor / STORAGE(alpha, beta)) / 2 + sp.pi / 2",
        "excess_event",
        "harmonics",
    ),
    # closures and edge conditions
    m("closure", "jumps.py", "step_w = chi * J * step", "step_w = -chi * J * step", "closures"),
    m("closure", "jumps.py", "step_w = chi * J * step", "step_w = (1 - chi) * J * step", "closures"),
    m("closure", "jumps.py", "z = w - J * p", "z = w + J * p", "internal state"),
    m("adhesion", "strip.py", "(-p_0, gap <= delta_0)", "(p_0, gap <= delta_0)", "adhesion law"),
    m("adhesion", "strip.py", "(-p_0, gap <= delta_0)", "(-p_0, gap <= delta_0 / 2)", "adhesion law"),
    # surface
    m("surface", "surface.py", "D_level - h / 2 * (1 - sp.cos(k * y))", "D_level + h / 2 * (1 - sp.cos(k * y))", "strip profile"),
    m("surface", "surface.py", "RIGID = D - 1 + sp.cos(s)", "RIGID = D - 1 - sp.cos(s)", "strip profile"),
    m("surface", "surface.py", "AMPLITUDE = h / 4", "AMPLITUDE = h / 2", "strip profile"),
    m("surface", "surface.py", "HEIGHT = h - h / 4", "HEIGHT = h + h / 4", "strip profile"),
    # boundary equations
    m(
        "boundary equation",
        "sequences.py",
        "zone(ADHESION, d, b, delta_0 - step",
        "zone(ADHESION, d, b, delta_0 + step",
        "regime acaf",
    ),
    m(
        "boundary equation",
        "sequences.py",
        "d + PERIOD, delta_0 + step, delta_0)",
        "d + PERIOD, delta_0, delta_0)",
        "regime acaf",
    ),
    m("boundary equation", "sequences.py", "p_0 - delta_0 / compliance", "p_0 + delta_0 / compliance", "regime afc"),
    m("boundary equation", "regime.py", "weight * term for weight", "-weight * term for weight", "regime acaf"),
    m("boundary equation", "conditions.py", "gap_at(onset - 2 * sp.pi / k", "gap_at(onset + 2 * sp.pi / k", "strip problem"),
    # inequalities
    m("inequality", "regime.py", "harmonic + p_0 if self.kind", "harmonic - p_0 if self.kind", "regime acaf"),
    m("inequality", "regime.py", "else self.load - harmonic", "else self.load + harmonic", "regime acaf"),
    *(
        m("inequality", *change, "inequalities of admissibility", "inequalities")
        for change in (
            *EITHER_WAY,
            (
                "sequences.py",
                '(">=", "rises") if self.rises else ("<=", "falls")',
                '("<=", "rises") if self.rises else (">=", "falls")',
            ),
            ("sequences.py", "return self.kind == ADHESION and self.exit != NOTHING", "return self.kind == ADHESION"),
            ("regimes.py", 'relation("<=", *edges, edges[0] + PERIOD)', 'relation(">=", *edges, edges[0] + PERIOD)'),
            ("regime.py", 'relation("<" if sign == ">=" else ">", zone.drive(s), limit)', 'relation(">", zone.drive(s), limit)'),
            ("regime.py", 'relation("<" if sign == ">=" else ">", zone.drive(s), limit)', 'relation("<", zone.drive(s), limit)'),
            ("regimes.py", 'relation(">=", crest, 0), sentence', 'relation("<=", crest, 0), sentence'),
            ("regimes.py", 'relation("<=", valley, delta_0)', 'relation(">=", valley, delta_0)'),
            ("regimes.py", 'relation(">=", crest, delta_0), relation', 'relation("<=", crest, delta_0), relation'),
        )
    ),
    # means, energy, stability
    m("mean", "averages.py", "as_derived(work, zones)),", "-as_derived(work, zones)),", "means_acaf"),
    m("mean", "averages.py", "-sum(rises[zone]", "sum(rises[zone]", "means_acaf"),
    m("mean", "averages.py", "-stable.PROFILE_RISE(begun", "stable.PROFILE_RISE(begun", "means_acaf"),
    m("mean", "averages.py", "alpha), raised, plain)", "alpha), plain, raised)", "certificate of means_acaf", "certificates"),
    m("mean", "averages.py", "alpha), raised, plain)", "alpha), plain, plain)", "certificate of means_acaf", "certificates"),
    m("energy", "energy.py", "sp.diff(w, s) - beta / L", "sp.diff(w, s) + beta / L", "power balance"),
    m("stability", "stability.py", "(load_0 + gap_0 - p) * decay", "(load_0 - gap_0 - p) * decay", "shift of an event"),
    m("stability", "stability.py", "(release / (1 + beta) - released)", "(release / (1 + beta) + released)", "onset_slope_acaf"),
    m("stability", "stability.py", "spare - 2 * sp.sin(half)", "spare + 2 * sp.sin(half)", "onset_slope_acaf"),
    m("stability", "onset_map.py", "(1 + M_step / M)\n", "(1 - M_step / M)\n", "slope of the onset map"),
    m("stability", "onset_map.py", "before[-1] - left_over", "before[-1] + left_over", "slope of the onset map"),
    m("stability", "onset_map.py", "ended = -M / at_a", "ended = M / at_a", "growth of the slope"),
    m("stability", "balance.py", "(p_0 - jump) * c - (1 - J)", "(p_0 - jump) * c + (1 - J)", "standing still"),
    # complete contact, levels
    m("complete contact", "saturated.py", "sp.I**n for n, q", "(-sp.I) ** n for n, q", "complex modulus"),
    m("complete contact", "saturated.py", "least = D - 1 - R", "least = D - 1 + R", "saturation threshold", "displays"),
    m("level", "level.py", "(2 * ratio - 1) - p_0", "(2 * ratio - 1) + p_0", "level_saturation_pressure"),
    m(
        "level",
        "level.py",
        "corrected = sp.Rational(3, 16) * sp.pi**2 * K * h**2",
        "corrected = sp.Rational(3, 16) * sp.pi**2 * K * h",
        "stack friction",
    ),
    m("level", "level.py", "value = K * D_level**2 / (2 * sp.pi * h)", "value = K * D_level**2 / (sp.pi * h)", "crests at rest"),
    m("level", "level.py", "3 * sp.pi / 32 * K * h**2", "sp.pi / 2 * K * h**2", "level_saturation_friction"),
    m(
        "level",
        "multilevel.py",
        "(D_level - HEIGHT).subs(x, fixed - V * t)",
        "(D_level - HEIGHT).subs(x, fixed + V * t)",
        "local stress",
    ),
    m(
        "level",
        "multilevel.py",
        "shear = pressure * slope_x + tau_below",
        "shear = pressure * slope_x - tau_below",
        "local shear",
    ),
    m(
        "level",
        "multilevel.py",
        "HEIGHT, x) + friction_of_one.subs(lower)",
        "HEIGHT, x) - friction_of_one.subs(lower)",
        "friction coefficient",
    ),
    m("level", "multilevel.py", "sum(loads) + p_0", "sum(loads) - p_0", "equilibrium"),
    m("level", "multilevel.py", "(2 * width * length(place) for place", "(width * length(place) for place", "contact area"),
    m("level", "multilevel.py", "(mean, number) - over_strips", "(mean, number) + over_strips", "means over a level", "complete"),
    m("level", "level.py", "D - threshold.subs", "D + threshold.subs", "least pressure in complete contact"),
    # the paper as printed
    *(
        m("print", "paper/printed.toml", before, after, f"print of Eq. {number}", "print")
        for number, before, after in (
            (4, r"h_i - \frac{h_i}{4}\left(\cos", r"h_i + \frac{h_i}{4}\left(\cos"),
            (5, r"w_i - V T_\epsilon", r"w_i + V T_\epsilon"),
            (6, r"&= f_i(x,y) + D_i", r"&= D_i - f_i(x,y)"),
            (6, r"p_i(x,y) &= -p_0", r"p_i(x,y) &= p_0"),
            (9, r"A_i = 2\Delta", r"A_i = \Delta"),
            (11, r"\bar{p}_i = \frac{2\Delta}{l_i^2}", r"\bar{p}_i = \frac{\Delta}{l_i^2}"),
            (15, r"+ 2\pi l_i V (T_\varepsilon - T_\sigma)\sin", r"- 2\pi l_i V (T_\varepsilon - T_\sigma)\sin"),
            (16, r"\frac{h_i}{4\pi^2 V^2", r"\frac{h_i^3}{4\pi^2 V^2"),
            (7, r"\frac{1}{l_i^2} \iint", r"\frac{2}{l_i^2} \iint"),
            (12, r"+ \bar{\tau}_M[p_{M-1}(x, y_j)]'", r"- \bar{\tau}_M[p_{M-1}(x, y_j)]'"),
        )
    ),
    m(
        "print",
        "paper/level.py",
        "height = (AMPLITUDE * derived_w)",
        "height = -(AMPLITUDE * derived_w)",
        "print of Eq. 6",
        "print",
    ),
    # displays
    m(
        "display",
        "saturated.py",
        r"p_{sat} = D - 1 + \frac{(1 + \alpha\beta)\cos s - ",
        r"p_{sat} = D - 1 + \frac{(1 + \alpha\beta)\cos s + ",
        "saturated_pressure",
        "displays",
    ),
    m("display", "level.py", r"\sum_i \frac{h_i^2}{l_i}", r"\sum_i \frac{h_i^3}{l_i}", "stack friction", "displays"),
    m("display", "level.py", r"\sum_i \frac{h_i^2}{l_i^2", r"\sum_i \frac{h_i^3}{l_i^2", "Eq. 16 as printed", "displays"),
    m(
        "display",
        "level.py",
        r"p_{sat} = \tfrac14 K h (2R - 1) - p_0",
        r"p_{sat} = \tfrac14 K h (2R - 1) + p_0",
        "level_saturation_pressure",
        "displays",
    ),
    m(
        "display",
        "level.py",
        r"\tau_{sat} = \frac{3\pi}{32} \frac",
        r"\tau_{sat} = \frac{3\pi}{16} \frac",
        "level_saturation_friction",
        "displays",
    ),
    m("display", "zones.py", r"u(s) = D - 1 + \cos s", r"u(s) = D - 1 - \cos s", "profile", "displays"),
    m("display", "flows.py", r"w(s) = p + (w_0 - p)", r"w(s) = p - (w_0 - p)", "relaxation flow", "displays"),
    m(
        "display",
        "multilevel.py",
        r"_{M-1} = \frac{1}{l^2} \iint p\,f_x\,dx\,dy + ",
        r"_{M-1} = \frac{1}{l^2} \iint p\,f_x\,dx\,dy - ",
        "carried friction",
        "levels",
    ),
    m("display", "multilevel.py", r"\int_{-kb}^{ka}", r"\int_{-ka}^{kb}", "carried friction", "levels"),
    m(
        "display",
        "multilevel.py",
        r".. math:: \tau_{M-1}(x, y) = p\,f_x +",
        r".. math:: \tau_{M-1}(x, y) = p\,f_x -",
        "local shear",
        "levels",
    ),
    m("display", "multilevel.py", r"\bar p = \frac{1}{l^2} \iint", r"\bar p = \frac{1}{l} \iint", "equilibrium", "levels"),
    m("display", "multilevel.py", r"A = 2 \Delta \sum", r"A = \Delta \sum", "contact area", "levels"),
    m("display", "multilevel.py", r"\bar p = \frac1l \int", r"\bar p = l \int", "means over a level", "complete"),
    m("display", "multilevel.py", r"(x, y) = p(x, y)\,\frac", r"(x, y) = -p(x, y)\,\frac", "local stress", "complete"),
    m(
        "display",
        "multilevel.py",
        r".. math:: \mu = \frac{\tau_1}{p_1}",
        r".. math:: \mu = \tau_1\,p_1",
        "friction coefficient",
        "complete",
    ),
    # several relaxation times: law, jumps, zones, inequalities, displays, chain rule
    m("modes", "modes/material.py", "VISCOSITY = K_i * tau_i / K", "VISCOSITY = K_i * tau_i", "foundation law", "modes"),
    m("modes", "modes/flows.py", "unknown + alpha * sp.diff", "unknown - alpha * sp.diff", "contact flow", "modes"),
    m("modes", "modes/states.py", "LEAVE = J_j * beta_j /", "LEAVE = J_j * beta_k /", "states", "modes"),
    m("modes", "modes/chain.py", "drive, forget = c_2 + c_1 -", "drive, forget = c_2 + c_1 +", "period map", "modes"),
    m("modes", "modes/stable.py", "-lost, -J * p * lost)", "-lost, J * p * lost)", "relaxation_map", "modes"),
    m("modes", "modes/chain.py", "m_1, m_2 = dc_1 - dR_1 * z", "m_1, m_2 = dc_1 + dR_1 * z", "chain rule", "modes"),
    m("modes", "modes/chain.py", "(r * dz + dq + dr * z)", "(r * dz + dq - dr * z)", "chain rule", "modes"),
    m("modes", "modes/stable.py", "creep - S * f_0 * decay_loss(", "creep + S * f_0 * decay_loss(", "contact_increment", "modes"),
    m(
        "modes",
        "modes/stable.py",
        "PROFILE_SLOPE(s_1) - total(transient +",
        "PROFILE_SLOPE(s_1) + total(transient +",
        "contact_passage",
        "modes",
    ),
    m(
        "modes",
        "modes/stable.py",
        "-total(rates) - PROFILE_SLOPE(s_1)",
        "-total(rates) + PROFILE_SLOPE(s_1)",
        "relaxation_passage",
        "modes",
    ),
    m("modes", "modes/stable.py", "-back(enter, lost)", "back(enter, lost)", "contact_passage", "modes"),
    m("modes", "sequences.py", "d + PERIOD, delta_0 + step, delta_0)", "d + PERIOD, delta_0, delta_0)", "regime acaf", "modes"),
    m("modes", "sequences.py", "p_0 - delta_0 / compliance", "p_0 + delta_0 / compliance", "regime afc", "modes"),
    m("modes", "modes/saturated.py", "harmonic - eq_15", "harmonic + eq_15", "saturated_overstress", "modes"),
    m("modes", "modes/flows.py", "u - alpha / eta * harmonic", "u + alpha / eta * harmonic", "carried friction", "modes"),
    m(
        "modes",
        "multilevel.py",
        "+ friction_of_one.subs(lower)",
        "- friction_of_one.subs(lower)",
        "friction coefficient",
        "modes",
    ),
    m(
        "modes",
        "conditions.py",
        "gap = AMPLITUDE * displacement - (",
        "gap = AMPLITUDE * displacement + (",
        "zone conditions",
        "modes",
    ),
    m("modes", "averages.py", "J_j * load - z_j", "J_j * load + z_j", "means of a strip", "modes"),
    m("modes", "averages.py", "z_j + J_j * p_0}", "z_j - J_j * p_0}", "means of a strip", "modes"),
    m("display", "modes/flows.py", r"z_j(s) = J_j p + (", r"z_j(s) = J_j p - (", "relaxation flow", "modes"),
    m("display", "modes/zones.py", r"f = -N (z - J p),", r"f = N (z - J p),", "overstress", "modes"),
    m("display", "modes/zones.py", r"\eta_i \Delta e_i = \int", r"\Delta e_i = \int", "contact_increment", "modes"),
    m("display", "modes/states.py", r"\quad J_j \beta_j =", r"\quad J_j =", "partial fractions", "modes"),
    m(
        "display",
        "level.py",
        r"\frac{3\pi}{32} \frac{h^2}{l}",
        r"\frac{3\pi}{32} \frac{h^3}{l}",
        "level_saturation_friction",
        "modes",
    ),
    m("tag", "modes/zones.py", "contact_work, Eq. 11: ", "contact_work, Eq. 10: ", "tags", "modes"),
    *(
        m("inequality", *change, "inequalities of admissibility", "modes")
        for change in (
            *EITHER_WAY,
            ("sequences.py", '("<=", "falls")', '(">=", "falls")'),
            ("sequences.py", '(">=", "rises")', '("<=", "rises")'),
            ("modes/regimes.py", "relation(sign, gap_at(s), limit)", "relation(sign, limit, gap_at(s))"),
        )
    ),
    # tags and status
    m("tag", "multilevel.py", '"Eq. 12: ', '"Eq. 13: ', "tags", "tags"),
    m("tag", "multilevel.py", '"Eq. 9: ', '"Eq. 7: ', "tags", "tags"),
    m("status", "level.py", "term, checks, correction=CORRECTIONS[16],", "term, checks,", "stack friction"),
    # templates and certificates
    m(
        "template",
        "templates/stable.py.jinja",
        "half = np.sin(",
        "half = np.cos(",
        "certificate of profile, profile_integral, forcing, ",
        "certificates",
    ),
    m(
        "template",
        "templates/parts.py.jinja",
        "return {{ formula.result | results }}",
        "return -np.asarray(({{ formula.result | results }}))",
        "certificate of profile, profile_slope, profile_rise, ",
        "certificates",
    ),
    m(
        "certificate",
        "stable.py",
        "-2 * sp.sin(middle) * sp.sin(half), HALVES",
        "sp.cos(s_1) - sp.cos(s_0), HALVES",
        "certificate of profile_rise, gap_after, ",
        "certificates",
    ),
)


def copied(mutant: Mutant, folder: Path) -> ModuleType:
    """Import a copy of the derivation with the mutation, in the first place where what it changes stands."""
    name = f"mutated_{folder.name}"
    shutil.copytree(SOURCES, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    path = folder / name / mutant.file
    text = path.read_text(encoding="utf-8")
    if mutant.before not in text:
        raise LookupError(f"{mutant.before!r} is not in {mutant.file}")
    path.write_text(text.replace(mutant.before, mutant.after, 1), encoding="utf-8")
    sys.path.insert(0, str(folder))
    return importlib.import_module(name)


def part(package: ModuleType, name: str) -> ModuleType:
    return importlib.import_module(f"{package.__name__}.{name}")


def refused_by(mutant: Mutant) -> str:
    """The step or gate that refuses a mutant; "" if it comes through."""
    with tempfile.TemporaryDirectory() as folder:
        package: ModuleType | None = None
        try:
            package = copied(mutant, Path(folder))
            return RUNS[mutant.run](package) or ""
        except Exception as refusal:
            step = getattr(refusal, "step", None)
            if step is None:
                raise
            return str(step)
        finally:
            sys.path.remove(folder) if folder in sys.path else None


def whole(package: ModuleType) -> None:
    package.derive(package.STANDARD_LINEAR_SOLID)


def early(package: ModuleType) -> tuple[Any, Any, Any]:
    """(strip, flows, complete contact) of a copy."""
    ground = part(package, "model").foundation(package.STANDARD_LINEAR_SOLID)
    strip = part(package, "strip").strip(ground)
    flows = part(package, "flows").flows(strip)
    return strip, flows, part(package, "saturated").saturated(flows)


def series(package: ModuleType) -> None:
    """A model that states its operators and its series."""
    part(package, "modes.material").prony_series(package.KELVIN_VOIGT)


def harmonics(package: ModuleType) -> None:
    """What finds the events of a zone by one harmonic."""
    _, flows, _ = early(package)
    part(package, "zones").load(flows)
    part(package, "events").excess_event(flows)


def inequalities(package: ModuleType) -> None:
    """The table of regimes at its sample roots; what proves its equations is left out, they are not changed."""
    *_, full = early(package)
    passed = part(package, "check").holds("left out", True)
    for module in ("regime", "sequences"):
        part(package, module).zero = lambda *arguments, **options: passed
    ratio = part(package, "symbols").chi * part(package, "symbols").J
    table = part(package, "regimes").regimes(part(package, "regime").OneTime(ratio), full.threshold.value)
    part(package, "sample_roots").sample_roots("one_time", table, part(package, "modes.flows").mode_flows())


def printed(package: ModuleType) -> None:
    strip, _, full = early(package)
    multilevel, level = part(package, "multilevel"), part(package, "level")
    whole_level, _ = level.level(full.threshold.value)
    exact = {kernel.formula.name: kernel.exact for kernel in (*full.kernels, *whole_level)}
    steps = (
        part(package, "conditions").zone_conditions(strip.u),
        multilevel.local_stress(),
        multilevel.local_shear(),
        level.printed_equation_16(exact["level_saturation_friction"]),
    )
    part(package, "paper.compare").comparisons(strip, exact, {step.name: step.value for step in steps})


def displayed(package: ModuleType) -> None:
    strip, flows, full = early(package)
    whole_level, stacked = part(package, "level").level(full.threshold.value)
    printed = part(package, "level").printed_equation_16(whole_level[2].exact)
    kernels = (*part(package, "zones").rigid_profile(strip.u), *full.kernels, *whole_level)
    steps = [flows.contact, flows.relaxation, flows.gap, *(kernel.derived for kernel in kernels), stacked, printed]
    field = next(kernel.exact for kernel in full.kernels if kernel.formula.name == "saturated_pressure")
    displays, words = part(package, "displays"), part(package, "vocabulary")
    displays.displays(steps, {}, words.vocabulary(flows, field), words.BINDINGS, displays.of_one_time)


def levels(package: ModuleType) -> None:
    """Displays of Eq. 7 and 9 to 14, which are the same on every foundation."""
    multilevel, displays = part(package, "multilevel"), part(package, "displays")
    passed = (part(package, "check").holds("left out", True),)
    steps = (
        multilevel.equilibrium(()),
        multilevel.contact_area(()),
        multilevel.local_shear(),
        multilevel.carried_friction((), passed, ()),
    )
    displays.displays(steps, {}, {}, part(package, "vocabulary").LEVELS, displays.of_one_time)


def complete(package: ModuleType) -> None:
    """Displays of Eq. 10, 11 and 14, whose steps are checked in complete contact."""
    multilevel, displays = part(package, "multilevel"), part(package, "displays")
    steps = (
        multilevel.local_stress(),
        multilevel.means_over_a_level(),
        multilevel.friction_coefficient(),
    )
    displays.displays(steps, {}, {}, part(package, "vocabulary").LEVELS, displays.of_one_time)


def modes(package: ModuleType) -> None:
    package.derive(package.GENERALISED)


def tags(package: ModuleType) -> None:
    multilevel = part(package, "multilevel")
    steps = (multilevel.local_stress(), multilevel.local_shear())
    part(package, "paper.record").require_tags((*steps, multilevel.contact_area(())))


def certificates(package: ModuleType) -> str:
    """What is emitted by the copy, measured against the true derivation: all functions that it gets wrong."""
    from hystrip.derivation import STANDARD_LINEAR_SOLID, derive, stored_bounds

    made = package.derive(package.STANDARD_LINEAR_SOLID)
    with part(package, "folder").importable(part(package, "emit").emit((made,))) as imported:
        name = made.model.name
        return beyond_bounds(derive(STANDARD_LINEAR_SOLID).kernels, imported(name), stored_bounds()[name])


def beyond_bounds(kernels: Iterable[Any], solver: Any, bounds: dict[str, float]) -> str:
    """Name the functions of ``solver`` that err by more than their bounds; "" if none does."""
    from hystrip.derivation.certificates import measure

    worst = {kernel.formula.name: measure(kernel, solver, points=60).worst for kernel in kernels}
    beyond = [name for name, error in worst.items() if not error <= bounds[name]]
    return f"certificate of {', '.join(beyond)}" if beyond else ""


RUNS: dict[str, Callable[[ModuleType], str | None]] = {
    "derive": whole,
    "series": series,
    "harmonics": harmonics,
    "inequalities": inequalities,
    "print": printed,
    "displays": displayed,
    "levels": levels,
    "complete": complete,
    "modes": modes,
    "tags": tags,
    "certificates": certificates,
}


def outcome(mutant: Mutant) -> tuple[Mutant, str, float]:
    begun = time.process_time()
    try:
        found = refused_by(mutant)
    except Exception as problem:  # a mutant that only crashes is not refused by a step
        found = f"({type(problem).__name__}: {problem})"
    return mutant, found, time.process_time() - begun


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="mutants whose subject, file or step holds this text")
    parser.add_argument("--jobs", type=int, default=1)
    chosen = parser.parse_args()
    wanted = [each for each in MUTANTS if any(chosen.only in text for text in (each.subject, each.file, each.by, each.run))]
    survived = 0
    import hystrip.derivation  # noqa: F401  loaded once; every mutant runs in a fork of this process

    with multiprocessing.get_context("fork").Pool(chosen.jobs, maxtasksperchild=1) as pool:
        for number, (mutant, found, seconds) in enumerate(pool.imap(outcome, wanted), 1):
            refused = found.startswith(mutant.by)
            survived += not refused
            verdict = f"refused by '{found}'" if refused else f"SURVIVES: {found or 'nothing refuses it'} (should: '{mutant.by}')"
            print(
                f"{number:2} {mutant.subject:18} {mutant.file:34} {mutant.after[:46]!r:50} {verdict}  {seconds:.0f} s", flush=True
            )
    print(f"{len(wanted)} mutants, {survived} survive")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
