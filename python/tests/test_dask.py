"""Sweeps on several workers have the results of a single machine, even if workers are lost."""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pyarrow
import pytest

import hardpoint

pytest.importorskip("distributed")

import dask  # noqa: E402
import hardpoint.dask  # noqa: E402
from distributed import Client, Future, LocalCluster  # noqa: E402

MODELS = Path(__file__).resolve().parents[2] / "models"
PART = 512
SAMPLES = 3000
"""Six parts, the last one shorter."""
FAILING = {"ranges": {"tie_rod_outer_y": (-200, 200), "strut_top_x": (-300, 300)}, "samples": 1100}
"""Some of these struts lock."""


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Three worker processes."""
    space = tmp_path_factory.mktemp("workers")
    with LocalCluster(
        n_workers=3, threads_per_worker=1, dashboard_address=":0", host="127.0.0.1", memory_limit=None, local_directory=str(space)
    ) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def client(cluster):
    with Client(cluster) as client:
        yield client


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """Three workers in this process, which see its monkeypatches."""
    space = tmp_path_factory.mktemp("threads")
    with LocalCluster(
        n_workers=3, threads_per_worker=1, processes=False, dashboard_address=":0", memory_limit=None, local_directory=str(space)
    ) as cluster, Client(cluster) as client:
        yield client


@pytest.fixture(scope="module")
def model():
    return hardpoint.read(MODELS / "studies/strut_sweep.toml")


@pytest.fixture(scope="module")
def alone(model):
    """Sweep on one machine."""
    return model.sweep(samples=SAMPLES)


def same(table, columns):
    """All bits of all columns, in order."""
    assert table.column_names == list(columns)
    for name, cells in columns.items():
        ours = table[name].combine_chunks()
        if isinstance(cells, list):
            assert ours.to_pylist() == cells, name
        else:
            assert ours.to_numpy(zero_copy_only=False).tobytes() == np.asarray(cells).tobytes(), name


def files(store):
    """Stored parts, with a mark that changes when one is written."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns, path.read_bytes()) for path in Path(store).glob("*.parquet")}


def untouched(before, store):
    after = files(store)
    assert before and all(after[name] == known for name, known in before.items())


# Numbers


def mirrored(model):
    return model.with_coordinates(), {"ranges": {"tie_rod_inner.x": (-2, 2)}, "samples": 700}


def test_a_missing_store_is_named(model, client):
    with pytest.raises(hardpoint.UsageError, match="`sweep`: missing a required argument: 'store'"):
        hardpoint.dask.sweep(model, client=client, samples=64)


@pytest.mark.parametrize(
    "of",
    [
        lambda model: (model, {"samples": 1100, "curves": ["toe", "camber"]}),
        lambda model: (model, {"method": "latin_hypercube", "samples": np.int64(1100), "seed": 3}),
        lambda model: (model, {"method": "sobol_indices", "samples": 100}),
        lambda model: (model.case("bump"), {"samples": 600, "curves": ["toe"]}),
        lambda model: (model, FAILING),
        lambda model: (model, {**FAILING, "curves": ["toe"]}),
        mirrored,
    ],
    ids=["curves", "hypercube", "sobol_indices", "case", "failing", "curves of failing", "coordinates"],
)
def test_numbers_are_those_of_one_machine(of, model, client, tmp_path):
    model, asked = of(model)
    local = model.sweep(**{**asked, "samples": int(asked["samples"])})
    done = hardpoint.dask.sweep(model, client, tmp_path / "store", part=PART, **asked)
    same(done.read(), local.columns)
    if local.curves:
        same(done.read("curves"), local.curves)
    assert len(done) == len(local) and done.failed == local.facts["failed"]
    assert done.dataset().count_rows() == len(local)


def test_some_struts_do_lock(model):
    assert model.sweep(**FAILING).facts["failed"] > 50


def test_a_list_of_designs_goes_to_the_workers(model, client, tmp_path):
    rows = np.linspace(-5, 5, 600)
    listed = tmp_path / "designs.csv"
    listed.write_text("lca_front_z,tie_rod_outer_z\n" + "".join(f"{x},{x / 2}\n" for x in rows))
    done = hardpoint.dask.sweep(model, client, tmp_path / "store", part=PART, designs=listed)
    same(done.read(), model.sweep(designs=listed).columns)
    listed.write_text("lca_front_z\n1\n")
    with pytest.raises(hardpoint.StudyError, match="the list of designs"):
        hardpoint.dask.sweep(model, client, tmp_path / "store", part=PART, designs=listed)


