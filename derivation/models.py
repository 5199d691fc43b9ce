"""Where models come from: those that ship, constructors of others, and a user's file."""

import os
import runpy
from collections.abc import Iterable, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from hystrip.errors import InputError
from hystrip.files import path_of
from hystrip.inputs.checks import sequence
from hystrip.inputs.prony import MOST_TIMES

from .arguments import A_NAME, A_TEXT, coefficients, is_name, is_text, is_variable, require_words
from .check import DerivationError
from .model import Model, Parameter, Roots, Series
from .modes.material import VISCOSITY, K_i, tau_i
from .printing import FUNCTIONS, source
from .symbols import K, T_eps, T_sigma, rate

STEP = "model"
TAKEN = ("stable", "modes", "audit", "certificates", "index", "measured")  # files beside the emitted solvers and their pages
CALLED = ("np", "positive", "nonnegative", "finite", "of_operators")  # by the emitted function that takes the parameters
STORED = ("model", "solver", "shift", "fit")  # beside the parameters of a material in a file
STIFFNESS = Parameter(K, "K", "Pa/m", "relaxed stiffness of the foundation per area")
RETARDATION = Parameter(T_eps, "T_eps", "s", "retardation time: creep under constant pressure")


def prony_model(name: str, modes: int | None = None, title: str = "") -> Model:
    """A spring beside ``modes`` Maxwell branches, or any number: ``p = K w + sum_i K_i (w - e_i)``, ``tau_i e_i' + e_i = w``.

    The solver is given the Prony series as arrays K_i and tau_i. Raises :class:`hystrip.InputError` for an argument that cannot
    be used.
    """
    require_words(name, title)
    if modes is not None and (not isinstance(modes, int) or isinstance(modes, bool) or not 1 <= modes <= MOST_TIMES):
        raise InputError("modes", modes, f"an integer, at least 1 and at most {MOST_TIMES}, or None for any number")
    return Model(
        name=name,
        title=title or f"Generalised model with {modes or 'n'} relaxation times",
        parameters=(
            STIFFNESS,
            Parameter(K_i, "K_i", "Pa/m", "branch moduli, one per relaxation time"),
            Parameter(tau_i, "tau_i", "s", "relaxation times, one per branch"),
        ),
        Q=(),
        P=(),
        series=Series(K, viscosity=VISCOSITY, time=tau_i, arrays=(K_i, tau_i)),
        count=modes,
    )


def operator_model(
    name: str, parameters: Sequence[Parameter], Q: Sequence[sp.Expr], P: Sequence[sp.Expr], title: str = ""
) -> Model:
    """A model given by its operators, ``Q(d/dt) w = P(d/dt) p``: their coefficients of the powers 0, 1, ..., n of d/dt.

    A parameter is named like its symbol: ``Parameter(sp.Symbol("T", positive=True), "T", "s", "retardation time")``. The times of
    the model are found by the solver once the parameters are numbers; numbers that make no passive, stable solid are refused
    there. Raises :class:`DerivationError` for operators that do not belong together, or that the solver could not compute, and
    :class:`hystrip.InputError` for an argument of another kind.
    """
    require_words(name, title)
    parameters = sequence("parameters", parameters, "a sequence of hystrip.derivation.Parameter")
    Q, P = coefficients("Q", Q), coefficients("P", P)
    if len(Q) != len(P) or len(Q) < 2:
        raise DerivationError(
            name, f"Q and P have coefficients of the same powers 0 .. n, n >= 1; these have {len(Q)} and {len(P)}"
        )
    require_parameters(name, parameters)
    known = {parameter.symbol for parameter in parameters} | {rate}  # d/dt itself: refused with its reason when derived
    linear = [coefficient for coefficient in (*Q, *P) if not coefficient.atoms(AppliedUndef)]  # and so are the others
    unknown = sorted({str(symbol) for coefficient in linear for symbol in coefficient.free_symbols - known})
    if unknown:
        raise DerivationError(name, f"every symbol of the operators is among the parameters; {', '.join(unknown)} is not")
    beyond = sorted({str(f.func) for each in linear for f in each.atoms(sp.Function) if f.func not in FUNCTIONS})
    if beyond:
        usable = ", ".join(function.__name__ for function in FUNCTIONS)
        raise DerivationError(name, f"the operators hold powers and {usable} alone; {', '.join(beyond)} is not among them")
    return Model(name, title or name, tuple(parameters), Q, P, series=Roots(sp.cancel(Q[0] / P[0])))


