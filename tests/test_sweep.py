"""Studies: their meaning, that each case is done once even if workers are killed, and the same results everywhere."""

import csv
import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pyarrow import parquet

from meshwind.core.errors import BadInputError
from meshwind.studies import read_study, sweep
from meshwind.studies.charts import kept_apart, line_words
from meshwind.studies.local import run_local
from meshwind.studies.study import CaseStatus, Row
from meshwind.studies.work import Done, grouped

DATA = Path(__file__).parents[1] / "data"
TABLES = "results.csv", "results.parquet"
FEW = "paths = 3\nparticles = 41\n"


def study(folder: Path, text: str) -> Path:
    file = folder / "study.toml"
    file.write_text(text, encoding="utf-8")
    return file


def mesh(name: str) -> str:
    return json.dumps(str(DATA / name))


def small(folder: Path) -> Path:
    return study(folder, f'{FEW}mesh = [{mesh("vase.stl")}, {mesh("tank.ply")}]\nrevolutions = [0.3, 0.4]\n'
                         'friction = [0, 0.1]\n')  # fmt: skip


def test_lists_are_combined_and_tables_stand_for_themselves(tmp_path: Path) -> None:
    plan = read_study(small(tmp_path))
    assert len(plan) == 8 and plan.swept == ("mesh", "revolutions", "friction")
    assert {(c.mesh.name, c.options.revolutions, c.options.friction) for c in plan.cases} == {
        (m, r, f) for m in ("vase.stl", "tank.ply") for r in (0.3, 0.4) for f in (0.0, 0.1)
    }
    text = (
        f'{FEW}mesh = {mesh("vase.stl")}\n[[case]]\nrevolutions = "1/4"\n[[case]]\nrevolutions = 0.5\npaths = [4, 5]\n'
    )
    plan = read_study(study(tmp_path, text))
    assert [(c.options.revolutions, c.options.paths) for c in plan.cases] == [(0.25, 3), (0.5, 4), (0.5, 5)]


def test_arrays_and_ranges_are_lists_too() -> None:
    plan = read_study({"mesh": "a.stl", "paths": range(2, 4), "revolutions": np.linspace(0.2, 0.4, 2)})
    assert [(c.options.paths, c.options.revolutions) for c in plan.cases] == [(2, 0.2), (2, 0.4), (3, 0.2), (3, 0.4)]


