"""Sweeps, Monte Carlo and searches from many starts, on the workers of dask.distributed (`pip install 'hardpoint[dask]'`).

    >>> from distributed import Client
    >>> import hardpoint, hardpoint.dask
    >>> model = hardpoint.read("models/studies/strut_sweep.toml")
    >>> with Client() as client:
    ...     done = hardpoint.dask.sweep(model, client, "results/strut", samples=100_000)
    >>> done.read()                                                 # an Arrow table, in order of designs

`docs/scaling.md` describes data transfer, lost workers, interrupted runs, and limits.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import tempfile
import threading
import time
import uuid
from asyncio import CancelledError
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from functools import lru_cache
from itertools import islice
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, NamedTuple, Union

try:
    import fsspec
    import pyarrow
    import pyarrow.dataset
    import pyarrow.parquet
    from distributed import Client, Future, KilledWorker, TimeoutError
except ImportError as missing:
    raise ImportError(f"hardpoint.dask needs distributed, fsspec and pyarrow ({missing}): pip install 'hardpoint[dask]'") from missing

from . import __version__, arguments, files
from .arguments import amount, by_name, count, instance, number
from .errors import StudyError, UsageError
from .model import Model, Progress, listener
from .studies import Study, outcome

if TYPE_CHECKING:
    import numpy as np

__all__ = ["Searches", "Stored", "monte_carlo", "multi_start", "opened", "sweep"]

Store = Union[str, "os.PathLike[str]"]
"""A folder, or any URL of fsspec (`s3://bucket/sweep`), that the client and all workers can access."""
Columns = Mapping[str, Any]
"""Cells by column name, with units in brackets."""

PART = 8192
"""Default number of designs per part."""
BLOCK = 512
"""Number of designs in a block; parts begin with a block, so that their last bits do not depend on the partition."""
AHEAD = 3
"""Number of submitted tasks per thread of the workers: one is being solved, the others are queued."""
PATIENCE = 600.0
"""Seconds without a finished task or a busy worker after which a sweep ends with an error."""
LOOK = 1.0
"""Seconds between two checks of the states of futures."""
ASK = 10.0
"""Seconds between two queries of the scheduler for busy workers, while no task ends."""
ANSWER = 30.0
"""Time limit for an answer of the scheduler, in seconds; then the query is repeated."""
ENDED = ("finished", "error", "cancelled")
"""States of finished futures. The data of a `lost` one is computed again."""
RECORD = "sweep.json"
NAME = re.compile(r"(?P<table>designs|curves)-(?P<first>\d{8,})\.parquet")
PARTIAL = re.compile(r"\.(designs|curves)-\d{8,}\.parquet\.[0-9a-f]{32}\.partial")


@arguments.named
def sweep(
    model: Model,
    client: Client,
    store: Store,
    *,
    part: int = PART,
    overwrite: bool = False,
    progress: Progress = None,
    patience: float = PATIENCE,
    storage_options: Mapping[str, Any] | None = None,
    **asked,
) -> Stored:
    """Solves the designs of `model.sweep(**asked)` on the workers of `client`, and stores them at `store` in parts of `part` designs:
    `designs-00000000.parquet` with the number of its first design, and `curves-` if `curves` are requested. The numbers are those of
    `model.sweep`, bit for bit.

    The same call resumes an interrupted sweep: complete parts are not solved again. A store with other data is rejected; `overwrite`
    empties it first. `progress` receives numbers of designs. Raises `StudyError` if no part has ended and no worker was busy for
    `patience` seconds; `math.inf` waits for workers indefinitely.
    """
    _check(model, client)
    part, report = count("part", part) or PART, listener(progress)
    at = _at(store, storage_options)
    listed = asked.pop("designs", None)
    asked = json.loads(json.dumps({name: value for name, value in asked.items() if value is not None}, default=_plain))
    designs = model.sweep_plan(**asked, **({} if listed is None else {"designs": listed})).count
    listed = None if listed is None else (Path(listed).name, Path(listed).read_bytes())
    return _stored(_Sweep(model, designs, part, asked, listed), client, at, overwrite, report, _patience(patience))


@arguments.named
def monte_carlo(
    model: Model,
    client: Client,
    store: Store,
    samples: int,
    seed: int | None = None,
    *,
    part: int = PART,
    overwrite: bool = False,
    progress: Progress = None,
    patience: float = PATIENCE,
    storage_options: Mapping[str, Any] | None = None,
) -> Stored:
    """Solves the Monte Carlo designs of `model.tolerance(samples=samples, seed=seed)` in every case, and stores their variables and
    metrics like `sweep`. The default of `seed` is that of the model file.
    """
    _check(model, client)
    part, report = count("part", part) or PART, listener(progress)
    at = _at(store, storage_options)
    designs, seed = count("samples", samples, 0), count("seed", seed, 0)
    if not designs:
        raise UsageError.saying("there are no designs; give at least one sample")
    _drawn(model, [0], seed)
    return _stored(_Drawn(model, designs, part, seed), client, at, overwrite, report, _patience(patience))


class Searches(NamedTuple):
    """Searches from several starts."""

    best: Study
    """Best search by the rule of `model.optimize`: the minimum objective among those that keep all limits, or else the minimum
    violation."""
    studies: tuple[Study, ...]
    """All searches, in order of starts; number 0 starts from the nominal design."""


@arguments.named
def multi_start(
    model: Model,
    client: Client,
    starts: int,
    iterations: int | None = None,
    *,
    progress: Progress = None,
    patience: float = PATIENCE,
) -> Searches:
    """Optimises the design (`model.optimize`) from several starts, each on a worker. `progress` receives numbers of searches."""
    _check(model, client)
    report, found = listener(progress), {}
    wanted, iterations = count("starts", starts, 0), count("iterations", iterations, 0)
    if not wanted:
        raise UsageError.saying("there are no starts; give at least one start")
    asked = _Search(model, iterations)
    with closing(_each(client, _search, asked, range(wanted), lambda first: f"start {first}", _patience(patience))) as searches:
        for first, search in searches:
            found[first] = outcome(model, *search)
            if report:
                report(len(found), wanted)
    studies = tuple(found[first] for first in range(wanted))
    return Searches(studies[_best([study.facts for study in studies])], studies)


@arguments.named
def opened(store: Store, storage_options: Mapping[str, Any] | None = None) -> Stored:
    """Results of `sweep` or `monte_carlo` in a store."""
    fs, root = _at(store, storage_options)
    record = _record(fs, root)
    if record is None or not record["complete"]:
        why = f"the sweep at `{root}` is not complete; repeat the same call" if record else f"there is no sweep at `{root}`"
        raise StudyError.saying(why)
    return Stored(fs, root, record)


class Stored:
    """Solved designs at a store."""

    def __init__(self, fs: fsspec.AbstractFileSystem, root: str, record: dict):
        self._fs = fs
        self._record = record
        self.store: str = fs.unstrip_protocol(root)
        """Location as a URL."""
        firsts = range(0, record["designs"], record["sweep"]["part"])
        self._files = {table: tuple(_path(root, table, first) for first in firsts) for table in record["tables"]}
        self.parts: tuple[str, ...] = self._files["designs"]
        """Files of designs, in order."""
        self.designs: int = record["designs"]
        """Number of designs."""
        self.failed: int = record["failed"]
        """Number of designs that do not reach the end of a motion; the column `failed` has the reasons."""

    def __len__(self) -> int:
        return self.designs

    def __repr__(self) -> str:
        failed = f", {self.failed} of them failed" if self.failed else ""
        return f"<hardpoint.dask.Stored at {self.store}: {amount(self.designs, 'design')} in {amount(len(self.parts), 'part')}{failed}>"

    def read(self, table: str = "designs") -> pyarrow.Table:
        """Reads the table of `designs`, or that of `curves`, in order of designs into memory."""
        found = []
        for path in self._of(table):
            with self._fs.open(path, "rb") as file:
                one = pyarrow.parquet.ParquetFile(file)
                if _part_record(one.metadata).get("sweep") != self._record["digest"]:
                    raise StudyError.saying(f"`{path}` belongs to another sweep; call `sweep` again to solve it again")
                found.append(one.read().replace_schema_metadata(None))
        return pyarrow.concat_tables(found)

    def dataset(self, table: str = "designs") -> pyarrow.dataset.Dataset:
        """Arrow data set, from which columns and rows are read on demand."""
        return pyarrow.dataset.dataset(list(self._of(table)), filesystem=self._fs, format="parquet")

    def _of(self, table: str) -> tuple[str, ...]:
        if table not in self._files:
            raise UsageError.saying(f"there is no table of {table} at the store; there are {', '.join(self._files)}")
        return self._files[table]


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise UsageError.saying(f"options of a sweep are numbers, texts, lists and dictionaries, not {value!r}")


# Work


class _Work:
    """Data of a task. They are sent to each worker once, and planned there once."""

    study: str

    def __init__(self, model: Model, count: int, part: int, asked: dict):
        if part < BLOCK or part % BLOCK:
            near = max(1, round(part / BLOCK)) * BLOCK
            raise UsageError.saying(f"designs are solved in blocks of {BLOCK}, so a part cannot have {part} designs; give `part={near}`")
        self.model = model
        self.count = count
        self.part = part
        self.version = __version__
        digest = lambda text: hashlib.sha256(text.encode()).hexdigest()  # noqa: E731
        fingerprint = {
            "study": self.study,
            "hardpoint": __version__,
            "model": digest(model.text),
            "files": {name: digest(text) for name, text in sorted(model._native.files.items())},
            "case": None if model._case is None or not model.cases else model.cases[model._case],
            "added": dict(zip(("coordinates", "tilts"), map(bool, model._added))),
            "asked": asked,
            "part": part,
        }
        self.fingerprint: dict = json.loads(json.dumps(fingerprint, default=_plain))
        """Everything that the results depend on, in JSON form."""
        self.digest: str = digest(json.dumps(self.fingerprint, sort_keys=True))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Work) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def last(self, first: int) -> int:
        """End of the part that begins with this design."""
        return min(first + self.part, self.count)

    def tables(self) -> tuple[str, ...]:
        """Names of the tables, in the order in which they are written."""
        return ("designs",)

    def plan(self) -> Any:
        """Plan for all parts."""

    def solve(self, plan: Any, first: int, last: int) -> dict[str, Columns]:
        """Solves some designs and returns their tables."""
        raise NotImplementedError


_planning = threading.Lock()


@lru_cache(maxsize=4)
def _plan(work: _Work) -> Any:
    """Plan of the work, shared by all its parts."""
    if work.version != __version__:
        raise UsageError.saying(f"a worker has hardpoint {__version__}, the client {work.version}; install the same everywhere")
    return work.plan()


class _Sweep(_Work):
    study = "sweep"

    def __init__(self, model: Model, count: int, part: int, asked: dict, listed: tuple[str, bytes] | None):
        designs = {} if listed is None else {"designs": hashlib.sha256(listed[1]).hexdigest()}
        super().__init__(model, count, part, {**asked, **designs})
        self._asked = asked
        self._listed = listed

    def plan(self) -> Any:
        if self._listed is None:
            return self.model.sweep_plan(**self._asked)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / self._listed[0]
            path.write_bytes(self._listed[1])
            return self.model.sweep_plan(**self._asked, designs=path)

    def tables(self) -> tuple[str, ...]:
        return ("curves", "designs") if self._asked.get("curves") else ("designs",)

    def solve(self, plan: Any, first: int, last: int) -> dict[str, Columns]:
        designs, curves = plan.part(first, last, 1)
        return {"designs": dict(designs), "curves": dict(curves)}


class _Drawn(_Work):
    study = "monte_carlo"

    def __init__(self, model: Model, count: int, part: int, seed: int | None):
        super().__init__(model, count, part, {"samples": count, "seed": seed})
        self._seed = seed

    def solve(self, plan: Any, first: int, last: int) -> dict[str, Columns]:
        model, numbers = self.model, range(first, last)
        rows = _drawn(model, list(numbers), self._seed)
        columns: dict[str, Any] = {"design": pyarrow.array(numbers, pyarrow.int64())}
        columns.update((_title(v.name, v.unit), rows[:, k]) for k, v in enumerate(model.variables.values()))
        failed: dict[int, list[str]] = {}
        for case in _cases(model):
            found = model.designs(rows, case=case, sensitivities=False, partial=True, workers=1)
            for name, unit in model.metrics(case).items():
                columns[_title(name if case is None else f"{case}.{name}", unit)] = found.metric(name)
            for number, why in found.stops.items():
                failed.setdefault(number, []).append(why.message if case is None else f"{case}: {why.message}")
        columns["failed"] = ["; ".join(failed.get(k, ())) for k in range(len(rows))]
        return {"designs": columns}


def _cases(model: Model) -> tuple[str | None, ...]:
    if not model.cases:
        return (None,)
    return model.cases if model._case is None else (model.cases[model._case],)


def _title(name: str, unit: str) -> str:
    """Name of a column, as in the tables of the command line."""
    return name if unit in ("", "1") else f"{name} [{unit}]"


def _drawn(model: Model, numbers: list[int], seed: int | None) -> np.ndarray:
    """Designs of a tolerance study by number, `[design, variable]`, in the model's units."""
    return model._native.drawn_designs(numbers, model._studied, seed)