def test_units_are_in_the_metadata(model, client, tmp_path):
    done = hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=20)
    schema = done.read().schema
    assert schema.field("lca_front_z [mm]").metadata == {b"unit": b"mm"}
    assert schema.field("bump.bump_steer [deg/mm]").metadata == {b"unit": b"deg/mm"}
    assert schema.field("failed").metadata is None
    file = pyarrow.parquet.ParquetFile(tmp_path / "designs-00000000.parquet")
    assert file.metadata.row_group(0).column(1).compression == "ZSTD"


def test_progress_is_reported(model, client, tmp_path):
    reports = []
    hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=1100, progress=lambda *of: reports.append(of))
    assert len(reports) == 3 and reports[-1] == (1100, 1100) and reports == sorted(reports)


# Losses


def dies_writing(flag):
    """Once, after a complete part, a worker writes half a part and is killed."""
    from fsspec.implementations.local import LocalFileSystem

    whole = LocalFileSystem.pipe_file

    def half(self, path, value, **more):
        if any(Path(path).parent.glob("designs-*.parquet")):
            try:
                with open(flag, "x") as out:
                    out.write(str(os.getpid()))
            except FileExistsError:
                pass
            else:
                Path(path).write_bytes(value[: len(value) // 2])
                os.kill(os.getpid(), signal.SIGKILL)
        return whole(self, path, value, **more)

    LocalFileSystem.pipe_file = half


def test_a_worker_is_killed_in_the_middle(model, alone, client, tmp_path):
    store, flag = tmp_path / "store", tmp_path / "killed"
    before = set(client.run(os.getpid).values())
    client.run(dies_writing, str(flag))
    done = hardpoint.dask.sweep(model, client, store, part=PART, samples=SAMPLES)
    killed = int(flag.read_text())
    assert len(before) == 3 and killed in before
    assert killed not in client.run(os.getpid).values()
    same(done.read(), alone.columns)
    # The half part was removed.
    assert sorted(path.name for path in store.iterdir()) == sorted([*files(store), "sweep.json"])
    assert len(files(store)) == 6


def test_a_part_that_kills_its_workers_is_reported(model, tmp_path):
    def dies(flag):
        from fsspec.implementations.local import LocalFileSystem

        LocalFileSystem.pipe_file = lambda *given, **more: os.kill(os.getpid(), signal.SIGKILL)

    with LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=":0", host="127.0.0.1", memory_limit=None, local_directory=str(tmp_path / "space")
    ) as cluster, Client(cluster) as client:
        cluster.scheduler.allowed_failures = 0
        client.run(dies, None)
        with pytest.raises(hardpoint.StudyError, match="designs 0 to 511: 1 workers were lost over it, the last at tcp://127"):
            hardpoint.dask.sweep(model, client, tmp_path / "store", part=PART, samples=PART)
    record = json.loads((tmp_path / "store/sweep.json").read_text())
    assert not record["complete"]


# Wake-ups


def doubled(shared, number):
    """Takes long enough for several workers to be at it."""
    time.sleep(0.005)
    return shared * number


STRESS = int(os.environ.get("HARDPOINT_STRESS", "1"))
"""Factor on the number of sweeps, on a machine whose cores are all busy."""
TASKS = 5


@pytest.fixture
def load():
    """Processes that keep every core busy, if stress is requested."""
    burning = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(STRESS > 1 and os.cpu_count() or 0)]
    yield
    for process in burning:
        process.kill()
        process.wait()


def killing(cluster, enough, killed):
    """Kills one worker after the other while all are busy: a worker that dies during its start is not restarted."""
    while not enough.wait(0.2):
        workers = list(cluster.workers.values())
        known = cluster.scheduler.workers
        if not workers or not all(worker.status.name == "running" and worker.worker_address in known and worker.pid not in killed for worker in workers):
            continue
        killed.append(workers[len(killed) % len(workers)].pid)
        os.kill(killed[-1], signal.SIGKILL)


