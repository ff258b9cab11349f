"""`meshwind program`: from a filament to what a machine runs."""

from typing import Annotated, Any

import typer

from meshwind.appearance.words import duration
from meshwind.cli.arguments import OtherFolder, Printed, ResultsFolder
from meshwind.cli.config import Config
from meshwind.cli.help import some_of, split_names
from meshwind.cli.output import print_report, stages
from meshwind.cli.signature import with_records

EXAMPLES = """
    # for a lathe of four axes, into the run's folder
    meshwind program part-wound

    # for a machine of your own, and as poses for a robot
    meshwind program part-wound --machine mine.toml --to csv,poses

    # a page to go through it block by block, and a movie of the machine
    meshwind program part-wound --to viewer,gif --seconds 15

    # in the words of a controller
    meshwind program part-wound --to linuxcnc
"""
TARGETS = (
    "csv",
    "poses",
    "axes",
    "hits",
    "viewer",
    "gif",
    "mp4",
    "linuxcnc",
    "grbl",
    "marlin",
    "fanuc",
    "siemens",
    "krl",
)
"""Names for help and completion: the module that defines them takes long to import."""
_MACHINE = "Machine and files"
WITH_FAULTS = 3
_MOST = 3
"""Stretches of blocks with a fault of a kind that are printed; program.json has them all."""


def _list_machines(wanted: bool) -> None:
    if wanted:
        from meshwind.program.machine import machine_names, read_machine

        for name in machine_names():
            typer.echo(f"{name:10}{read_machine(name).words}")
        raise typer.Exit


@with_records
def program(  # noqa: PLR0913
    *,
    folder: ResultsFolder,
    machine: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Machine: a name of --machines, or a TOML file of your own.",
            rich_help_panel=_MACHINE,
        ),
    ] = "lathe-4",
    to: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help=f"What is written, separated by commas: {', '.join(TARGETS)}.",
            autocompletion=some_of(*TARGETS),
            rich_help_panel=_MACHINE,
        ),
    ] = "csv,axes,hits",
    tension: Annotated[
        float, typer.Option(help="Tension of the fibre, in N; 0 sets none.", rich_help_panel=_MACHINE)
    ] = 0.0,
    seconds: Annotated[float, typer.Option(help="How long a movie takes.", rich_help_panel=_MACHINE)] = 10.0,
    again: Annotated[
        bool,
        typer.Option(
            "--again/--no-again",
            help="Wind the program again by physics: does the fibre come to lie where it was planned?",
            rich_help_panel=_MACHINE,
        ),
    ] = True,
    machines: Annotated[
        bool,
        typer.Option(
            "--machines",
            callback=_list_machines,
            is_eager=True,
            help="List the machines that are shipped.",
            rich_help_panel=_MACHINE,
        ),
    ] = False,
    out: OtherFolder = None,
    config: Config = None,
    printed: Printed,
) -> int:
    """Write the program of a machine that winds the filament of a run, which was wound with --continuous.

    program.csv: every block with the fibre, the eye, the axes and the time. program.json: the mandrel's axis, the time
    and what is wrong. axes.png (axes): the axes over time, and what limits them. hits.png (hits), where there are
    any: the spans and eyes that meet the part, and where the fibre goes astray. poses.csv (poses): the eye for a
    robot, the mandrel on an external axis, in mm. program.html (viewer): a page to go through it block by block.
    program.gif, program.mp4: the machine at work. program.ngc (linuxcnc), program.gcode (grbl, marlin), program.nc
    (fanuc), program.mpf (siemens), program.src (krl): the program in the words of a controller. Each is read back from
    its text and compared with the program.

    The program is wound again: the fibre is pulled by the moving eye over the part, with friction and bridges, and
    where it comes to lie is compared with where it was planned, pass by pass.  Turnarounds are taken as they are.

    Exit status: 0 done; 1 the summary could not be printed; 2 bad input or usage; 3 written, but with faults: the free
    span or the eye meets the part, an axis cannot go where it must, the fibre does not come to lie within half of its
    band's width of where it was planned, or a text was not read back as it was meant (program.json lists them).
    """
    del machines, config
    from meshwind.program.targets import write_program

    with stages(printed) as progress:
        done = write_program(folder, machine, split_names(to), out, tension, seconds, again, progress)
    lines = [*program_lines(done.figures), *(f"note      {note}" for note in done.notes)]
    lines += [line for name, found in done.figures["texts"].items() for line in text_lines(name, found)]
    lines += [f"file      {file}" for file in done.files]
    print_report(lines, {**done.figures, "notes": list(done.notes), "folder": str(out or folder)}, printed)
    return 0 if done.sound else WITH_FAULTS