class _Search(NamedTuple):
    model: Model
    iterations: int | None


def _search(asked: _Search, first: int) -> tuple[str, list[float] | None, list[float] | None]:
    """Search from one start: its result as JSON, the optimised design with rounded numbers, and the exact one."""
    return asked.model._native.optimize(asked.model._studied, first, 1, asked.iterations, 1, None)[0]


KEPT = 1e-8
"""Relative violation up to which a limit counts as kept, as in the engine."""
AS_GOOD = 1e-9
"""Relative difference up to which objectives are as good, as in the engine; then the one closer to an optimum is chosen."""


def _best(found: list[dict]) -> int:
    """Index of the best search, by their facts."""

    def rank(facts: dict) -> tuple[bool, float]:
        objective, violation = facts["objective"]["after"], facts["violation"]["after"]
        if objective is None or violation is None:
            return True, float("inf")
        return (False, objective) if violation <= KEPT else (True, violation)

    ranks = [rank(facts) for facts in found]
    exceeds, least = min(ranks)
    as_good = [k for k, (e, value) in enumerate(ranks) if e == exceeds and (value == least or value - least <= AS_GOOD * abs(least))]
    return min(as_good, key=lambda k: float("inf") if found[k]["kkt"] is None else found[k]["kkt"])


# Tasks


