"""Sentences of README and the site with figures, and the results or the test that each rests on."""

from collections.abc import Callable, Sequence
from math import log
from typing import NamedTuple

from documentation.kept import Kept
from documentation.words import figure, share, span

SMOOTH = ("ours_waist", "ours_conjugate", "ours_friction", "ours_noise", "ours_units", "ours_stretch", "time_step")
"""Maps of ours on smooth ground."""
OURS = ("", "meshwind")
"""What maps with and without a column of methods call ours."""
SILENT = ("wrong", "understated")
"""Answers that look right and are not, or not as nearly as they say."""
AT_REST = ("ok", "vague", "warned", *SILENT)
"""Answers of paths at rest."""


def always(kept: Kept) -> bool:
    """What rests on its figures alone."""
    del kept
    return True


class Claim(NamedTuple):
    """A sentence with {} for its figures; what these are, as they are written; and what must hold besides."""

    text: str
    figures: Callable[[Kept], Sequence[str]]
    holds: Callable[[Kept], bool] = always


def count(kept: Kept, table: str, **where: object) -> str:
    """Number of lines."""
    return str(len(kept.rows(table, **where)))


def cells(kept: Kept, **where: object) -> str:
    """Number of cells of maps."""
    return str(sum(int(row["cells"]) for row in kept.rows("outcomes", **where)))


def order_of_fits(kept: Kept) -> list[str]:
    """Order of convergence from the coarsest meshes to the finest, and the errors of both."""
    first, last = (kept.rows("fit_order", asked=each) for each in (1000, 64_000))
    orders = [
        2.0 * log(coarse("error") / fine("error")) / log(fine("vertices") / coarse("vertices"))
        for coarse, fine in zip(first, last, strict=True)
    ]
    return [span(orders), *(span([row("error") for row in some]) for some in (first, last))]


def source_setting(kept: Kept) -> list[str]:
    """A thousand steps against ours."""
    row = kept.row("source_setting")
    return [figure(row("their_ms")), row["equal_particles"], figure(row("equal_ratio")), figure(row("ratio"))]


def velocity_scaling(kept: Kept) -> list[str]:
    """Its least error on each problem."""
    least: dict[str, float] = {}
    for row in kept.rows("velocity_scaling"):
        least[row["problem"]] = min(row("error"), least.get(row["problem"], row("error")))
    return [span(list(least.values()), 1)]


def explicit_limits(kept: Kept) -> list[str]:
    """Largest difference of a measured limit from theory."""
    return [share(max(abs(row("ratio") - 1.0) for row in kept.rows("explicit_limits")))]


def ribs(kept: Kept) -> list[str]:
    """Cells of ours that are right, all, those that state much, and backward Euler's that are right, and all."""
    ours, theirs = (dict(method=name) for name in ("meshwind", "backward-euler"))
    return [
        count(kept, "rough_ribs", **ours, result=("ok", "vague")),
        count(kept, "rough_ribs", **ours),
        count(kept, "rough_ribs", **ours, result="vague"),
        count(kept, "rough_ribs", **theirs, result="ok"),
        count(kept, "rough_ribs", **theirs),
    ]


def rough_meshes(kept: Kept) -> list[str]:
    """Noise, share of faces, cells that are right, all, and the largest error over what is stated."""
    rows = kept.rows("rough_meshes")
    return [share(max(row("noise") for row in rows)), share(min(row("kept") for row in rows)),
            count(kept, "rough_meshes", result="ok"), str(len(rows)),
            share(max(row("share") for row in rows if row["share"]))]  # fmt: skip


def folds(kept: Kept) -> list[str]:
    """All cells, those that are right, and those that lie deeper than they state."""
    return [count(kept, "rough_folds", **which) for which in ({}, {"result": "ok"}, {"result": "wrong"})]