def test_cases_that_are_alike_are_one_and_share_a_part(tmp_path: Path) -> None:
    plan = read_study(study(tmp_path, f'{FEW}mesh = {mesh("vase.stl")}\nrevolutions = [0.3, 0.3, 0.5]\n'
                                      'tolerance = [1e-5, 1e-4]\n'))  # fmt: skip
    assert len(plan) == 4
    assert sorted(len(group.cases) for group in grouped(dict(enumerate(plan.cases)))) == [2, 2]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("paths = 3\n", "mesh is missing"),
        ('mesh = "a.stl"\nrevolution = 0.3\n', "did you mean 'revolutions'"),
        ('mesh = "a.stl"\npaths = [3, 0]\n', "paths is 0"),
        ('mesh = "a.stl"\nrevolutions = []\n', "a list is empty"),
        ('mesh = "a.stl"\nrevolutions = "many"\n', "revolutions is 'many'"),
        ("mesh = 3\n", "mesh is 3"),
        ('mesh = "a.stl"\nrender = "yes"\n', "render is 'yes'"),
        ('mesh = "a.stl"\ncase = 3\n', "[[case]]"),
        ("mesh = \n", "not valid TOML"),
        (f'mesh = "a.stl"\npaths = {list(range(1, 400))}\nfriction = {[k / 1000 for k in range(400)]}\n', "cases"),
    ],
)
def test_a_study_that_makes_no_sense_is_refused_in_one_line(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as caught:
        read_study(study(tmp_path, text))
    assert says in str(caught.value) and "\n" not in str(caught.value)


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "results.csv").open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A study that ran in two processes: its file and its folder, with the tables beside it as it left them."""
    folder = tmp_path_factory.mktemp("study")
    file = small(folder)
    swept = sweep(file, folder / "out", processes=2)
    assert swept.anew == 8 and swept.settled
    for name in TABLES:
        shutil.copy(folder / "out" / name, folder / name)
    return file, folder / "out"


def test_a_study_leaves_a_table_a_chart_and_a_folder_a_case(done: tuple[Path, Path]) -> None:
    _, out = done
    table = rows(out)
    assert len(table) == 8 and {row["status"] for row in table} == {"at rest"}
    columns = parquet.read_table(out / "results.parquet").to_pylist()
    assert [row["case"] for row in columns] == [row["case"] for row in table]
    for row, typed in zip(table, columns, strict=True):
        report = json.loads((out / "cases" / row["folder"] / "report.json").read_text(encoding="utf-8"))
        assert report["paths"]["length_total"] == typed["length"] == float(row["length"])
        assert report["winding"]["friction"] == typed["friction"]
        assert (out / "cases" / row["folder"] / "paths.vtp").is_file()
    assert (out / "tradeoffs.png").stat().st_size > 10_000


def test_started_again_it_does_nothing_twice_and_goes_on_where_it_was(done: tuple[Path, Path], tmp_path: Path) -> None:
    file, out = done
    before = {path: path.stat().st_mtime_ns for path in (out / "cases").rglob("*")}
    table = (out / "results.csv").read_bytes()
    assert sweep(file, out).anew == 0
    assert {path: path.stat().st_mtime_ns for path in (out / "cases").rglob("*")} == before
    assert (out / "results.csv").read_bytes() == table
    # one more value: what is done stays
    more = study(tmp_path, file.read_text(encoding="utf-8").replace("[0.3, 0.4]", "[0.3, 0.4, 0.45]"))
    lost = next((out / "cases").iterdir())
    for path in lost.iterdir():
        path.unlink()
    lost.rmdir()
    swept = sweep(more, out, processes=1)
    assert swept.anew == 5 and len(swept.rows) == 12


def test_a_case_that_fails_is_a_row_with_its_reason(tmp_path: Path) -> None:
    (tmp_path / "torn.stl").write_text("this is a letter, not a part\n", encoding="utf-8")
    file = study(tmp_path, f'{FEW}mesh = ["missing.stl", "torn.stl", {mesh("vase.stl")}]\nopening = [1.0, 1e9]\n')
    swept = sweep(file, tmp_path / "out", processes=1)
    assert not swept.settled
    by_mesh = {(row["mesh"], row["opening"]): row for row in swept.rows}
    assert "not found" in str(by_mesh["missing.stl", 1.0]["reason"])
    assert by_mesh["torn.stl", 1.0]["status"] == "refused" and by_mesh["torn.stl", 1.0]["reason"]
    assert by_mesh["vase.stl", 1.0]["status"] == "at rest"


def workers(parent: int) -> list[int]:
    """Children of a process that run Python's worker loop."""
    found = []
    for each in Path("/proc").iterdir():
        if each.name.isdigit():
            try:
                stat, line = (each / "stat").read_text(), (each / "cmdline").read_bytes()
            except OSError:
                continue
            if int(stat.rpartition(")")[2].split()[1]) == parent and b"spawn_main" in line:
                found.append(int(each.name))
    return found


def test_killed_workers_cases_are_run_again_and_come_once(tmp_path: Path) -> None:
    text = f"{FEW}mesh = [{mesh('vase.stl')}]\nrevolutions = {[round(0.2 + 0.01 * k, 2) for k in range(10)]}\n"
    plan = read_study(study(tmp_path, text))
    came: list[int] = []
    killed = 0
    for number, found in run_local(grouped(dict(enumerate(plan.cases))), 2):
        assert isinstance(found, Done) and not found.reason
        came.append(number)
        if len(came) in (2, 5) and (mine := workers(os.getpid())):
            os.kill(mine[0], signal.SIGKILL)
            killed += 1
    assert killed == 2
    assert sorted(came) == list(range(10))


