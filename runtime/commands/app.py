"""The Typer application: its commands, one module each."""

import typer

from . import audit, check, figures, fit, init, levels, master, regenerate, schema, show, solve, sweep


def build() -> typer.Typer:
    """The application with all its commands."""
    app = typer.Typer(
        help="Hysteretic sliding friction of multiscale wavy surfaces on a viscoelastic foundation with adhesion.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_options)
    for module in (solve, sweep, show, figures, init, master, fit, levels, schema, regenerate, check, audit):
        app.command(name=module.__name__.rsplit(".", 1)[1])(module.command)
    return app


def _version(wanted: bool) -> None:
    if wanted:
        from .._version import __version__

        typer.echo(f"hystrip {__version__}")
        raise typer.Exit()


def _options(
    version: bool = typer.Option(False, "--version", help="Show the version and exit.", is_eager=True, callback=_version),
) -> None:
    pass
