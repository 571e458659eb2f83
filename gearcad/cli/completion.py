"""What a shell needs to complete commands, options and names of files: completion."""

from __future__ import annotations

import click

from gearcad.cli.group import debug_option

__all__ = ["completion"]

VARIABLE = "_GEARCAD_COMPLETE"
"""Of the environment: by it a shell asks for what fits."""


@click.command(short_help="Print what lets a shell complete commands.")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
@debug_option
def completion(ctx: click.Context, shell: str) -> None:
    """Print what lets SHELL complete commands, options and names of files. One line where the shell begins turns it on:

    \b
      ~/.bashrc                      source <(gearcad completion bash)
      ~/.zshrc                       source <(gearcad completion zsh)
      ~/.config/fish/config.fish     gearcad completion fish | source
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None  # all choices have one
    click.echo(kind(ctx.find_root().command, {}, "gearcad", VARIABLE).source())
