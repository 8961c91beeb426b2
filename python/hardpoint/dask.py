"""Sweeps, Monte Carlo and searches from many starts, on the workers of dask.distributed (`pip install 'hardpoint[dask]'`).

    >>> from distributed import Client
    >>> import hardpoint, hardpoint.dask
    >>> model = hardpoint.read("models/studies/strut_sweep.toml")
    >>> with Client() as client:
    ...     done = hardpoint.dask.sweep(model, client, "results/strut", samples=100_000)
    >>> done.read()                                                 # a table of Arrow, in order of designs

`docs/scaling.md` says what travels, what becomes of lost workers and interrupted runs, and where it ends.
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

from . import __version__
from .errors import StudyError, UsageError
from .model import Model, Progress, listener
from .studies import Study, outcome

if TYPE_CHECKING:
    import numpy as np

__all__ = ["Searches", "Stored", "monte_carlo", "multi_start", "opened", "sweep"]

Store = Union[str, "os.PathLike[str]"]
"""A folder, or any URL of fsspec (`s3://bucket/sweep`), that the client and all workers reach."""
Columns = Mapping[str, Any]
"""Cells by the names of columns, units in brackets behind."""

PART = 8192
"""That many designs are a part, where nothing is said."""
BLOCK = 512
"""Number of designs in a block; parts begin with a block, so that their last bits do not depend on the partition."""
AHEAD = 3
"""That many tasks are under way for each thread of the workers: one is solved, the others wait beside it."""
PATIENCE = 600.0
"""Seconds in which no task ends and no worker is at one, after which a sweep ends with an error."""
LOOK = 1.0
"""Seconds between two checks of the states of futures."""
ASK = 10.0
"""Seconds between two queries of the scheduler for busy workers, while nothing ends."""
ANSWER = 30.0
"""Seconds in which the scheduler must answer; otherwise it is asked again."""
ENDED = ("finished", "error", "cancelled")
"""States of futures that have ended. The data of one that is `lost` is made anew."""
RECORD = "sweep.json"
NAME = re.compile(r"(?P<table>designs|curves)-(?P<first>\d{8,})\.parquet")
PARTIAL = re.compile(r"\.(designs|curves)-\d{8,}\.parquet\.[0-9a-f]{32}\.partial")


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
    """Solves the designs of `model.sweep(**asked)` on the workers of `client`, and keeps them at `store`: in parts of `part` designs,
    `designs-00000000.parquet` with the number of its first design, and likewise `curves-` where `curves` are requested. The numbers are
    those of `model.sweep`, bit for bit.

    Called again after an interruption it goes on: parts that are there and whole are not solved again. A store that holds anything
    else is refused; `overwrite` empties it first. `progress` is reported designs. Raises `StudyError` when for `patience` seconds no part has
    ended and no worker was at work; `math.inf` waits for workers however long they take to come.
    """
    listed = asked.pop("designs", None)
    asked = json.loads(json.dumps({name: value for name, value in asked.items() if value is not None}, default=_plain))
    count = model.sweep_plan(**asked, **({} if listed is None else {"designs": listed})).count
    listed = None if listed is None else (Path(listed).name, Path(listed).read_bytes())
    return _stored(_Sweep(model, count, part, asked, listed), client, store, overwrite, progress, patience, storage_options)


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
    """Solves designs that are drawn within the tolerances, those of `model.tolerance(samples=samples, seed=seed)`, in every case, and
    keeps their variables and metrics as `sweep` does. `seed` is that of the model file, if none is given.
    """
    if samples < 1:
        raise UsageError.saying("there is no design to be solved; give at least one sample")
    _drawn(model, [0], seed)
    return _stored(_Drawn(model, int(samples), part, seed), client, store, overwrite, progress, patience, storage_options)


class Searches(NamedTuple):
    """Searches from several starts."""

    best: Study
    """The best of them, as `model.optimize` chooses: of those that keep all limits the one with the least objective, of others the one
    that exceeds them least."""
    studies: tuple[Study, ...]
    """All of them, in order of starts; that of number 0 starts from the nominal design."""


def multi_start(
    model: Model,
    client: Client,
    starts: int,
    iterations: int | None = None,
    *,
    progress: Progress = None,
    patience: float = PATIENCE,
) -> Searches:
    """Searches for the best design (`model.optimize`) from several starts, each on a worker. `progress` is reported searches."""
    if starts < 1:
        raise UsageError.saying("there is nothing to start from; give at least one start")
    _check(client)
    told, found = listener(progress), {}
    with closing(_each(client, _search, _Search(model, iterations), range(starts), lambda first: f"start {first}", patience)) as searches:
        for first, search in searches:
            found[first] = outcome(model, *search)
            if told:
                told(len(found), starts)
    studies = tuple(found[first] for first in range(starts))
    return Searches(studies[_best([study.facts for study in studies])], studies)


def opened(store: Store, storage_options: Mapping[str, Any] | None = None) -> Stored:
    """Results of `sweep` or `monte_carlo` in a store."""
    fs, root = _at(store, storage_options)
    record = _record(fs, root)
    if record is None or not record["complete"]:
        why = f"the sweep at `{root}` is not complete; call it again as before" if record else f"there is no sweep at `{root}`"
        raise StudyError.saying(why)
    return Stored(fs, root, record)


class Stored:
    """Designs that have been solved, at a store."""

    def __init__(self, fs: fsspec.AbstractFileSystem, root: str, record: dict):
        self._fs = fs
        self._record = record
        self.store: str = fs.unstrip_protocol(root)
        """Location as a URL."""
        firsts = range(0, record["designs"], record["sweep"]["part"])
        self._files = {table: tuple(_path(root, table, first) for first in firsts) for table in record["tables"]}
        self.parts: tuple[str, ...] = self._files["designs"]
        """The files of designs, in order."""
        self.designs: int = record["designs"]
        """Number of designs."""
        self.failed: int = record["failed"]
        """Number of designs that do not move to their end; the column `failed` has the reasons."""

    def __len__(self) -> int:
        return self.designs

    def __repr__(self) -> str:
        failed = f", {self.failed} of them failed" if self.failed else ""
        return f"<hardpoint.dask.Stored at {self.store}: {self.designs} designs in {len(self.parts)} parts{failed}>"

    def read(self, table: str = "designs") -> pyarrow.Table:
        """The table of `designs`, or that of `curves`, in order of designs: all of it, in memory."""
        found = []
        for path in self._of(table):
            with self._fs.open(path, "rb") as file:
                one = pyarrow.parquet.ParquetFile(file)
                if _told(one.metadata).get("sweep") != self._record["digest"]:
                    raise StudyError.saying(f"`{path}` is of another sweep; call `sweep` again, which solves it anew")
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
    raise UsageError.saying(f"a sweep is requested with numbers, texts, lists and dictionaries; {value!r} is none of them")


# What is solved


class _Work:
    """Task data. They are sent to each worker once, and planned there once."""

    study: str

    def __init__(self, model: Model, count: int, part: int, asked: dict):
        if part < BLOCK or part % BLOCK:
            near = max(1, round(part / BLOCK)) * BLOCK
            raise UsageError.saying(f"designs are solved in blocks of {BLOCK}, and a part of {part} would cut one; give `part={near}`")
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
        """All that the numbers depend on, as JSON has it."""
        self.digest: str = digest(json.dumps(self.fingerprint, sort_keys=True))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Work) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def last(self, first: int) -> int:
        """End of the part that begins there."""
        return min(first + self.part, self.count)

    def tables(self) -> tuple[str, ...]:
        """The names of the tables, in the order in which they are written."""
        return ("designs",)

    def plan(self) -> Any:
        """Data for any part."""

    def solve(self, plan: Any, first: int, last: int) -> dict[str, Columns]:
        """The tables of some designs."""
        raise NotImplementedError


_planning = threading.Lock()


@lru_cache(maxsize=4)
def _plan(work: _Work) -> Any:
    """The plan of a work; of one that is sent again it is the same."""
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
    """The name of a column, as in the tables of the command line."""
    return name if unit in ("", "1") else f"{name} [{unit}]"


def _drawn(model: Model, numbers: list[int], seed: int | None) -> np.ndarray:
    """Designs of a tolerance study by their numbers, `[design, variable]`, in the model's units."""
    return model._native.drawn_designs(numbers, seed)


