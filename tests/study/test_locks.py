"""Who may do what now."""

import threading
import time

import pytest

from interreflect.study.locks import Claims, machine


@pytest.fixture(autouse=True)
def locks(tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_LOCKS", str(tmp_path))


def together(*alone, hold=0.1):
    """The most that were in the machine at once, of those who came at the same time."""
    inside, most, lock = [], [0], threading.Lock()

    def come(alone):
        with machine(alone):
            with lock:
                inside.append(alone)
                most[0] = max(most[0], len(inside))
            time.sleep(hold)
            with lock:
                inside.remove(alone)

    threads = [threading.Thread(target=come, args=(kind,)) for kind in alone]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return most[0]


def test_who_is_timed_is_alone():
    assert together(True, True, True) == 1
    assert together(True, False) == 1


def test_what_is_not_timed_goes_side_by_side():
    assert together(False, False, False) == 3


def test_who_wants_to_be_alone_is_not_kept_waiting_by_those_who_come_later():
    order, first_is_in = [], threading.Event()

    def come(name, alone, hold):
        with machine(alone):
            first_is_in.set()
            order.append(name)
            time.sleep(hold)

    first = threading.Thread(target=come, args=("first", False, 0.3))
    first.start()
    first_is_in.wait()
    alone = threading.Thread(target=come, args=("alone", True, 0))
    alone.start()
    time.sleep(0.1)  # until it waits
    late = threading.Thread(target=come, args=("late", False, 0))
    late.start()
    for thread in (first, alone, late):
        thread.join()
    assert order == ["first", "alone", "late"]


def test_a_wait_is_told_and_only_a_wait():
    told = []
    with machine(True, waiting=lambda: told.append("too early")):
        assert not told
        other = threading.Thread(target=lambda: machine(False, waiting=lambda: told.append("waits")).__enter__())
        other.start()
        time.sleep(0.1)
        assert told == ["waits"]
    other.join(5)
    assert not other.is_alive()


def test_a_claim_holds_until_it_is_left_or_its_run_ends(tmp_path):
    ours, theirs = Claims(tmp_path), Claims(tmp_path)
    assert ours.take("a" * 32) and ours.take("b" * 32)
    assert not theirs.take("a" * 32)
    assert theirs.take("c" * 32)
    ours.leave("a" * 32)
    assert theirs.take("a" * 32)
    assert not theirs.take("b" * 32)
    ours.close()
    assert theirs.take("b" * 32)
