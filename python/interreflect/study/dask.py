"""A study on many machines: its cells as tasks of Dask distributed, each measured in a worker process of the host that gets it."""

from __future__ import annotations

import collections
import dataclasses
import time
import uuid
from typing import Any

from interreflect.study.messages import Phase, Pictures, Reply, Request
from interreflect.study.plan import Plan
from interreflect.study.records import FAILED
from interreflect.study.workers import Crew, Limits

LOST = ("cancelled", "lost")  # states of a task whose scene went away with the process that held it
GLANCE = 0.01  # seconds between looks at the tasks
Answer = tuple[Reply, list[Pictures]]
TRIES = 3  # with the scene sent anew, before a cell counts as failed


def measure_on(client: Any, plan: Plan) -> None:
    """Measure the open cells on the hosts of a `distributed.Client`: timed ones alone on a host, untimed ones one a thread.

    A process of the cluster that dies costs its cell another try, as often as the cluster allows; then the cell is a row that says
    so. Without hosts the study waits for some.
    """
    _Dispatch(client, plan).run()


class _Dispatch:
    """The tasks under way."""

    def __init__(self, client: Any, plan: Plan) -> None:
        self.client, self.plan, self.name = client, plan, uuid.uuid4().hex
        self.timed = plan.study.repeats > 0
        self.scenes: dict[str, Any] = {}  # hash -> future of the pickled scene
        self.under_way: dict[Any, tuple[int, str, str]] = {}  # task -> cell, address of the process, host
        self.tries: collections.Counter[int] = collections.Counter()

    def run(self) -> None:
        """KeyboardInterrupt and other ends take the cells under way along."""
        cells, more = self.plan.open_cells(), True
        with self.plan.progress() as progress:
            try:
                while more or self.under_way:
                    more = more and self._fill(cells, progress)
                    self._collect()
                    progress.update(self.plan.settled - progress.n)
            finally:
                self.client.cancel([*self.under_way, *self.scenes.values()])
                if self.under_way:
                    self.client.run(end_cells, self.name, on_error="ignore")

    def _fill(self, cells: Any, progress: Any) -> bool:
        """Give every process with room a cell; False where none is left."""
        while address := self._free_process():
            index = next(cells, -1)
            if index is None:
                progress.set_postfix_str("waiting for cells of another run")
                return True
            if index < 0:
                return False
            progress.set_postfix_str(self.plan.title(index))
            self._submit(index, address)
        return True

    def _free_process(self) -> str:
        """Address of a process of the cluster with room for one more cell; "" where there is none."""
        busy = collections.Counter(address for _, address, _ in self.under_way.values())
        taken = {host for _, _, host in self.under_way.values()} if self.timed else set()
        free = (at for at, worker in self._workers().items() if worker["host"] not in taken and busy[at] < worker["nthreads"])
        return next(free, "")

    def _workers(self) -> dict[str, dict[str, Any]]:
        return dict(self.client.scheduler_info(n_workers=-1)["workers"])

    def _submit(self, index: int, address: str) -> None:
        """Where the process ends, another may take the cell; by itself the scheduler would heap cells where the scene lies."""
        scene = self.plan.cells[index].scene.hash
        if scene not in self.scenes:
            for past in self.scenes.values():
                past.release()
            self.scenes = {scene: self.client.scatter(self.plan.scene_of(index)(), hash=False)}
        task = self.client.submit(
            measure_there,
            self.plan.request(index),
            self.scenes[scene],
            self.plan.limits,
            self.name,
            pure=False,
            workers=[address],
            allow_other_workers=True,
        )
        self.under_way[task] = (index, address, self._workers().get(address, {}).get("host", ""))

    def _collect(self) -> None:
        """Keep what is done; waits a little where nothing is."""
        done = [task for task in self.under_way if task.done()]
        if not done:
            time.sleep(GLANCE)
        for task in done:
            index, address, _ = self.under_way.pop(task)
            if task.status in LOST and (self.tries.update([index]) or self.tries[index] < TRIES):
                self.scenes.pop(self.plan.cells[index].scene.hash, None)
                self._submit(index, address)
            else:
                reply, pictures = _answer(task)
                for kept in pictures:
                    self.plan.keep_pictures(index, kept)
                self.plan.keep(index, reply)


_crews: dict[str, set[Crew]] = collections.defaultdict(set)  # name of a run -> its cells under way in this process
_ended: set[str] = set()  # names of runs


def end_cells(run: str) -> None:
    """Called in every process of the cluster when a run ends before its cells."""
    _ended.add(run)
    for crew in list(_crews[run]):
        crew.interrupt()


def measure_there(request: Request, scene: bytes, limits: Limits, run: str) -> Answer:
    """The task: measure a cell on this host, and say what host it is."""
    from interreflect.machine import about

    told: list[Phase | Pictures] = []
    with Crew() as crew:
        _crews[run].add(crew)
        try:
            reply = Reply({}, interrupted=True) if run in _ended else crew.measure(request, lambda: scene, limits, told.append)
        finally:
            _crews[run].discard(crew)
    here = {"machine": about().asdict(), "threads": request.threads or about().threads}
    return dataclasses.replace(reply, changes=here | reply.changes), [message for message in told if isinstance(message, Pictures)][-1:]


def _answer(task: Any) -> Answer:
    """What the task answered. The cell's failure where the cluster gave it up; RuntimeError where its host cannot measure at all."""
    if task.status == "finished":
        return task.result()  # type: ignore[no-any-return]
    error = task.exception() if task.status == "error" else None
    if error is None or isinstance(error, _distributed().KilledWorker):
        return Reply({"status": FAILED, "failure": f"the cluster gave the cell up: {error or task.status}"}), []
    raise RuntimeError(f"a host of the cluster cannot measure: {error}") from error


def connect(address: str) -> Any:
    """A client of the scheduler at an address such as tcp://10.0.0.1:8786. OSError where nobody answers."""
    return _distributed().Client(address, timeout=10)


def check_client(client: Any) -> None:
    """TypeError for what is no client, ImportError without the extra."""
    if not isinstance(client, _distributed().Client):
        raise TypeError(f"client must be a distributed.Client, got {type(client).__name__}")


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise ImportError("studies on a cluster need the extra `distributed`: pip install interreflect[distributed]") from error
    return distributed
