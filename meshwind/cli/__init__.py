"""The command line: one file a subcommand, each only calls the library."""

from meshwind.cli.main import main

__all__ = ["main"]