def rewound(kept: Kept) -> list[str]:
    """Passes that lie well, all, how far off these are on tank and vase at most, and the others."""
    rows = kept.rows("rewound_parts")
    good, passes = (sum(int(row[of]) for row in rows if row[of]) for of in ("good", "passes"))
    far = (max(row("distance") for row in kept.rows("rewound_parts", part=part)) for part in ("tank.ply", "vase.stl"))
    return [str(good), str(passes), *(figure(each, 1) for each in far), str(passes - good)]


def windings(kept: Kept) -> list[str]:
    """Layers at most, how far lengths on them are off, turnarounds that are right, and shifts that are."""
    layers = [row for row in kept.rows("rough_layers") if row["error"]]
    turns = kept.rows("turnarounds")
    errors = [row(of) for row in turns for of in ("legs", "turns", "overrun") if row[of]]
    return [
        figure(max(row("layers") for row in layers), 1),
        figure(100.0 * max(row("error") / row("added") for row in layers)),
        figure(max(errors), 1),
        count(kept, "turnarounds", result="ok"),
        str(len(turns)),
        count(kept, "rewound_tube", result="ok"),
        count(kept, "rewound_tube"),
    ]


def rests(kept: Kept) -> list[str]:
    """Cells with friction that are right, all at rest, those that were warned of, and those that were not."""
    both = ("rough_rest_states", "rough_bumps")

    def of(*results: str) -> str:
        return str(sum(len(kept.rows(name, method="meshwind", result=results)) for name in both))

    return [of("ok"), of(*AT_REST), of("warned"), of(*SILENT)]


def facets(kept: Kept) -> list[str]:
    """Seconds of fits that the facets lead."""
    return [figure(kept.row("fit_facets", asked=asked)("fit")) for asked in (1000, 8000, 60_000)]


def flipout(kept: Kept) -> list[str]:
    """Ours with many and with few particles, and FlipOut."""
    many, few = (
        kept.row("against_flipout", particles=401, length="polyline"),
        kept.row("against_flipout", particles=51, length="fibre"),
    )
    theirs = kept.row("against_flipout", method="FlipOut")
    return [
        figure(many("milliseconds")), figure(many("quicker")), figure(many("largest error"), 1),
        figure(few("milliseconds")), figure(few("quicker")), figure(few("largest error"), 1),
        figure(theirs("median error"), 1), figure(theirs("set-up"), 1), figure(few("set-up"), 1),
    ]  # fmt: skip


def against_before(kept: Kept) -> list[str]:
    """Ours over the release before: time of runs, memory and time of many paths, and how often these were run."""

    def ratio(job: str, of: str) -> str:
        return figure(kept.row("first_run_medians", job=job, who="meshwind")(f"{of} ratio"))

    return [
        *(ratio(job, "seconds") for job in ("first run", "second run", "without pictures", "many faces")),
        *(ratio(f"many paths{end}", of) for end in ("", " without pictures") for of in ("memory", "seconds")),
        kept.row("first_run_medians", job="many paths", who="meshwind")["runs"],
    ]


def growth(kept: Kept, *what: tuple[str, str]) -> list[str]:
    """Powers with which a cost grows."""
    return [figure(kept.row("scaling_growth", over=over, of=of)("power")) for over, of in what]


def to_surface(kept: Kept) -> list[str]:
    """Growth from reading to the surface, memory of a face, and memory of many paths without pictures."""
    last = max(kept.rows("scaling", swept="faces"), key=lambda row: row("faces"))
    stages = ("reading to surface", "reading to surface, from 100k on")
    return [
        *growth(kept, *(("faces", stage) for stage in stages)), figure(last("memory") / last("faces") / 1e3),
        figure(kept.row("scaling", swept="paths without pictures")("memory") / 1e9),
    ]  # fmt: skip


def rough_surfaces(kept: Kept) -> list[str]:
    """Least share of the places within what is stated, on all surfaces but the worst; their number; on the worst."""
    within = sorted(row("within") for row in kept.rows("rough_mesh_to_surface"))
    return [share(within[1]), str(len(within)), share(within[0])]