def sweeps(client, count):
    """Many small sweeps, some of them abandoned: each returns all of its numbers exactly once."""
    for sweep in range(count * STRESS):
        found = []
        tasks = hardpoint.dask._each(client, doubled, 2, range(TASKS), str)
        for number, twice in tasks:
            assert twice == 2 * number
            found.append(number)
            if sweep % 10 == 9 and len(found) == 2:
                break
        else:
            assert sorted(found) == list(range(TASKS)), sweep
        tasks.close()


@pytest.mark.timeout(600 * STRESS)
def test_many_sweeps_beside_another_client(client, here, load):
    """Each client has an event loop of its own, and a wait for its tasks must use it: elsewhere, wake-ups are lost. By default, the
    loop of the last client is used."""
    with Client(here.cluster) as last:
        assert last.loop is not client.loop
        sweeps(client, 50)


@pytest.mark.timeout(600 * STRESS)
def test_many_sweeps_while_workers_are_killed(here, load, tmp_path):
    # A local cluster gives up workers that are missing in two checks at this interval.
    kept = dask.config.set({"distributed.deploy.lost-worker-timeout": "1 hour"})
    with kept, LocalCluster(
        n_workers=3, threads_per_worker=1, dashboard_address=":0", host="127.0.0.1", memory_limit=None, local_directory=str(tmp_path)
    ) as cluster, Client(cluster) as client, Client(here.cluster):
        cluster.scheduler.allowed_failures = 1_000_000
        enough, killed = threading.Event(), []
        killer = threading.Thread(target=killing, args=(cluster, enough, killed))
        killer.start()
        try:
            while len(killed) < 3 * STRESS:
                sweeps(client, 5)
        finally:
            enough.set()
            killer.join()


def test_a_lost_notification_does_not_block(model, alone, here, monkeypatch, tmp_path):
    """The end of a task is noticed without an announcement."""
    monkeypatch.setattr(Future, "add_done_callback", lambda self, callback: None)
    done = hardpoint.dask.sweep(model, here, tmp_path, part=PART, samples=SAMPLES)
    same(done.read(), alone.columns)


def test_a_cluster_without_workers_is_reported(model, tmp_path):
    with LocalCluster(n_workers=0, dashboard_address=":0", host="127.0.0.1", local_directory=str(tmp_path / "space")) as cluster, Client(
        cluster
    ) as client:
        with pytest.raises(hardpoint.StudyError, match="designs 0 to 511: no task has ended for 1 s, and the cluster has no workers"):
            hardpoint.dask.sweep(model, client, tmp_path / "store", part=PART, samples=PART, patience=1.0)


def test_a_busy_worker_is_waited_for(here):
    """A busy worker does not end the wait."""

    def slow(shared, number):
        time.sleep(8)
        return number

    assert list(hardpoint.dask._each(here, slow, None, [7], str, patience=2.0)) == [(7, 7)]


def test_an_exception_of_a_task_is_not_a_silent_cluster(here):
    for error in (OSError, TimeoutError):

        def raises(shared, number):
            raise error("of the task")

        with pytest.raises(error, match="of the task"):
            list(hardpoint.dask._each(here, raises, None, [1], str))


class Enough(Exception):
    pass


def enough(done, total):
    raise Enough


def test_an_interrupted_sweep_resumes(model, alone, client, tmp_path):
    with pytest.raises(Enough):
        hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=SAMPLES, progress=enough)
    before = files(tmp_path)
    with pytest.raises(hardpoint.StudyError, match="is not complete"):
        hardpoint.dask.opened(tmp_path)
    done = hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=SAMPLES)
    untouched(before, tmp_path)
    same(done.read(), alone.columns)
    # A repeated call has nothing left to do.
    before = files(tmp_path)
    hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=SAMPLES)
    assert len(before) == 6
    untouched(before, tmp_path)
    again = hardpoint.dask.opened(tmp_path)
    assert again.parts == done.parts and again.store == done.store
    same(again.read(), alone.columns)