class _Search(NamedTuple):
    model: Model
    iterations: int | None


def _search(asked: _Search, first: int) -> tuple[str, list[float] | None, list[float] | None]:
    """The search from a start: its outcome as JSON, the design found with its numbers rounded, and as it is."""
    return asked.model._native.optimize(first, 1, asked.iterations, 1, None)


KEPT = 1e-8
"""A limit that is exceeded by less of its scale is kept; as the engine has it."""
THE_SAME = 1e-12
"""Objectives that differ by less of themselves are as good; then the one nearer to an optimum counts."""


def _best(found: list[dict]) -> int:
    """The place of the best of some searches, by their facts."""

    def rank(facts: dict) -> tuple[bool, float]:
        objective, violation = facts["objective"]["after"], facts["violation"]["after"]
        if objective is None or violation is None:
            return True, float("inf")
        return (False, objective) if violation <= KEPT else (True, violation)

    ranks = [rank(facts) for facts in found]
    exceeds, least = min(ranks)
    as_good = [k for k, (e, value) in enumerate(ranks) if e == exceeds and (value == least or value - least <= THE_SAME * abs(least))]
    return min(as_good, key=lambda k: float("inf") if found[k]["kkt"] is None else found[k]["kkt"])


# Tasks


def _check(client: Client) -> None:
    if client.asynchronous:
        raise UsageError.saying("the client is asynchronous; give one that `Client(...)` makes outside of coroutines")


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
    """`work(shared, number)` of each number, as they end.

    What is shared is the outcome of a task: it goes to each worker once, from another that has it, and is made anew if all that had
    it are lost. As many tasks are under way as the workers that there are can have beside them.

    A task that has ended is announced by a callback on the event loop of this client; `distributed.as_completed` would by default
    wait on that of the client that was made last, whose thread misses wake-ups of this one. The states of futures are looked at
    every so often all the same, so that no announcement has to arrive.
    """
    name = f"hardpoint-{uuid.uuid4().hex}"
    here = client.submit(_itself, shared, key=f"{name}-model")
    waiting, under_way = iter(numbers), {}
    ended: SimpleQueue[Future] = SimpleQueue()
    watch = _Watch(client, patience)
    room = since = 0
    try:
        while True:
            # Workers come and go.
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
            # What the caller has done meanwhile does not count.
            watch.one_ended()
    finally:
        # What has not begun is dropped.
        for future in [*under_way, here]:
            future.release()