def _check(model: Model, client: Client) -> None:
    instance("model", model, Model, "hardpoint.Model")
    instance("client", client, Client, "distributed.Client")
    if client.asynchronous:
        raise UsageError.saying("the client is asynchronous; create it with `Client(...)` outside of coroutines")


def _patience(seconds: Any) -> float:
    found = number("`patience`", seconds)
    if not found >= 0:
        raise UsageError.saying(f"`patience` is a number of seconds, not {seconds!r}")
    return found


def _itself(shared: Any) -> Any:
    return shared


def _each(
    client: Client,
    work: Callable[[Any, int], Any],
    shared: Any,
    numbers: Iterable[int],
    named: Callable[[int], str],
    patience: float = PATIENCE,
) -> Iterator[tuple[int, Any]]:
    """Yields the results of `work(shared, number)` for all numbers, in order of completion.

    The shared data are the result of a task: each worker receives them once, from another worker, and they are computed again if all
    workers that had them are lost. The number of submitted tasks follows the number of workers.

    The end of a task is announced by a callback on the event loop of this client; `distributed.as_completed` would by default wait on
    the loop of the client that was created last, whose thread misses wake-ups of this one. The states of futures are also polled, so
    that a lost announcement does no harm.
    """
    name = f"hardpoint-{uuid.uuid4().hex}"
    here = client.submit(_itself, shared, key=f"{name}-model")
    waiting, under_way = iter(numbers), {}
    ended: SimpleQueue[Future] = SimpleQueue()
    watch = _Watch(client, patience)
    room = since = 0
    try:
        while True:
            # The number of workers may change.
            if since >= room:
                room, since = AHEAD * max(1, watch.threads()), 0
            for number in islice(waiting, max(0, room - len(under_way))):
                future = client.submit(work, here, number, key=f"{name}-{number}")
                under_way[future] = number
                future.add_done_callback(ended.put)
            if not under_way:
                return
            future = _next(ended, under_way)
            found = None if future is None else _result(future, named(under_way[future]))
            if found is None:
                watch.nothing_ended(named(min(under_way.values())))
                continue
            since += 1
            yield under_way.pop(future), found[0]
            # The time that the caller has used meanwhile does not count.
            watch.one_ended()
    finally:
        # Tasks that have not started are dropped.
        for future in [*under_way, here]:
            future.release()


