"""A program as it is seen: the chart of its axes, the frames of its movie, and the data of its page."""

import base64
import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.browser import opened
from layup_shapes import cylinder
from PIL import Image
from program_parts import filament, write_run
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait
from viewer_browser import severe

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.filament import backwards
from meshwind.pictures.animation_scene import Reel
from meshwind.pictures.axes_picture import draw_axes, lines_of
from meshwind.pictures.machine_picture import places, turned
from meshwind.pictures.subject import subject_of
from meshwind.program.axes_chart import axes_chart
from meshwind.program.faults import EYE, LIES, LIMIT, SPAN, Fault
from meshwind.program.hits_scene import hits_scene
from meshwind.program.machine import read_machine
from meshwind.program.machine_scene import frame_times, machine_scene, shots_of
from meshwind.program.page import program_data
from meshwind.program.program import Program, program
from meshwind.program.seen import SEEN, write_seen
from meshwind.program.targets import write_program
from meshwind.program.track import track
from meshwind.program.work import Work
from meshwind.results.reading import read_results


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run's folder with a filament."""
    return write_run(tmp_path_factory.mktemp("seen"), 3)


@pytest.fixture(scope="module")
def made(run: Path) -> Program:
    found = program(Work.of(read_results(run)), read_machine("lathe-5"))
    return replace(found, faults=(Fault(7, SPAN, "the free span meets the part or the shaft"),))


def array(packed: Any) -> Floats:
    return np.frombuffer(base64.b64decode(packed["data"]), dtype=f"<{packed['type']}").astype(float)


def test_the_chart_shows_the_blocks(made: Program, tmp_path: Path) -> None:
    chart, blocks = axes_chart(made), made.blocks
    assert [curve.name for curve in chart.curves] == ["mandrel A", "carriage X", "cross-feed Y", "roll B", "yaw C"]
    for curve, values in zip(
        chart.curves, (blocks.mandrel, blocks.eye_x, blocks.eye_r, blocks.roll, blocks.yaw), strict=True
    ):
        assert np.array_equal(curve.values, values)
    assert chart.circuit is not None
    assert chart.circuit[1] == blocks.time[np.flatnonzero(blocks.circuit == 0)[-1]]
    assert np.nansum(chart.speed * np.diff(chart.time)) == pytest.approx(
        np.abs(np.diff(blocks.arc_length + blocks.free_length)).sum(), rel=1e-9
    )
    assert np.nanmax(chart.speed) <= chart.fastest * (1 + 1e-9)
    spent = [float(np.diff(chart.time)[chart.limiting == k].sum()) for k in range(len(chart.names))]
    assert spent == pytest.approx(list(made.limits.values()))
    assert [(words, times.tolist()) for words, times in chart.faults] == [
        ("the free span meets the part or the shaft", [blocks.time[7]])
    ]
    draw_axes(tmp_path / "axes.png", chart)
    with Image.open(tmp_path / "axes.png") as drawn:
        pixels = np.asarray(drawn.convert("RGB"), dtype=int)
    for colour in ("2f6da8", "e08a1e", "1c7c3c", "8a5fb0", "b3541e", "e0218a"):
        wanted = [int(colour[k : k + 2], 16) for k in (0, 2, 4)]
        assert (np.abs(pixels - wanted).max(axis=2) < 40).sum() > 20, colour


@pytest.mark.filterwarnings("error")
def test_a_chart_with_much_to_say_keeps_its_rows(made: Program, tmp_path: Path) -> None:
    few, late = (tmp_path / name for name in ("few.png", "late.png"))
    draw_axes(few, axes_chart(made))
    # after the first circuit: its column has no mark, and the line below the title breaks
    kinds = [Fault(len(made.blocks) - 2, kind, "") for kind in (SPAN, EYE, LIMIT, LIES)]
    chart = axes_chart(replace(made, faults=tuple(kinds)))
    assert chart.subtitle.endswith(
        "an axis leaves its travel at 1 block; the fibre does not lie where it was planned at 1 block (marked)"
    )
    draw_axes(late, chart)
    lines = lines_of(chart.subtitle, 100)
    assert max(map(len, lines)) <= 100
    assert " ".join(lines).replace("·", "").split() == chart.subtitle.replace("·", "").split()
    with Image.open(few) as drawn:
        height = drawn.height
    with Image.open(late) as drawn:
        mandrel = np.abs(np.asarray(drawn.convert("RGB"), dtype=int) - [0x2F, 0x6D, 0xA8]).max(axis=2) < 40
    rows, columns = np.flatnonzero(mandrel.any(axis=1)), np.flatnonzero(mandrel.any(axis=0))
    assert drawn.height > height
    assert np.ptp(rows) > 0.6 * drawn.height and np.ptp(columns) > 0.8 * drawn.width


