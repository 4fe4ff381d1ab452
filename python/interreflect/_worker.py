"""A worker process: `python -m interreflect._worker LIFELINE` measures the cells that its parent sends through standard input.

It ends when its parent does, even in the middle of a cell that never ends: LIFELINE is the number of a pipe's reading end whose other
end only the parent holds, and the kernel signals its closing. Interrupts are the parent's to answer.
"""

from __future__ import annotations

import fcntl
import os
import select
import signal
import sys
import time
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from interreflect.study.messages import Surroundings


def main(lifeline: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _end_with(lifeline)
    requests, replies = _pipes()
    started = time.time()
    from interreflect.study.messages import Ready, Request, Surroundings, receive, send

    _enter(receive(requests))
    from interreflect.study.measure import Bench

    bench = Bench(say=lambda phase: send(replies, phase), await_go=lambda: receive(requests))
    send(replies, Ready(True, bench.idle))
    while True:
        message = receive(requests)
        if isinstance(message, Surroundings):
            bench.forget_truths()  # their cache may be another one now
            _enter(message)
            send(replies, Ready(_unchanged_since(started), bench.idle))
        elif isinstance(message, Request):
            send(replies, bench.measure(message))


def _enter(surroundings: Surroundings) -> None:
    sys.path[:] = surroundings.path
    os.environ.clear()
    os.environ.update(surroundings.environment)
    os.chdir(surroundings.folder)


def _end_with(lifeline: int) -> None:
    """Let SIGIO, whose default is to end the process, come when the pipe closes. Unlike PR_SET_PDEATHSIG this is not bound to a thread."""
    fcntl.fcntl(lifeline, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(lifeline, fcntl.F_SETFL, fcntl.fcntl(lifeline, fcntl.F_GETFL) | os.O_ASYNC)
    closed = select.poll()
    closed.register(lifeline, 0)
    if closed.poll(0):  # before the signal was asked for
        os._exit(0)


def _pipes() -> tuple[IO[bytes], IO[bytes]]:
    """Requests and replies; what methods print goes to standard error, and they have no input."""
    requests, replies = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    return requests, replies


def _unchanged_since(moment: float) -> bool:
    """Is no file of a loaded module younger than `moment` (seconds since 1970), or gone?"""
    for module in list(sys.modules.values()):
        path = getattr(module, "__file__", None)
        try:
            if path and os.stat(path).st_mtime >= moment:
                return False
        except OSError:
            return False
    return True


if __name__ == "__main__":
    try:
        main(int(sys.argv[1]))
    except (EOFError, BrokenPipeError):
        os._exit(0)