def _next(ended: SimpleQueue[Future], under_way: Mapping[Future, int]) -> Future | None:
    """Returns a finished task, or `None` if none ends for a while."""
    try:
        future = ended.get(timeout=LOOK)
        return future if future in under_way else None
    except Empty:
        return next((future for future in under_way if future.status in ENDED), None)


def _result(future: Future, named: str) -> tuple[Any] | None:
    """Result of a task; `None` if it is not available: its worker was lost, or the scheduler does not answer."""
    try:
        return (future.result(timeout=ANSWER),)
    except KilledWorker as error:
        raise StudyError.saying(
            f"{named}: {error.allowed_failures + 1} workers were lost over it, the last at {error.last_worker.address}; perhaps they have too "
            "little memory: give smaller parts or fewer threads to each, then call it again"
        ) from error
    except CancelledError as error:
        raise StudyError.saying(f"{named}: the cluster has cancelled it ({error}); repeat the call, which resumes it") from error
    except (OSError, TimeoutError):
        # A time-out raised by the task itself is its result.
        if future.status == "error":
            raise
        return None


class _Watch:
    """Ends the wait for tasks that no worker executes."""

    def __init__(self, client: Client, patience: float):
        self._client = client
        self._patience = patience
        self._since = self._asked = time.monotonic()

    def threads(self) -> int:
        """Number of threads of all workers; 0 if the scheduler does not answer."""
        try:
            return sum(self._client.nthreads(callback_timeout=ANSWER).values())
        except (OSError, TimeoutError):
            return 0

    def one_ended(self) -> None:
        """Records that a task has ended."""
        self._since = time.monotonic()

    def nothing_ended(self, named: str) -> None:
        """Records that no task has ended for a while. Raises an error after the time limit without a busy worker."""
        now = time.monotonic()
        if now - self._asked < min(ASK, self._patience):
            return
        self._asked = now
        workers, busy = self._at_work()
        if busy:
            self._since = now
        elif now - self._since >= self._patience:
            has = "does not answer" if workers is None else "has no workers" if workers == 0 else f"has {workers} workers, and none executes a task"
            raise StudyError.saying(
                f"{named}: no task has ended for {self._patience:g} s, and the cluster {has}; check that its scheduler and workers run, "
                "then call it again, it goes on from what is done; `patience` is how many seconds it waits"
            )

    def _at_work(self) -> tuple[int | None, bool]:
        """Number of workers, if the scheduler answers, and whether any of them executes a task, by their last report."""
        try:
            known = self._client.sync(self._client.scheduler.identity, callback_timeout=ANSWER)
        except (OSError, TimeoutError):
            return None, False
        workers = known["workers"].values()
        return len(workers), any(worker["metrics"].get("task_counts", {}).get("executing", 0) > 0 for worker in workers)