def program_lines(figures: dict[str, Any]) -> list[str]:
    """What is printed of a program."""
    unit, span, back = figures["units"], figures["fibre"]["free_length"], figures["turned_back"]
    slowest = max(figures["limits"], key=figures["limits"].__getitem__)
    layers = figures["seconds_of_layers"]
    each = f" (layers {', '.join(duration(seconds) for seconds in layers)})" if len(layers) > 1 else ""
    hollows = 0.0 <= figures["nearest"] < 0.99 * figures["clearance"]
    near = f"; in hollows {figures['nearest']:.2g} {unit}" if hollows else ""
    lines = [
        f"machine   {figures['machine']['name']}: {figures['machine']['words']}",
        f"program   {figures['blocks']} blocks, {figures['turns']:.6g} turns, {duration(figures['seconds'])}{each}; "
        f"fibre {figures['fibre']['laid']:.6g} {unit}, {figures['fibre']['speed']:.3g} {unit}/s; "
        f"mostly limited by {slowest}",
        f"eye       {figures['clearance']:.4g} {unit} clear of the part{near}; free span {span['min']:.4g} to "
        f"{span['max']:.4g} {unit}",
    ]
    if figures["lost"]:
        units = {"cross": "mm", "roll": "degrees", "yaw": "degrees"}
        lost = ", ".join(f"{value:.3g} {units[name]} of {name}" for name, value in figures["lost"].items())
        lines.append(f"lost      up to {lost}, for want of these axes: the eye follows no further, which is no fault")
    if figures["cuts"]:
        many, first = len(figures["cuts"]), figures["cuts"][0]
        lines.append(
            f"cut       {many} time{'s' * (many > 1)}, first after block {first['index']}: the program stops for the "
            "fibre to be cut, goes on clear of the part, and stops for the next filament to be tied on; the time of "
            "that is not in it"
        )
    if back["most"] > 0.1:
        lines.append(
            f"note      the mandrel turns back by up to {back['most']:.3g} degrees, while the eye swings over an edge; "
            f"{back['laying']:.3g} degrees in all while fibre is laid"
        )
    if figures["rewound"]:
        lines.append(rewound_line(figures["rewound"], unit))
    lines += [f"tried     {words}" for words in figures["remedies"]]
    kinds = dict.fromkeys(fault["kind"] for fault in figures["faults"])
    for kind in kinds:
        found = [fault for fault in figures["faults"] if fault["kind"] == kind]
        runs = in_runs(found)
        lines += [f"warning   {words}" for words in runs[:_MOST]]
        if len(runs) > _MOST:
            lines.append(f"warning   and {len(runs) - _MOST} more stretches of this kind; program.json has all blocks")
    return lines


def in_runs(faults: list[dict[str, Any]]) -> list[str]:
    """Faults in words, with one line for blocks in a row that have the same."""
    runs: list[list[int]] = []
    words: list[str] = []
    for fault in faults:
        if runs and words[-1] == fault["words"] and fault["index"] == runs[-1][1] + 1:
            runs[-1][1] = fault["index"]
        else:
            runs.append([fault["index"]] * 2)
            words.append(fault["words"])
    return [
        f"block {first}: {text}" if first == last else f"blocks {first} to {last}: {text}"
        for (first, last), text in zip(runs, words, strict=True)
    ]


def rewound_line(found: dict[str, Any], unit: str) -> str:
    """What is printed of a program that was wound again."""
    away = found["distance"]
    near = f", at most {away['max']:.2g} {unit} off (half of them {away['median']:.2g})" if away else ""
    slid = f"; {found['slid']} slid, as they need more friction" if found["slid"] else ""
    return (
        f"rewound   {found['good']} of {found['passes']} passes come to lie where they were planned{near}{slid}; "
        f"slack up to {found['slack']:.2g} {unit}; {found['seconds']:.2g} s"
    )


def text_lines(name: str, found: dict[str, Any]) -> list[str]:
    """What is printed of a text that was read back."""
    if not found["faults"]:
        return [
            f"text      {name} read back: mandrel within {found['angle']:.1g} degrees, time within "
            f"{found['seconds']:.1g}, touch point within {found['touch']:.1g} of the part"
        ]
    shown = found["faults"][:_MOST]
    return [f"warning   {name}, line {line}: {words}; please report it" for line, words in shown]