def test_incomplete_parts_are_solved_again(model, alone, client, tmp_path):
    asked = {"part": PART, "samples": SAMPLES}
    hardpoint.dask.sweep(model, client, tmp_path, **asked)
    whole = files(tmp_path)
    torn, empty, gone, other = (tmp_path / f"designs-{first:08}.parquet" for first in (512, 1024, 1536, 2048))
    torn.write_bytes(torn.read_bytes()[:1000])
    empty.write_bytes(b"")
    gone.unlink()
    hardpoint.dask.sweep(model, client, tmp_path / "other", part=PART, samples=SAMPLES, seed=5)
    shutil.copy(tmp_path / "other" / other.name, other)
    left = tmp_path / f".designs-00000512.parquet.{'0' * 32}.partial"
    left.write_bytes(b"PAR1")
    with pytest.raises(hardpoint.StudyError, match="designs-00002048.parquet` belongs to another sweep"):
        hardpoint.dask.Stored.read(_without(hardpoint.dask.opened(tmp_path), torn, empty, gone))
    done = hardpoint.dask.sweep(model, client, tmp_path, **asked)
    same(done.read(), alone.columns)
    assert not left.exists()
    now = files(tmp_path)
    assert {name: content for name, (_, _, content) in now.items()} == {name: content for name, (_, _, content) in whole.items()}
    untouched({name: whole[name] for name in ("designs-00000000.parquet", "designs-00002560.parquet")}, tmp_path)


def _without(stored, *paths):
    stored._files = {"designs": tuple(path for path in stored.parts if Path(path) not in paths)}
    return stored


# Stores


def test_another_sweep_at_the_store_is_refused(model, client, tmp_path):
    hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=600, curves=["toe"])
    before = files(tmp_path)
    changed = hardpoint.parse(model.text.replace("-40*sin", "-41*sin"))
    for other, asked, why in [
        (model, {"samples": 700, "curves": ["toe"]}, "`samples` is 600 there, 700 here"),
        (model, {"samples": 600}, r'`curves` is \["toe"\] there, null here'),
        (model, {"samples": 600, "curves": ["toe"], "part": 1024}, "`part` is 512 there, 1024 here"),
        (model.case("bump"), {"samples": 600, "curves": ["toe"]}, '`case` is null there, "bump" here'),
        (model.with_coordinates(), {"samples": 600, "curves": ["toe"]}, "`added` is"),
        (changed, {"samples": 600, "curves": ["toe"]}, "the text of the model"),
    ]:
        with pytest.raises(hardpoint.StudyError, match=f"holds designs of another sweep .*{why}.*overwrite=True"):
            hardpoint.dask.sweep(other, client, tmp_path, **{"part": PART, **asked})
    untouched(before, tmp_path)
    done = hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=100, overwrite=True)
    same(done.read(), model.sweep(samples=100).columns)
    assert list(files(tmp_path)) == ["designs-00000000.parquet"]


def test_designs_without_a_record_are_not_removed(model, client, tmp_path):
    hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=100)
    before = files(tmp_path)
    for spoiled in ("", '{"sweep": 1}', "[]"):
        (tmp_path / "sweep.json").write_text(spoiled)
        with pytest.raises(hardpoint.StudyError, match="unknown, because its"):
            hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=100)
    (tmp_path / "sweep.json").unlink()
    with pytest.raises(hardpoint.StudyError, match="unknown, because its"):
        hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=100)
    with pytest.raises(hardpoint.StudyError, match="there is no sweep"):
        hardpoint.dask.opened(tmp_path)
    untouched(before, tmp_path)


def test_any_file_system_will_do(model, here, client, tmp_path):
    local = model.sweep(samples=1100, curves=["toe"])
    for with_, store in [(here, "memory://sweeps/strut"), (client, f"file://{tmp_path}/strut")]:
        done = hardpoint.dask.sweep(model, with_, store, part=PART, samples=1100, curves=["toe"])
        assert done.store.rstrip("/").endswith("strut") and done.store.startswith(store.split(":")[0])
        for one in (done, hardpoint.dask.opened(store)):
            same(one.read(), local.columns)
            same(one.read("curves"), local.curves)
            same(one.dataset("curves").to_table(), local.curves)
    assert (tmp_path / "strut/sweep.json").exists()


def test_a_store_that_the_client_does_not_share_is_reported(model, here, monkeypatch, tmp_path):
    """Workers write files that the client does not find."""
    known = hardpoint.dask._listing
    monkeypatch.setattr(hardpoint.dask, "_listing", lambda fs, root: [n for n in known(fs, root) if "parquet" not in n])
    with pytest.raises(hardpoint.StudyError, match="all of them must share the store"):
        hardpoint.dask.sweep(model, here, tmp_path, part=PART, samples=10)