def test_the_page_has_the_blocks(made: Program) -> None:
    data, blocks = program_data(made), made.blocks
    assert json.loads(json.dumps(data)) == data
    angle = -np.radians(array(data["angle"]))[:, None]
    along, zero, third = np.array(data["frame"])
    eye = np.array(data["origin"]) + array(data["x"])[:, None] * along
    eye = eye + array(data["r"])[:, None] * (np.cos(angle) * zero + np.sin(angle) * third)
    size = made.work.diagonal
    assert np.abs(eye - blocks.eye).max() < 2e-6 * size
    assert np.abs(array(data["point"]).reshape(3, -1).T - blocks.point).max() < 2e-7 * size
    assert 360.0 * array(data["turns"]) + array(data["angle"]) == pytest.approx(blocks.mandrel, abs=4e-5)
    first = array(data["first"]).astype(int)
    run = np.searchsorted(first, np.arange(len(blocks)), side="right") - 1
    for name in ("kind", "layer", "circuit", "passed"):
        assert np.array_equal(array(data[name])[run], getattr(blocks, name)), name  # type: ignore[literal-required]
    assert array(data["faulty"]).tolist() == [7.0]
    thin = program_data(made, 40)
    kept = array(thin["index"]).astype(int)
    assert len(kept) <= 42 and {0, 7, len(blocks) - 1} <= set(kept.tolist())
    assert kept[array(thin["faulty"]).astype(int)].tolist() == [7]
    assert array(thin["time"]) == pytest.approx(blocks.time[kept], rel=1e-6)


def test_the_machine_stands_where_the_blocks_say(made: Program) -> None:
    """The part turns so that the eye stays in its plane, and the span is as long as the block's."""
    blocks, mandrel = made.blocks, made.mandrel
    shots = shots_of(made, blocks.time)
    once = np.flatnonzero(np.append(True, np.diff(blocks.time) > 0.0) & np.append(np.diff(blocks.time) > 0.0, True))
    assert len(once) > 0.9 * len(blocks)
    for k in once[::9]:
        turn = turned(mandrel.frame, mandrel.origin, float(shots.mandrel[k]))
        eye = mandrel.origin + shots.x[k] * mandrel.direction + shots.r[k] * mandrel.zero
        assert turn[:3, :3] @ blocks.eye[k] + turn[:3, 3] == pytest.approx(eye, abs=1e-9)
        touch = turn[:3, :3] @ shots.touch[k] + turn[:3, 3]
        assert np.linalg.norm(eye - touch) == pytest.approx(blocks.free_length[k], abs=1e-9)
    assert np.flatnonzero(shots.faulty).tolist() == [7]
    assert f"roll {blocks.roll[once[3]]:,.1f}°" in shots.notes[once[3]]


def test_frames_are_even_and_slow_first(made: Program) -> None:
    sound = replace(made, faults=())
    even = frame_times(sound, 2000)
    assert np.diff(even) == pytest.approx(made.seconds / 1999)
    few = frame_times(sound, 20)
    assert (len(few), few[0], few[-1]) == (20, 0.0, made.seconds)
    turns = np.interp(few, made.blocks.time, made.blocks.mandrel)
    assert turns[10] - turns[0] <= 12.0 * 11 < turns[-1] - turns[10]
    assert np.isin(made.blocks.time[7], frame_times(made, 20))
    assert (np.diff(frame_times(made, 20)) >= 0.0).all()


