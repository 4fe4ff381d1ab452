"""Worker processes: a cell that crashes, hangs or eats the memory takes its worker along, never the study.

A worker is `python -m interreflect._worker`, a fresh interpreter, so it starts from anywhere: scripts without a `__main__` guard,
notebooks, threads, Dask. It stays for the next cell and the next study, as long as no file of its modules changes.
"""

from __future__ import annotations

import atexit
import dataclasses
import fcntl
import io
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from interreflect.study.calibration import Calibration
from interreflect.study.memory import resident_bytes
from interreflect.study.messages import Go, Phase, Pictures, Ready, Reply, Request, Surroundings, receive, send
from interreflect.study.records import FAILED

PACKAGES = str(Path(__file__).resolve().parents[2])  # the folder that holds the package
GLANCE = 0.01  # seconds between looks at a worker's memory: at 5 GB/s of fresh pages, 50 MB too much
PIPE_BYTES = 2**20  # pictures of 43,000 pixels go without waiting for their reader; the most that Linux permits everybody
GO = "go"  # the phase that waits for the parent
THE_CELLS = ("prepare", "render")  # phases that count for its limits
Show = Callable[[Phase | Pictures], None]
FROM_OUTSIDE = {signal.SIGKILL, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGINT}  # signals that no method's fault sends


@dataclasses.dataclass(frozen=True)
class Limits:
    """timeout: seconds for a cell, without its truth and its waiting. memory: bytes that a worker may hold more than an idle one."""

    timeout: float | None = None
    memory: float | None = None


class Lost(Exception):
    """A worker is gone, and its cell with it. limits: what it passed. outside: somebody ended it, not its own fault."""

    def __init__(self, reason: str, limits: dict[str, float] | None = None, outside: bool = False) -> None:
        super().__init__(reason)
        self.limits, self.outside = limits or {}, outside


