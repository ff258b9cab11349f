"""The version of meshwind that runs."""

from importlib import metadata


def version() -> str:
    """The installed version, or "source" for a source tree that was not installed."""
    try:
        return metadata.version("meshwind")
    except metadata.PackageNotFoundError:
        return "source"