def test_hits_are_where_spans_meet_the_part(run: Path, made: Program) -> None:
    of, blocks = subject_of(read_results(run)), made.blocks
    # the span of block 7 is turned to go straight into the part, just below whose surface it counts as met
    aimed = np.where(np.arange(len(blocks))[:, None] == 7, -blocks.normal, blocks.tangent)
    faults = (Fault(7, SPAN, ""), Fault(90, EYE, ""), Fault(30, LIES, ""), Fault(31, LIES, ""))
    scene = hits_scene(of, replace(made, blocks=replace(blocks, tangent=aimed), faults=faults))
    assert scene is not None
    assert scene.spans[0, 0] == pytest.approx(blocks.point[7])
    assert scene.entries[0] == pytest.approx(blocks.point[7] - 1e-3 * made.work.diagonal * blocks.normal[7], abs=2e-4)
    assert scene.eyes == pytest.approx(blocks.eye[[90]])
    assert scene.astray == pytest.approx(blocks.point[[30, 31]])
    assert sum(int(line.split()[0]) for line in scene.notes[: scene.notes.index("")]) == 4
    assert abs(scene.frame.view.eye @ made.mandrel.direction) < 0.5
    assert hits_scene(of, replace(made, faults=(Fault(3, LIMIT, "no place on the part"),))) is None


def test_spans_that_meet_the_shaft_are_told_from_those_that_meet_the_part(run: Path) -> None:
    of, shaft = subject_of(read_results(run)), replace(read_machine("lathe-4"), shaft=0.5)
    made = program(Work.of(read_results(run)), shaft)
    blocks = made.blocks
    faults = tuple(Fault(k, SPAN, "") for k in range(40, 50))
    plain = hits_scene(of, replace(made, machine=read_machine("lathe-4"), faults=faults))
    for inwards, words in ((True, "all of these spans hit"), (False, None)):
        # part (radius 1) and shaft are met straight from outside, from 0.1 above each
        radius = 0.6 if inwards else 1.1
        at = made.mandrel.inside(blocks.point)
        out = at[:, 1:] / np.linalg.norm(at[:, 1:], axis=1, keepdims=True)
        above = np.column_stack([at[:, 0], radius / made.work.scale * out]) @ made.mandrel.frame + made.mandrel.origin
        ahead = np.column_stack([0.0 * at[:, 0], -out]) @ made.mandrel.frame
        aimed = replace(blocks, point=above, tangent=ahead, free_length=np.full(len(blocks), 1.0))
        scene = hits_scene(of, replace(made, blocks=aimed, faults=faults))
        assert scene is not None and plain is not None
        assert len(scene.gear.held) > len(plain.gear.held) and "shaft" in scene.gear.held_words
        assert (words in scene.notes) == inwards


@pytest.mark.usefixtures("opengl")
def test_hits_are_drawn_where_there_are_any(run: Path, made: Program, tmp_path: Path) -> None:
    assert "hits.png" not in [file.name for file in write_program(run, to=("hits",), out=tmp_path).files]
    faults = tuple(Fault(k, SPAN, "") for k in range(0, 200, 20))
    assert write_seen(tmp_path, read_results(run), replace(made, faults=faults), ("hits",)) == []
    with Image.open(tmp_path / "hits.png") as drawn:
        pixels = np.asarray(drawn.convert("RGB"), dtype=int)[150:1050, :1300]
    assert (np.abs(pixels - [0xE0, 0x21, 0x8A]).max(axis=2) < 40).sum() > 1000


def test_a_robot_is_shown_by_its_flange(run: Path) -> None:
    of, work = subject_of(read_results(run)), Work.of(read_results(run))
    for name, frames in (("lathe-4", 0), ("robot", 25)):
        made = program(work, read_machine(name))
        scene = machine_scene(of, made, Reel(1.0, 1.0, [], ""))
        assert scene.flange.shape == (frames, 3, 3)
    assert np.swapaxes(scene.flange, 1, 2) @ scene.flange == pytest.approx(np.broadcast_to(np.eye(3), (25, 3, 3)))
    # z leads from the eye to where the fibre leaves the part, as that stands at the first block
    turn = turned(scene.frame, scene.origin, float(scene.shots.mandrel[0]))
    touch, eye = turn[:3, :3] @ scene.shots.touch[0] + turn[:3, 3], places(scene, 0)[1]
    ahead = (touch - eye) / np.linalg.norm(touch - eye)
    assert scene.flange[0][:, 2] @ scene.frame == pytest.approx(ahead, abs=1e-9)