CLAIMS = (
    Claim(
        "its error falls with order {} of the spacing, from {} at 1,000 vertices to {} at 64,000",
        order_of_fits,
    ),
    Claim(
        "{} % or more of the places are within what the surface states, but on one in {}, where {} % are.",
        rough_surfaces,
    ),
    Claim(
        "public libraries on {} problems with known answers",
        lambda kept: [str(len({row["problem"] for row in kept.rows("ratios")}))],
    ),
    Claim(
        "take {} ms for 401 particles over the neck of a bottle; meshwind is as accurate with {} particles, {} times "
        "quicker, and {} times with as many.",
        source_setting,
    ),
    Claim("velocity scaling (4.19) is off by {} with the best number of particles.", velocity_scaling),
    Claim(
        "meshwind gave no wrong answer that looked like a right one, in {} cells:",
        lambda kept: [cells(kept, chart=SMOOTH, method=OURS)],
        lambda kept: cells(kept, chart=SMOOTH, method=OURS, result=SILENT) == "0",
    ),
    Claim(
        "The measured limits of the explicit schemes agree with theory, 2 / omega for symplectic Euler, to {} %;",
        explicit_limits,
    ),
    Claim(
        "the penalty force is right in {} of {} cells, an island of its two parameters;",
        lambda kept: [cells(kept, chart="penalty", result="ok"), cells(kept, chart="penalty")],
    ),
    Claim(
        "with friction (4.19) is wrong without notice in {} of {} cells, where anything slides.",
        lambda kept: [
            str(
                sum(
                    int(row["cells"])
                    for row in kept.rows("outcomes", chart="ours_friction", result=result)
                    if row["method"] not in OURS
                )
            )
            for result in ("wrong", AT_REST)
        ],
    ),
    Claim(
        "meshwind is right within what it states in {} of {} cells, from 26 particles on; in {} of them it states an "
        "error as large as the rib. Backward Euler is right in {} of {}.",
        ribs,
    ),
    Claim(
        "Lengths from meshes with up to {} % noise of which down to {} % of the faces are kept are right in {} of {} "
        "cells, off by at most {} % of what surface and solver state.",
        rough_meshes,
    ),
    Claim(
        "Of {} cells with collars that lean over, {} are right, and in {} a path lies deeper inside than it states.",
        folds,
    ),
    Claim(
        "{} of {} cells at rest have the place and the length of a path with very many particles within what is "
        "stated, {} lie elsewhere, by no more than `paths.other_rests` states, and {} are wrong without a warning.",
        rests,
    ),
    Claim(
        "On up to {} layers of a tube and a barrel lengths are off by at most {} % of what the layers below add, as the"
        " bands' own pattern is in them. Turnarounds on collars of a tube have the lengths, the overrun and the slip of"
        " their closed forms within {} in {} of {} cells. A program whose mandrel is off is found to shift the fibre by"
        " what is exact, and to lay it well only where that is small, in {} of {} cells.",
        windings,
    ),
    Claim(
        "{} of {} passes come to lie well, within {} of the diagonal on tank and {} on vase; the others, {} on wing and"
        " elbow, are told.",
        rewound,
        lambda kept: (
            {row["part"] for row in kept.rows("rewound_parts") if row["result"] != "ok"} <= {"wing.stl", "elbow.obj"}
        ),
    ),
    Claim(
        "the fit takes more: {} s for a mesh of 1,000 faces, {} s for 8,000, {} s for 60,000.",
        facets,
    ),
    Claim(
        "a path of 401 particles takes {} ms on one thread, {} times less than FlipOut on the same mesh, and its "
        "polyline is off by {} in length; one of 51 takes {} ms, {} times less, and the length of its fibre is off by "
        "{}. FlipOut's is off by {}, after a set-up of {} s against {} s here",
        flipout,
    ),
    Claim(
        "medians of {} runs, by turns",
        lambda kept: [kept.row("first_run_medians", job="first run", who="meshwind")["runs"]],
    ),
    Claim(
        "a first run takes {} of the time, a second one {}, one without pictures {}; a mesh of 1M faces, without "
        "pictures, takes {} of the time, and 10,000 paths take {} of the memory and {} of the time, without pictures "
        "{} and {}; these large ones are medians of {} runs.",
        against_before,
    ),
    Claim(
        "and frames while the part is turned; the best of {} runs, each in a browser of its own",
        lambda kept: [kept.rows("viewer_speed")[0]["runs"]],
        lambda kept: all(row("bytes") < 4e6 and row("first picture") < 3.0 for row in kept.rows("viewer_speed")),
    ),
    Claim(
        "Time grows with the power {} of the faces, {} of the paths and {} of the particles,",
        lambda kept: growth(kept, *((over, "time") for over in ("faces", "paths", "particles"))),
    ),
    Claim(
        "time grows with the power {} from 10k to 2M faces and with {} from 100k on, and 2M faces take {} KB of memory "
        "each. Without pictures 10,000 paths take {} GB.",
        to_surface,
    ),
)
"""In the order of the pages."""