def _next(ended: SimpleQueue[Future], under_way: Mapping[Future, int]) -> Future | None:
    """A task that has ended; nothing if none does for a while."""
    try:
        future = ended.get(timeout=LOOK)
        return future if future in under_way else None
    except Empty:
        return next((future for future in under_way if future.status in ENDED), None)


def _result(future: Future, named: str) -> tuple[Any] | None:
    """Result of a task; None if it is not available now: its worker was lost, or the scheduler does not answer."""
    try:
        return (future.result(timeout=ANSWER),)
    except KilledWorker as error:
        raise StudyError.saying(
            f"{named}: {error.allowed_failures + 1} workers were lost over it, the last at {error.last_worker.address}; perhaps they have too "
            "little memory: give smaller parts or fewer threads to each, then call it again"
        ) from error
    except CancelledError as error:
        raise StudyError.saying(f"{named}: the cluster has dropped it ({error}); call it again, it goes on from what is done") from error
    except (OSError, TimeoutError):
        # That of the task itself is an answer.
        if future.status == "error":
            raise
        return None


class _Watch:
    """Ends the wait for tasks that nobody works at."""

    def __init__(self, client: Client, patience: float):
        self._client = client
        self._patience = patience
        self._since = self._asked = time.monotonic()

    def threads(self) -> int:
        """The threads of all workers; none if the scheduler does not answer."""
        try:
            return sum(self._client.nthreads(callback_timeout=ANSWER).values())
        except (OSError, TimeoutError):
            return 0

    def one_ended(self) -> None:
        """A task has ended."""
        self._since = time.monotonic()

    def nothing_ended(self, named: str) -> None:
        """No task has ended for a while. Raises when none has for so long, with no worker at any task meanwhile."""
        now = time.monotonic()
        if now - self._asked < min(ASK, self._patience):
            return
        self._asked = now
        workers, busy = self._at_work()
        if busy:
            self._since = now
        elif now - self._since >= self._patience:
            has = "does not answer" if workers is None else "has no workers" if workers == 0 else f"has {workers} workers, and none works at a task"
            raise StudyError.saying(
                f"{named}: no task has ended for {self._patience:g} s, and the cluster {has}; see whether its scheduler and workers run, "
                "then call it again, it goes on from what is done; `patience` is how many seconds it waits"
            )

    def _at_work(self) -> tuple[int | None, bool]:
        """Number of workers, if the scheduler answers, and whether any of them works at a task, by their last report."""
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
    """Solves a part, unless it is there; how many of its designs failed."""
    work, last = asked.work, asked.work.last(first)
    told = {"sweep": work.digest, "first": first, "last": last}
    paths = {table: _path(asked.root, table, first) for table in work.tables()}
    known = [_known(asked.fs, path) for path in paths.values()]
    if all(one == {**told, "failed": known[0].get("failed")} for one in known):
        return known[0]["failed"]
    with _planning:
        plan = _plan(work)
    tables = work.solve(plan, first, last)
    told["failed"] = sum(1 for why in tables["designs"]["failed"] if why)
    for table, path in paths.items():
        _put(asked.fs, path, _bytes(tables[table], told))
    return told["failed"]