@pytest.mark.usefixtures("opengl")
def test_the_movie_moves(run: Path, tmp_path: Path) -> None:
    told: list[str] = []
    done = write_program(run, to=("axes", "gif", "viewer"), out=tmp_path, seconds=1.0, progress=told.append)
    assert told[:6] == ["program", "wind again", "write", "axes", "viewer", "movie"]
    assert [int(line.split()[1]) for line in told[6:]] == [3, 5, 8, 10, 13, 15, 18, 20, 23, 25]
    assert [file.name for file in done.files] == [
        "axes.png", "program.csv", "program.gif", "program.html", "program.json", "program_columns.csv",
    ]  # fmt: skip
    with Image.open(tmp_path / "program.gif") as movie:
        assert movie.n_frames >= 25  # type: ignore[attr-defined]
        frames = []
        for k in range(25):
            movie.seek(k)
            frames.append(np.asarray(movie.convert("RGB"), dtype=int)[150:650, :680])
    assert all(frame.std() > 10.0 for frame in frames)
    changed = [float((np.abs(a - b).max(axis=2) > 30).mean()) for a, b in pairwise(frames)]
    assert min(changed) > 1e-3
    page = (tmp_path / "program.html").read_text(encoding="utf-8")
    assert '"turns":{"type":"' in page


def test_the_page_goes_from_block_to_block(run: Path, tmp_path: Path, chromium: tuple[str, str]) -> None:
    found = write_program(run, to=("viewer",), out=tmp_path).program.blocks
    with opened(tmp_path / "program.html", tmp_path / "profile", chromium) as browser:

        def at(block: int) -> str:
            WebDriverWait(browser, 20).until(
                lambda seen: seen.execute_script("return document.body.dataset.block") == str(block)
            )
            return browser.find_element(By.ID, "here").text

        last = len(found) - 1
        for keys, block in ((Keys.ARROW_LEFT, last - 1), (Keys.HOME, 0), (3 * Keys.ARROW_RIGHT, 3)):
            browser.find_element(By.TAG_NAME, "body").send_keys(keys)
            text = at(block)
            assert f"mandrel A {found.mandrel[block]:.2f}°" in text
            assert f"carriage X {found.eye_x[block]:.2f} mm" in text
        assert severe(browser) == []


def test_a_movie_of_no_length_is_refused(run: Path, tmp_path: Path) -> None:
    told: list[str] = []
    with pytest.raises(BadInputError, match="seconds is 0"):
        write_program(run, to=("gif",), out=tmp_path, seconds=0.0, progress=told.append)
    assert not list(tmp_path.iterdir())
    assert told == []  # before anything is computed


def test_a_movie_without_its_encoder_is_refused_at_once(run: Path, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("shutil.which", lambda _name: None)
    monkeypatch.setattr("meshwind.pictures.movie.find_spec", lambda _name: None)
    told: list[str] = []
    with pytest.raises(BadInputError, match=r"mp4 needs FFmpeg, .* or give gif instead"):
        write_program(run, to=("mp4",), out=tmp_path, progress=told.append)
    assert told == []


def test_what_can_be_made_is_named() -> None:
    assert set(SEEN) == {"axes", "hits", "viewer", "gif", "mp4"}


def test_filaments_are_seen_in_the_order_of_the_program() -> None:
    surface = cylinder()
    both = tuple(filament(surface, count, 0.6, 0.2) for count in (1, 2))
    for laid, seen in zip((track(each, backwards=True) for each in both), backwards(both), strict=True):
        assert np.array_equal(laid.points[0, 0], seen.course.points[0])
        assert np.array_equal(laid.points[-1, 1], seen.course.points[-1])