def test_a_job_that_kills_every_worker_is_given_up_and_the_others_done(tmp_path: Path) -> None:
    """A mesh whose worker dies as it is fitted, by a limit of memory that only it breaks, is a row in the end."""
    from meshwind.studies import local

    plan = read_study(study(tmp_path, f"{FEW}mesh = [{mesh('vase.stl')}]\nrevolutions = [0.3, 0.4]\n"))
    queue = local._Queue(grouped(dict(enumerate(plan.cases))), tmp_path, deque())
    job = local._Job(0, 1)
    came: list[Any] = []
    for _ in range(local.MAX_ATTEMPTS):
        came += list(local._requeue(queue, [job]))
        queue.retries.clear()
    assert (
        [number for number, _ in came] == [1] and came[0][1].status == CaseStatus.LOST and "killed" in came[0][1].reason
    )


def test_interrupted_and_started_again_every_case_is_there_once(tmp_path: Path) -> None:
    text = f"{FEW}mesh = [{mesh('vase.stl')}]\nrevolutions = {[round(0.2 + 0.01 * k, 2) for k in range(8)]}\n"
    file, out = study(tmp_path, text), tmp_path / "out"
    command = [sys.executable, "-m", "meshwind", "sweep", str(file), "--out", str(out), "--processes", "1", "--quiet"]
    first = subprocess.Popen(command, start_new_session=True)
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline and first.poll() is None:
        if (out / "cases").is_dir() and len(list((out / "cases").glob("vase-*"))) >= 3:
            break
        time.sleep(0.02)
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    half = len(list((out / "cases").glob("vase-*")))
    assert half >= 3
    again = subprocess.run([*command[:-1], "--json"], capture_output=True, text=True, timeout=240)
    assert again.returncode == 0, again.stderr
    printed = json.loads(again.stdout)
    assert printed["anew"] == 8 - half
    assert len(rows(out)) == 8 and len({row["case"] for row in rows(out)}) == 8
    assert all(
        (case / "report.json").is_file() and (case / "case.json").is_file() for case in (out / "cases").iterdir()
    )


def test_a_cluster_gives_the_same_table(done: tuple[Path, Path], tmp_path: Path) -> None:
    from distributed import LocalCluster

    file, _ = done
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        assert sweep(file, tmp_path / "dask", scheduler=cluster.scheduler_address).anew == 8
    for name in TABLES:
        assert (tmp_path / "dask" / name).read_bytes() == (file.parent / name).read_bytes()


def test_a_missing_scheduler_is_one_line(tmp_path: Path) -> None:
    from meshwind.studies import cluster

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cluster, "CONNECT_SECONDS", 1)
        with pytest.raises(BadInputError, match="no scheduler answers"):
            sweep(small(tmp_path), tmp_path / "out", scheduler="tcp://127.0.0.1:1")


def test_lines_of_the_chart_say_in_what_they_differ() -> None:
    groups: list[Row] = [
        {"mesh": mesh, "friction": friction, "turns": 0.5} for mesh in ("a.stl", "b.stl") for friction in (0.1, 0.25)
    ]
    assert line_words(groups, ["mesh", "friction", "turns"]) == ["friction 0.1", "friction 0.25"] * 2
    assert line_words(groups[:1], ["friction"]) == [""]
    places = [0.5, 0.51, 0.99, 0.98, 0.0, 0.5]
    moved = kept_apart(places, 0.1)
    assert min(moved) >= 0.0 and max(moved) <= 1.0
    ranked = sorted(range(6), key=places.__getitem__)
    assert all(moved[b] - moved[a] > 0.1 - 1e-9 for a, b in itertools.pairwise(ranked))
    assert kept_apart([0.2, 0.8], 0.1) == [0.2, 0.8]