def _stored(
    work: _Work,
    client: Client,
    store: Store,
    overwrite: bool,
    progress: Progress,
    patience: float,
    storage_options: Mapping[str, Any] | None,
) -> Stored:
    _check(client)
    fs, root = _at(store, storage_options)
    record = _begun(fs, root, work, overwrite)
    told, done, failed = listener(progress), 0, 0
    named = lambda first: f"designs {first} to {work.last(first) - 1}"  # noqa: E731
    with closing(_each(client, _solve, _Part(work, fs, root), range(0, work.count, work.part), named, patience)) as parts:
        for first, more in parts:
            done, failed = done + work.last(first) - first, failed + more
            if told:
                told(done, work.count)
    stored = Stored(fs, root, {**record, "complete": True, "failed": failed})
    left = _listing(fs, root)
    missing = [path for paths in stored._files.values() for path in paths if path.rpartition("/")[2] not in left]
    if missing:
        raise StudyError.saying(
            f"workers have written `{missing[0]}`, and the client does not find it: a store must be one place for all of them, a shared "
            "folder, or a URL such as s3://bucket/folder"
        )
    # What workers had in hand when they were lost.
    _remove(fs, root, filter(PARTIAL.fullmatch, left))
    _put(fs, f"{root}/{RECORD}", _json(stored._record))
    return stored


# The store


def _at(store: Store, options: Mapping[str, Any] | None) -> tuple[fsspec.AbstractFileSystem, str]:
    """The file system of a store, and its path there."""
    fs, root = fsspec.core.url_to_fs(os.fspath(store), **(options or {}))
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
    """The record at the store: that of the same sweep, or a new one."""
    names, record = _listing(fs, root), _record(fs, root)
    parts = [name for name in names if NAME.fullmatch(name) or PARTIAL.fullmatch(name)]
    if not overwrite:
        if record and record["sweep"] == work.fingerprint:
            return record
        if record is not None or parts:
            what = _differences(record["sweep"], work.fingerprint) if record else f"nobody knows of which: its `{RECORD}` cannot be read"
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
    """In what two sweeps differ, in words."""

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
    """The names of the files at a store, which is made if it is not there."""
    try:
        fs.makedirs(root, exist_ok=True)
        fs.invalidate_cache(root)
        return [path.rpartition("/")[2] for path in fs.ls(root, detail=False)]
    except OSError as error:
        raise StudyError.saying(f"`{root}` is no store: {error}; name a folder that can be written, or a URL") from error


def _remove(fs: fsspec.AbstractFileSystem, root: str, names: Iterable[str]) -> None:
    for name in names:
        fs.rm_file(f"{root}/{name}")


def _put(fs: fsspec.AbstractFileSystem, path: str, data: bytes) -> None:
    """Writes a file, whole or not at all."""
    folder, _, name = path.rpartition("/")
    beside = f"{folder}/.{name}.{uuid.uuid4().hex}.partial"
    try:
        fs.pipe_file(beside, data)
        fs.mv(beside, path)
    except OSError as error:
        raise StudyError.saying(
            f"`{path}` cannot be written: {error}; the store must be one that the client and all workers reach, with room for it"
        ) from error


def _bytes(columns: Columns, told: dict) -> bytes:
    """A table as a file of Parquet: units are in the metadata of columns, what the part is in that of the table."""
    arrays = [pyarrow.array(cells) for cells in columns.values()]
    fields = [pyarrow.field(name, cells.type, metadata=_unit(name)) for name, cells in zip(columns, arrays)]
    schema = pyarrow.schema(fields, {"hardpoint": json.dumps(told)})
    sink = pyarrow.BufferOutputStream()
    # Hardly a number comes twice: dictionaries would only be in the way.
    pyarrow.parquet.write_table(pyarrow.table(arrays, schema=schema), sink, compression="zstd", use_dictionary=False)
    return sink.getvalue().to_pybytes()


def _unit(name: str) -> dict[str, str] | None:
    found = re.fullmatch(r".* \[([^\]]+)\]", name)
    return {"unit": found[1]} if found else None


def _told(metadata: pyarrow.parquet.FileMetaData) -> dict:
    return json.loads((metadata.metadata or {}).get(b"hardpoint", b"{}"))


def _known(fs: fsspec.AbstractFileSystem, path: str) -> dict:
    """Metadata of a part; None if there is none, or an incomplete one."""
    try:
        with fs.open(path, "rb") as file:
            return _told(pyarrow.parquet.read_metadata(file))
    except (OSError, pyarrow.ArrowException, ValueError):
        return {}