class _Part(NamedTuple):
    """Subject of each task."""

    work: _Work
    fs: fsspec.AbstractFileSystem
    root: str


def _solve(asked: _Part, first: int) -> int:
    """Solves a part, unless it is stored already; returns its number of failed designs."""
    work, last = asked.work, asked.work.last(first)
    part_record = {"sweep": work.digest, "first": first, "last": last}
    paths = {table: _path(asked.root, table, first) for table in work.tables()}
    known = [_known(asked.fs, path) for path in paths.values()]
    if all(one == {**part_record, "failed": known[0].get("failed")} for one in known):
        return known[0]["failed"]
    with _planning:
        plan = _plan(work)
    tables = work.solve(plan, first, last)
    part_record["failed"] = sum(1 for why in tables["designs"]["failed"] if why)
    for table, path in paths.items():
        _put(asked.fs, path, _bytes(tables[table], part_record))
    return part_record["failed"]


def _stored(
    work: _Work,
    client: Client,
    at: tuple[fsspec.AbstractFileSystem, str],
    overwrite: bool,
    report: Callable[[int, int], Any] | None,
    patience: float,
) -> Stored:
    fs, root = at
    record = _begun(fs, root, work, overwrite)
    done = failed = 0
    named = lambda first: f"designs {first} to {work.last(first) - 1}"  # noqa: E731
    with closing(_each(client, _solve, _Part(work, fs, root), range(0, work.count, work.part), named, patience)) as parts:
        for first, more in parts:
            done, failed = done + work.last(first) - first, failed + more
            if report:
                report(done, work.count)
    stored = Stored(fs, root, {**record, "complete": True, "failed": failed})
    left = _listing(fs, root)
    missing = [path for paths in stored._files.values() for path in paths if path.rpartition("/")[2] not in left]
    if missing:
        raise StudyError.saying(
            f"workers have written `{missing[0]}`, but the client does not find it: all of them must share the store, a shared "
            "folder, or a URL such as s3://bucket/folder"
        )
    # Partial files of lost workers.
    _remove(fs, root, filter(PARTIAL.fullmatch, left))
    _put(fs, f"{root}/{RECORD}", _json(stored._record))
    return stored


