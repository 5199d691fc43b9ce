"""``hystrip schema``: the JSON Schema of scene files."""

import typer


def command() -> None:
    """Print the JSON Schema of scene files.

    Editors that know it complete and check scenes as they are written.
    """
    import json

    from ..scene.schema import json_schema

    typer.echo(json.dumps(json_schema(), indent=2, ensure_ascii=False))
