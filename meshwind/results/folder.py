"""The output folder: files appear in it whole and together, or not at all, and results are replaced only on demand."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.results.exports import exports_in
from meshwind.results.staging import staged

RESULTS = frozenset(
    ("paths.vtp", "bridges.vtp", "crossings.vtp", "quads.vtu", "quads.obj", "surface.vtu", "surface.npz")
    + ("chart.png", "report.json", "winding.png", "fit_error.png", "revolutions.png", "sheet.png", "crossings.png")
    + ("coverage.png", "windability.png", "slip.png", "fit.png", "unrolled.png", "quads.png", "redesign.png")
    + ("winding.gif", "winding.mp4", "viewer.html", "edited.ply", "edited.vtu", "before.png", "after.png")
    + ("meshwind.toml",)
)
"""All that a run, or what is made of it, may leave in its folder."""


class _TrialError(Exception):
    """Ends a trial before anything has been written."""


def prepare(out: Path, overwrite: bool = False) -> None:
    """Make sure that files can be written into `out`, and leave nothing behind; first finish what a killed run left.

    Raises BadInputError where a file is in the way, where the place cannot be written or where, without `overwrite`,
    it holds results.
    """
    try:
        with writing(out, overwrite):
            raise _TrialError
    except _TrialError:
        pass


@contextmanager
def writing(out: Path, overwrite: bool = False) -> Iterator[Path]:
    """Give a folder to write a run's files into; on leaving they move to `out`, on an error they vanish.

    With `overwrite` all results of an earlier run in `out` and exports of them are removed, also those that this one
    does not have, as they would belong to another report; all else is left alone.  On an error nothing is left, not
    even `out` itself where it was missing, and killed on the way the next run into `out` finishes the move or clears
    away.  Raises BadInputError where `out` cannot be written or, without `overwrite`, holds results.
    """
    if out.exists() and not out.is_dir():
        raise BadInputError(f"{out} is a file; give a folder for the results")
    with staged(out, lambda _: map(Path, held)) as staging:
        held = _held(out, overwrite)
        yield staging
        held = _held(out, overwrite)


def _held(out: Path, overwrite: bool) -> list[str]:
    """Names of the results in `out`; raises BadInputError where there are some that must not be replaced."""
    held = sorted(name for name in RESULTS if (out / name).is_file()) + exports_in(out)
    if held and not overwrite:
        what = ", ".join(held[:2]) + ", ..." * (len(held) > 2)
        raise BadInputError(
            f"{out} holds results already ({what}); give another folder, or --overwrite to replace them"
        )
    return held