# The store


def _at(store: Store, options: Mapping[str, Any] | None) -> tuple[fsspec.AbstractFileSystem, str]:
    """File system of a store, and its path there."""
    name = files.where(store)
    try:
        fs, root = fsspec.core.url_to_fs(name, **by_name("storage_options", options))
    # An unknown kind of URL, one whose package is not installed, or options that it does not have.
    except (ValueError, ImportError, TypeError) as error:
        raise UsageError.saying(f"`{name}` is not a valid store: {error}") from error
    return fs, root.rstrip("/")


def _path(root: str, table: str, first: int) -> str:
    return f"{root}/{table}-{first:08}.parquet"


def _json(record: dict) -> bytes:
    return (json.dumps(record, indent=2) + "\n").encode()


def _record(fs: fsspec.AbstractFileSystem, root: str) -> dict | None:
    """Metadata of the store."""
    path = f"{root}/{RECORD}"
    try:
        record = json.loads(fs.cat_file(path))
        return record if {"sweep", "digest", "designs", "tables", "failed", "complete"} <= record.keys() else {}
    except FileNotFoundError:
        return None
    except (ValueError, AttributeError):
        return {}


def _begun(fs: fsspec.AbstractFileSystem, root: str, work: _Work, overwrite: bool) -> dict:
    """Record at the store: that of the same sweep, or a new one."""
    names, record = _listing(fs, root), _record(fs, root)
    parts = [name for name in names if NAME.fullmatch(name) or PARTIAL.fullmatch(name)]
    if not overwrite:
        if record and record["sweep"] == work.fingerprint:
            return record
        if record is not None or parts:
            what = _differences(record["sweep"], work.fingerprint) if record else f"unknown, because its `{RECORD}` cannot be read"
            raise StudyError.saying(
                f"`{root}` holds designs of another sweep ({what}); name another store, or call with `overwrite=True` to remove them"
            )
    _remove(fs, root, parts)
    record = {
        "generator": f"hardpoint {__version__}",
        "sweep": work.fingerprint,
        "digest": work.digest,
        "designs": work.count,
        "tables": list(work.tables()),
        "failed": None,
        "complete": False,
    }
    _put(fs, f"{root}/{RECORD}", _json(record))
    return record