def test_a_store_that_cannot_be_written_is_reported(model, client, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(hardpoint.StudyError, match="is not a valid store"):
        hardpoint.dask.sweep(model, client, tmp_path / "file", part=PART, samples=10)


# Errors


def test_invalid_requests_are_rejected_before_anything_is_written(model, client, tmp_path):
    store = tmp_path / "store"
    for asked, why in [
        ({"part": 1000}, "give `part=1024`"),
        ({"part": 100}, "give `part=512`"),
        ({"ranges": {"tie_rod": (0, 1)}}, "there is no design variable named `tie_rod`"),
        ({"curves": ["to"]}, "did you mean `toe`"),
        ({"sample": 3}, "sample"),
        ({"part": "a"}, "`part` is a whole number"),
        ({"ranges": {"lca_front_z": (-1, float("inf"))}}, "finite numbers"),
        ({"patience": "long"}, "`patience`: 'long' is not a number"),
        ({"progress": 1}, "`progress` is `True`, or a function"),
    ]:
        with pytest.raises(hardpoint.UsageError, match=why):
            hardpoint.dask.sweep(model, client, store, **asked)
    for ask, why in [
        (lambda: hardpoint.dask.sweep(3, client, store), "`model` is a `hardpoint.Model`, not 3"),
        (lambda: hardpoint.dask.sweep(model, 3, store), "`client` is a `distributed.Client`, not 3"),
        (lambda: hardpoint.dask.sweep(model, client, 3), "a path is a text"),
        (lambda: hardpoint.dask.sweep(model, client, "nowhere://there"), "is not a valid store"),
        (lambda: hardpoint.dask.monte_carlo(model, client, store, 8, seed=1.5), "`seed` is a whole number"),
        (lambda: hardpoint.dask.monte_carlo(model, client, store, 8, sead=1), "did you mean `seed`"),
        (lambda: hardpoint.dask.multi_start(model, client, 2, iterations="3"), "`iterations` is a whole number"),
        (lambda: hardpoint.dask.opened(3), "a path is a text"),
    ]:
        with pytest.raises(hardpoint.UsageError, match=why):
            ask()
    with pytest.raises(hardpoint.UsageError, match="at least one sample"):
        hardpoint.dask.monte_carlo(model, client, store, 0)
    with pytest.raises(hardpoint.UsageError, match="at least one start"):
        hardpoint.dask.multi_start(model, client, 0)
    assert not store.exists()
    done = hardpoint.dask.sweep(model, client, store, part=PART, samples=10)
    with pytest.raises(hardpoint.UsageError, match="no table of curves"):
        done.read("curves")


def test_errors_of_workers_are_those_of_the_package(client):
    with pytest.raises(hardpoint.ModelError) as local:
        hardpoint.parse("name = 3")
    with pytest.raises(hardpoint.ModelError) as remote:
        client.submit(hardpoint.parse, "name = 3").result()
    assert remote.value.diagnostics == local.value.diagnostics and remote.value.diagnostics[-1].line == 1


def version(text):
    hardpoint.dask.__version__ = text


def test_a_worker_with_another_version_is_refused(model, client, tmp_path):
    client.run(version, "0.0.1")
    try:
        with pytest.raises(hardpoint.UsageError, match="a worker has hardpoint 0.0.1, the client"):
            hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=11)
    finally:
        client.run(version, hardpoint.__version__)
    assert not files(tmp_path)


# Data transfer


def counts_plans():
    planned, hardpoint.Model.plans = hardpoint.Model.sweep_plan, 0

    def sweep_plan(self, **asked):
        hardpoint.Model.plans += 1
        return planned(self, **asked)

    hardpoint.Model.sweep_plan = sweep_plan


def test_a_worker_plans_once(model, client, tmp_path):
    client.run(counts_plans)
    hardpoint.dask.sweep(model, client, tmp_path, part=PART, samples=12 * PART, ranges={"strut_top_x": (0, 1)})
    plans = client.run(lambda: hardpoint.Model.plans).values()
    assert 1 <= sum(plans) and max(plans) == 1


