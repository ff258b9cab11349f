"""The version of meshwind that is running."""

from importlib import metadata


def version() -> str:
    """Installed version, or "source" for a source tree that was not installed."""
    try:
        return metadata.version("meshwind")
    except metadata.PackageNotFoundError:
        return "source"