def _differences(there: dict, here: dict) -> str:
    """Describes the differences of two sweeps."""

    def flat(known: dict) -> dict:
        return {**{k: v for k, v in known.items() if k != "asked"}, **known["asked"]}

    there, here = flat(there), flat(here)
    words = []
    for name in dict.fromkeys([*there, *here]):
        a, b = there.get(name), here.get(name)
        if a == b:
            continue
        if name in ("model", "files", "designs"):
            words.append({"model": "the text of the model", "files": "a file of the model", "designs": "the list of designs"}[name])
        else:
            words.append(f"`{name}` is {json.dumps(a)} there, {json.dumps(b)} here")
    return "; ".join(words)


def _listing(fs: fsspec.AbstractFileSystem, root: str) -> list[str]:
    """Names of the files at a store, which is created if it does not exist."""
    try:
        fs.makedirs(root, exist_ok=True)
        fs.invalidate_cache(root)
        return [path.rpartition("/")[2] for path in fs.ls(root, detail=False)]
    except OSError as error:
        raise StudyError.saying(f"`{root}` is not a valid store: {error}; name a writable folder, or a URL") from error


def _remove(fs: fsspec.AbstractFileSystem, root: str, names: Iterable[str]) -> None:
    for name in names:
        fs.rm_file(f"{root}/{name}")


def _put(fs: fsspec.AbstractFileSystem, path: str, data: bytes) -> None:
    """Writes a file atomically."""
    folder, _, name = path.rpartition("/")
    beside = f"{folder}/.{name}.{uuid.uuid4().hex}.partial"
    try:
        fs.pipe_file(beside, data)
        fs.mv(beside, path)
    except OSError as error:
        raise StudyError.saying(
            f"`{path}` cannot be written: {error}; the client and all workers must be able to access the store, and it needs free space"
        ) from error


def _bytes(columns: Columns, part_record: dict) -> bytes:
    """Converts a table to a Parquet file: units are in the metadata of the columns, the record of the part in that of the table."""
    arrays = [pyarrow.array(cells) for cells in columns.values()]
    fields = [pyarrow.field(name, cells.type, metadata=_unit(name)) for name, cells in zip(columns, arrays)]
    schema = pyarrow.schema(fields, {"hardpoint": json.dumps(part_record)})
    sink = pyarrow.BufferOutputStream()
    # Numbers hardly repeat: dictionaries would be useless.
    pyarrow.parquet.write_table(pyarrow.table(arrays, schema=schema), sink, compression="zstd", use_dictionary=False)
    return sink.getvalue().to_pybytes()


def _unit(name: str) -> dict[str, str] | None:
    found = re.fullmatch(r".* \[([^\]]+)\]", name)
    return {"unit": found[1]} if found else None


def _part_record(metadata: pyarrow.parquet.FileMetaData) -> dict:
    return json.loads((metadata.metadata or {}).get(b"hardpoint", b"{}"))


def _known(fs: fsspec.AbstractFileSystem, path: str) -> dict:
    """Metadata of a part; `None` if there is none, or an incomplete one."""
    try:
        with fs.open(path, "rb") as file:
            return _part_record(pyarrow.parquet.read_metadata(file))
    except (OSError, pyarrow.ArrowException, ValueError):
        return {}