TESTED = {
    "below 1e-5 with 401 particles up to about one turn, and 1.5e-4 at four": (
        "test_documentation.py::test_lengths_are_those_of_chords"
    ),
    "51 particles per path give what 1,601 chords do": "test_length.py::test_fourth_order",
    "polylines on analytic cones, barrels, ellipsoid": "test_path.py::test_length_is_exact",
    "second order in the particles": "test_path.py::test_length_converges_with_second_order",
    "fibre lengths there, and on a freeform bottle": "test_length.py::test_fourth_order",
    "the lengths of fibres are right to 2e-9": "test_length.py::test_fourth_order",
    "Clairaut's constant along a barrel's path, 1601 particles | below 1e-6": (
        "test_path.py::test_clairaut_constant_holds_along_the_path"
    ),
    "ends of the vase's bridges, between particles": "test_path.py::test_bridge_ends_converge_with_second_order",
    "fibres that slide to catenaries on a cylinder": "test_friction.py::test_a_sliding_fibre_becomes_a_catenary",
    "fibre that sticks in part": "test_friction.py::test_stick_and_slip_meet_where_they_should",
    "required friction where a fibre slips, over the coefficient": (
        "test_friction.py::test_the_slip_of_the_certificate_keeps_the_law"
    ),
    "surface fitted to 4,000 irregular vertices of a vase": (
        "test_surface_fit.py::test_vertices_carry_the_surface_far_below_the_facets"
    ),
    "lengths on a barrel and a cone from a mesh file of 4,000 irregular vertices": (
        "test_surface_fit.py::test_lengths_from_a_mesh_are_exact"
    ),
    "at least ten times closer to the true ones than exact polyhedral geodesics": (
        "test_accuracy_from_meshes.py::test_ten_times_closer_than_the_facets_geodesics"
    ),
    "none counts as bridged, and the whole surface as convex": (
        "test_resolved_bridges.py::test_nothing_bridges_on_a_convex_vessel"
    ),
    "which leaves the convex share within 2.5 %": "test_resolved_bridges.py::test_hollows_are_those_of_the_part",
    "every bridge of the part with a gap of six times": "test_resolved_bridges.py::test_bridges_are_those_of_the_part",
    "a part that presses everywhere never pays for lifting": (
        "test_path.py::test_convex_parts_pay_nothing_for_lifting"
    ),
    "fibres on the parts of `data/` then rest within 1e-3": "test_friction_slide.py::test_parts_have_one_answer",
    "Each file is read back from its text by an interpreter of its own": (
        "test_program_posts.py::test_every_program_is_read_back_as_it_was_meant"
    ),
}
"""Sentences and cells of tables, by some of their words, and the test that holds their bounds."""
