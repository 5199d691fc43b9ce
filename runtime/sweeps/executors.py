"""Where batches run: in this process, on local processes, or on a Dask cluster."""

import contextlib
import logging
import os
import signal
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from typing import Any

from ..errors import HystripError
from ..extras import require
from ..inputs.checks import integer


class InProcess(Executor):
    """Runs what is submitted at once, here."""

    def submit(self, function: Any, /, *arguments: Any, **options: Any) -> Future:
        """Run and return a finished future."""
        future: Future = Future()
        try:
            future.set_result(function(*arguments, **options))
        except Exception as error:
            future.set_exception(error)
        return future


_ENDING = {signal.SIGINT, signal.SIGTERM}


class _Pool(ProcessPoolExecutor):
    """Local processes that no signal interrupts as they start: neither them, nor the parent half-way through starting one."""

    def submit(self, function: Any, /, *arguments: Any, **options: Any) -> Future:
        """Run on one of the processes; they start when there is work, and inherit what is blocked then."""
        with _without_signals():
            return super().submit(function, *arguments, **options)


@contextlib.contextmanager
def _without_signals() -> Iterator[None]:
    """Hold SIGINT and SIGTERM back for a moment, where the system can.

    Processes started meanwhile inherit what is blocked. Blocking alone does not keep the handlers of this process back: another
    thread (NumPy's, say) may take the signal, and Python runs its handler in the main thread all the same.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    held: list[int] = []
    handlers: dict[int, Any] = {}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
    try:
        for number in _ENDING if threading.current_thread() is threading.main_thread() else ():
            if signal.getsignal(number) is not None:  # else one that is not Python's, and that it could not put back
                handlers[number] = signal.signal(number, lambda got, _: held.append(got))
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in held[:1]:
            signal.raise_signal(number)


def give_up(executor: Executor, futures: Iterable[Future]) -> None:
    """Cancel what has not begun.

    Local processes are left to ``local``, whose shutdown cancels in the pool's own thread: that ends with a traceback where it
    finds a process dead and a future cancelled by another.
    """
    if not isinstance(executor, _Pool):
        for future in futures:
            future.cancel()


def check_workers(workers: int) -> int:
    """``workers`` as an int; ``InputError`` unless so many local processes can be started."""
    most = max(4 * (os.cpu_count() or 1), 60)  # Windows waits for no more than 61 processes at once
    return integer("workers", workers, 1, most, f"an integer >= 1, local processes, at most {most} on this machine")


@contextlib.contextmanager
def local(workers: int) -> Iterator[tuple[Executor, int]]:
    """An executor of this machine and how many batches to keep in flight."""
    if workers == 1:
        yield InProcess(), 1
        return
    from multiprocessing import get_context

    pool = _Pool(workers, mp_context=get_context("spawn"), initializer=_start_worker)
    try:
        yield pool, 2 * workers
    except BaseException:
        # what is in flight is not waited for: it will be solved again
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.kill()  # one that is just starting may still hold other signals back
        # but the pool's own thread is: the interpreter's end must not find it half-way through closing
        pool.shutdown(cancel_futures=True)
        raise
    pool.shutdown()


@contextlib.contextmanager
def dask(address: str) -> Iterator[tuple[Executor, int]]:
    """The executor of a Dask cluster at ``address`` and how many batches to keep in flight."""
    distributed = require("distributed", "dask", "a Dask scheduler")

    class Client(distributed.Client):
        def __del__(self) -> None:
            """Closed below; one that could not connect would wait for itself, and end with a traceback."""

    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # the last without a configuration of TLS
        raise HystripError(f"scheduler {address}: no Dask scheduler answers ({str(error) or type(error).__name__})") from None
    with _quiet("distributed", "distributed.client", "tornado.application"):
        try:
            threads = sum(client.nthreads().values())
            yield client.get_executor(retries=3), max(2 * threads, 8)
        except distributed.KilledWorker as error:
            raise HystripError(lost(f"scheduler {address}: {error}")) from None
        finally:
            client.close(timeout=5)


@contextlib.contextmanager
def _quiet(*loggers: str) -> Iterator[None]:
    """Keep tracebacks of a lost connection off the terminal: what was lost is said in one sentence."""
    found = [logging.getLogger(name) for name in loggers]
    levels = [logger.level for logger in found]
    for logger in found:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(found, levels, strict=True):
            logger.setLevel(level)


def lost(what: str) -> str:
    """What to say when the workers are gone."""
    return f"{what}; finished batches are kept: run the sweep again to go on"


def _start_worker() -> None:
    """Ctrl-C is the parent's to handle; and a worker ends when its parent was killed."""
    from multiprocessing import connection, parent_process

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
    parent = parent_process()

    def watch() -> None:
        connection.wait([parent.sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