def test_few_parts_are_under_way(here):
    asked = []

    def numbers():
        for number in range(100):
            asked.append(number)
            yield number

    found = {}
    for number, twice in hardpoint.dask._each(here, lambda shared, number: shared * number, 2, numbers(), str):
        assert len(asked) - len(found) <= 3 * hardpoint.dask.AHEAD
        found[number] = twice
    assert found == {number: 2 * number for number in range(100)}


# Monte Carlo and searches


@pytest.fixture
def toleranced():
    return hardpoint.read(MODELS / "studies/strut_tolerances.toml")


def test_monte_carlo(toleranced, here, tmp_path):
    done = hardpoint.dask.monte_carlo(toleranced, here, tmp_path, 1100, seed=4, part=PART)
    rows = hardpoint.dask._drawn(toleranced, list(range(1100)), 4)
    table = done.read()
    assert len(done) == table.num_rows == 1100
    assert table["design"].to_pylist() == list(range(1100))
    assert table.column_names[1] == "ball_joint_x [mm]" and table.column_names[-1] == "failed"
    same(table.select(range(1, 1 + rows.shape[1])), dict(zip(table.column_names[1:], rows.T)))
    for case in toleranced.cases:
        found = toleranced.designs(rows, case=case, sensitivities=False, partial=True)
        for name, unit in toleranced.metrics(case).items():
            same(table.select([f"{case}.{name} [{unit}]"]), {f"{case}.{name} [{unit}]": found.metric(name)})
    assert done.failed == sum(1 for why in table["failed"].to_pylist() if why)
    with pytest.raises(hardpoint.StudyError, match="`seed` is 4 there, 5 here"):
        hardpoint.dask.monte_carlo(toleranced, here, tmp_path, 1100, seed=5, part=PART)


def test_monte_carlo_reports_why_a_design_fails(model, here, monkeypatch, tmp_path):
    rows = np.zeros((20, len(model.variables)))
    rows[[3, 7], list(model.variables).index("strut_top_x")] = -600, 5
    monkeypatch.setattr(hardpoint.dask, "_drawn", lambda model, numbers, seed: rows[numbers])
    table = hardpoint.dask.monte_carlo(model, here, tmp_path, 20, part=PART).read()
    failed = table["failed"].to_pylist()
    assert [k for k, why in enumerate(failed) if why] == [3]
    # It still moves in the bump case.
    assert failed[3].startswith("steer: ") and "cannot move beyond" in failed[3]
    metrics = {case: [f"{case}.{name} [{unit}]" for name, unit in model.metrics(case).items() if unit != "1"][0] for case in model.cases}
    assert np.isnan(table[metrics["steer"]][3].as_py()) and np.isfinite(table[metrics["bump"]][3].as_py())
    assert np.isfinite(table[metrics["steer"]][7].as_py())


def test_searches_from_many_starts(here):
    model = hardpoint.read(MODELS / "studies/strut_toe.toml")
    reports = []
    best, studies = hardpoint.dask.multi_start(model, here, 3, progress=lambda *of: reports.append(of))
    local = hardpoint.dask.outcome(model, *optimized(model, 3))
    assert best.design == local.design and best.rounded == local.rounded
    assert best.facts["objective"]["after"] == local.facts["objective"]["after"]
    assert len(studies) == 3 and best in studies and reports == [(1, 3), (2, 3), (3, 3)]
    assert studies[0].design == hardpoint.dask.outcome(model, *optimized(model, 1)).design


def optimized(model, starts):
    return model._native.optimize(None, 0, starts, None, 1, None)[0]


def test_the_best_search():
    facts = lambda objective, violation, kkt: {"objective": {"after": objective}, "violation": {"after": violation}, "kkt": kkt}  # noqa: E731
    best = hardpoint.dask._best
    none = facts(None, None, None)
    assert best([facts(1.0, 0.1, 0.0), facts(3.0, 0.0, 0.5), facts(2.0, 1e-9, 0.5), none]) == 2
    assert best([none, facts(1.0, 0.2, 0.0), facts(3.0, 0.1, 0.0)]) == 2
    assert best([facts(1.0 + 1e-10, 0.0, 1e-9), facts(1.0, 0.0, 1e-3), facts(1.0 + 1e-8, 0.0, 0.0)]) == 0
    assert best([none, none]) == 0