class Worker:
    """One worker process and its pipes."""

    def __init__(self) -> None:
        self.scene = ""  # key of the scene that it holds
        self._idle = -1  # bytes that it holds without a scene; unknown until it is ready
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  what it writes to standard error, as long as it lives
        fcntl.fcntl(self._said, fcntl.F_SETFL, os.O_APPEND)
        theirs, self._lifeline = os.pipe()
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "interreflect._worker", str(theirs)], env=os.environ | {"PYTHONPATH": PACKAGES},
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said, pass_fds=[theirs], bufsize=0,
        )  # fmt: skip
        os.close(theirs)
        assert self._process.stdin is not None and self._process.stdout is not None
        self._requests = io.BufferedWriter(self._process.stdin)
        self._replies = self._process.stdout  # without a buffer, where a message could lie that poll does not see
        with suppress(OSError):  # the system may permit less
            fcntl.fcntl(self._replies, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        with suppress(BrokenPipeError):  # it ended at once; `wait_until_ready` says why
            send(self._requests, _surroundings())

    def wait_until_ready(self) -> None:
        """RuntimeError where it does not start."""
        if self._idle >= 0:
            return
        try:
            ready: Ready = receive(self._replies)
        except EOFError:
            raise RuntimeError(f"no worker process could be started: {self._ended()}") from None
        self._idle = ready.idle

    def usable(self) -> bool:
        """May it go on, in the surroundings of now? Not if it ended, or a module's file has changed since it was loaded."""
        try:
            send(self._requests, _surroundings())
            ready: Ready = receive(self._replies)
        except (EOFError, BrokenPipeError):
            return False
        return ready.fresh

    def measure(self, request: Request, limits: Limits, show: Show) -> Reply:
        """The reply to a request. Lost where the process ended, or was ended because it passed a limit."""
        self.wait_until_ready()
        try:
            send(self._requests, request)
            reply = self._reply(limits, show)
        except (EOFError, BrokenPipeError):
            raise self._ended() from None
        self.scene = request.scene_key
        return reply

    def kill(self) -> None:
        """End the process, whatever it is doing; who waits for its reply hears of it."""
        self._process.kill()

    def close(self) -> None:
        """End the process, and what belongs to it."""
        self.kill()
        self._process.wait()
        for stream in (self._requests, self._replies):
            with suppress(OSError):  # what could not be sent any more
                stream.close()
        if not self._said.closed:
            self._said.close()
            os.close(self._lifeline)

    def printed(self) -> str:
        """What was written to standard error since the last call."""
        text = os.pread(self._said.fileno(), os.fstat(self._said.fileno()).st_size, 0)
        if text:
            self._said.truncate(0)
        return text.decode(errors="replace")

    def _reply(self, limits: Limits, show: Show) -> Reply:
        answer = select.poll()
        answer.register(self._replies.fileno(), select.POLLIN)
        left, phase, before = limits.timeout, "", time.monotonic()
        while True:
            own = limits if phase in THE_CELLS else Limits()
            answered = bool(answer.poll(_patience(left if own.timeout else None, own)))
            now = time.monotonic()
            if left is not None and own.timeout:
                left -= now - before
                if left <= 0 and not answered:
                    raise Lost(f"timeout: not done after {own.timeout:g} s", {"timeout": own.timeout})
            before = now
            if own.memory is not None:
                check_memory(resident_bytes(self._process.pid) - self._idle, own)
            if answered:
                message = receive(self._replies)
                if isinstance(message, Reply):
                    return message
                show(message)
                if isinstance(message, Phase):
                    phase = message.name
                if phase == GO:
                    send(self._requests, Go())
                    phase = "render"

    def _ended(self) -> Lost:
        """Why the process ended."""
        code = self._process.wait()
        last = self.printed().strip().rpartition("\n")[2]
        how = f"ended with exit code {code}" if code >= 0 else f"was ended by {signal.Signals(-code).name}"
        return Lost(f"the worker process {how}{': ' if last else ''}{last}", outside=-code in FROM_OUTSIDE)


def check_memory(held: float, limits: Limits) -> None:
    """Lost where a worker holds more than it may."""
    if limits.memory is not None and held > limits.memory:
        raise Lost(f"memory: {held / 2**20:.0f} MiB, at most {limits.memory / 2**20:.0f} MiB", {"memory": limits.memory})


class Crew:
    """`with Crew() as crew`: one worker, replaced when it is lost."""

    def __init__(self) -> None:
        self._worker: Worker | None = None
        self._calibration: Calibration | None = None  # once a study, however many workers it takes
        self._interrupted = False

    def __enter__(self) -> Crew:
        with suppress(IndexError):  # no more of them
            while self._worker is None:
                worker = _resting.pop()
                if worker.usable():
                    self._worker = worker
                else:
                    worker.close()
        self._worker = self._worker or Worker()
        return self

    def __exit__(self, kind: Any, *_: object) -> None:
        if self._worker is None:
            return
        if kind is None:
            _resting.append(self._worker)
        else:  # it may be in the middle of a cell
            self._worker.close()

    def measure(self, request: Request, scene: Callable[[], bytes], limits: Limits, show: Show) -> Reply:
        """Measure a cell. What takes the worker along becomes the record's failure; ended from outside, the cell is tried once more.

        scene: pickles the request's scene, called where the worker does not hold it. show: told of every phase, and given the
        pictures; the clock starts after it has returned from "go".
        """
        for again in (True, False):
            try:
                return self._try(request, scene, limits, show)
            except Lost as lost:
                self._end()
                if self._interrupted:
                    return Reply({}, interrupted=True)
                if not (lost.outside and again):
                    return Reply({"status": FAILED, "failure": str(lost), "limits": lost.limits})
        raise AssertionError

    def interrupt(self) -> None:
        """End the cell that another thread measures."""
        self._interrupted, worker = True, self._worker
        if worker is not None:
            worker.kill()

    def _try(self, request: Request, scene: Callable[[], bytes], limits: Limits, show: Show) -> Reply:
        self._worker = self._worker or Worker()
        if self._interrupted:  # before there was a worker to end
            raise Lost("interrupted")
        given = None if self._worker.scene == request.scene_key else scene()
        request = dataclasses.replace(request, scene=given, calibration=self._calibration)
        reply = self._worker.measure(request, limits, show)
        self._calibration = reply.calibration or self._calibration
        if text := self._worker.printed():
            from tqdm import tqdm

            tqdm.write(text, file=sys.stderr, end="")
        check_memory(reply.changes.get("peak_memory_bytes", 0), limits)
        return reply

    def _end(self) -> None:
        if self._worker is not None:
            self._worker.close()
            self._worker = None


_resting: list[Worker] = []  # idle workers, for the next study


@atexit.register
def _end_resting() -> None:
    while _resting:
        _resting.pop().close()


def _surroundings() -> Surroundings:
    return Surroundings(list(sys.path), dict(os.environ), os.getcwd())


def _patience(left: float | None, limits: Limits) -> float | None:
    """Milliseconds to wait for an answer; None: as long as it takes."""
    times = [time for time in (left, GLANCE if limits.memory is not None else None) if time is not None]
    return 1e3 * max(min(times), 0) if times else None