STANDARD_LINEAR_SOLID = Model(
    name="standard_linear_solid",
    title="Standard linear solid",
    parameters=(
        STIFFNESS,
        RETARDATION,
        Parameter(T_sigma, "T_sigma", "s", "relaxation time: pressure under constant displacement; at most T_eps"),
    ),
    Q=(sp.Integer(1), T_eps),
    P=(1 / K, T_sigma / K),
    differences=((T_eps, T_sigma + sp.Symbol("T_delta", nonnegative=True)),),
)
"""The paper's foundation, Eq. 1: one relaxation time, ``w + T_eps w_t = (p + T_sigma p_t)/K``."""

KELVIN_VOIGT = Model(
    name="kelvin_voigt",
    title="Kelvin-Voigt solid",
    parameters=(STIFFNESS, RETARDATION),
    Q=(sp.Integer(1), T_eps),
    P=(1 / K, sp.Integer(0)),
    series=Series(K, viscosity=T_eps, time=sp.Integer(0)),
)
"""A spring and a dashpot side by side, ``p = K (w + T_eps w_t)``; no instantaneous compliance."""

GENERALISED = prony_model("generalised")
MODELS = (STANDARD_LINEAR_SOLID, KELVIN_VOIGT, GENERALISED)
"""Those that ship."""


def load_model(path: str | os.PathLike[str]) -> tuple[Model, ...]:
    """The models that a file declares, as ``MODEL`` or ``MODELS``. The file is run: it is code of whoever names it.

    Raises :class:`FileNotFoundError`, :class:`DerivationError` for a file that does not run or declares no model that can be
    emitted, and :class:`hystrip.InputError` for what is no path.
    """
    file = path_of(path, "path", "a model file")
    if not file.is_file():
        raise FileNotFoundError(f"no model file {file}")
    try:
        found = runpy.run_path(str(file))
    except DerivationError:
        raise
    except Exception as problem:
        raise DerivationError(STEP, f"{file} runs ({type(problem).__name__}: {problem})") from problem
    declared = [found[name] for name in ("MODEL", "MODELS") if found.get(name) is not None]
    if declared[1:] == [MODELS]:  # imported with everything else
        del declared[1]
    if len(declared) != 1:
        wanted = "declares MODEL, or MODELS, such as MODEL = prony_model('my_rubber', modes=5)"
        raise DerivationError(STEP, f"{file} {wanted}{', not both' if declared else ''}")
    models = tuple(declared[0]) if isinstance(declared[0], (tuple, list)) else (declared[0],)
    require_names(models)
    return models


def require_names(models: Iterable[object]) -> None:
    """Raise :class:`DerivationError` unless every model can be the name of a module, and no two are the same."""
    seen: set[str] = set()
    for model in models:
        if not isinstance(model, Model):
            raise DerivationError(STEP, f"a model is a hystrip.derivation.Model, not {type(model).__name__}")
        name = model.name
        if not is_name(name):
            raise DerivationError(STEP, f"the name of a model is {A_NAME}, not {name!r}")
        if not is_text(model.title):
            raise DerivationError(name, f"the title of a model is {A_TEXT}, not {model.title!r}")
        for field in ("parameters", "Q", "P"):
            if not isinstance(getattr(model, field), (tuple, list)):
                raise DerivationError(name, f"{field} of a model is a tuple, not {getattr(model, field)!r}")
        for coefficient in (*model.Q, *model.P):
            if not isinstance(coefficient, (int, float, sp.Expr)):
                raise DerivationError(name, f"a coefficient of Q or P is a number or a SymPy expression, not {coefficient!r}")
        if name in TAKEN or name in seen:
            raise DerivationError(STEP, f"the name {name!r} is free: {', '.join((*TAKEN, *sorted(seen)))} are taken")
        seen.add(name)
        require_parameters(name, model.parameters)


def require_parameters(model: str, parameters: Iterable[object]) -> None:
    """Raise :class:`DerivationError` unless a function can take the parameters, under the names that their symbols have in it."""
    seen: set[str] = set()
    for parameter in parameters:
        if not (isinstance(parameter, Parameter) and isinstance(parameter.symbol, sp.Symbol)):
            raise DerivationError(model, f"a parameter is a hystrip.derivation.Parameter of a SymPy symbol, not {parameter!r}")
        if not (is_text(parameter.unit) and is_text(parameter.meaning)):
            raise DerivationError(model, f"unit and meaning of a parameter are {A_TEXT}, not those of {parameter!r}")
        name, printed = parameter.name, source(parameter.symbol)
        taken = (*CALLED, *STORED, *sorted(seen))
        if name != printed or not is_variable(name) or name in taken:
            claim = f"a parameter is named like its symbol, and that is a Python name that is free: {', '.join(taken)} are taken"
            raise DerivationError(model, f"{claim}; {name!r} of the symbol {printed} is not such")
        seen.add(name)
