"""Ctrl-C stops long work at once, and other Python threads run on meanwhile. Signals come at events, not at times."""

import os
import signal
import threading
import unittest

import sweepscope
from support import FOLDER, room, walk

# 90,000 candidates: an hour of work, so that only an interruption ends it while this test runs.
LONG = {"method": "stationary", "around": (24, 0.0001, 90_000)}


class UnderWay:
    """Set once the engine has reported progress, which it does while it works."""

    def __init__(self):
        self.event = threading.Event()

    def __call__(self, phase, fraction):
        self.event.set()


def once_under_way(act):
    """Does something from another Python thread as soon as the work is under way; the progress to hand over."""
    progress = UnderWay()

    def wait_and_act():
        progress.event.wait()
        act()

    threading.Thread(target=wait_and_act, daemon=True).start()
    return progress


def press_ctrl_c():
    os.kill(os.getpid(), signal.SIGINT)


class Interruption(unittest.TestCase):
    def test_ctrl_c_ends_an_estimate_with_a_keyboard_interrupt(self):
        recording = sweepscope.open(room())
        with self.assertRaises(KeyboardInterrupt):
            recording.estimate(progress=once_under_way(press_ctrl_c), **LONG)
        self.assertTrue(recording.estimate().identifiable, "work goes on after an interruption")

    def test_ctrl_c_ends_every_kind_of_work_without_half_an_output(self):
        recording = sweepscope.open(walk())
        before = sorted(FOLDER.iterdir())
        for work in (
            lambda progress: recording.map(24, progress=progress),
            lambda progress: recording.compare([19, 24], output=FOLDER / "no.png", progress=progress),
            lambda progress: sweepscope.simulate("metro-station", FOLDER / "no.bag", progress=progress),
            lambda progress: sweepscope.open(walk(), progress=progress).estimate(progress=progress, **LONG),
        ):
            # Raised within the progress, while the work is held up by nothing else: no work is too short.
            with self.assertRaises(KeyboardInterrupt):
                work(lambda phase, fraction: signal.raise_signal(signal.SIGINT))
        self.assertEqual(sorted(FOLDER.iterdir()), before)

    def test_what_another_handler_raises_ends_the_work(self):
        class Alarm(Exception):
            pass

        def raise_alarm(number, frame):
            raise Alarm

        before = signal.signal(signal.SIGUSR1, raise_alarm)
        try:
            with self.assertRaises(Alarm):
                progress = once_under_way(lambda: os.kill(os.getpid(), signal.SIGUSR1))
                sweepscope.estimate(room(), progress=progress, **LONG)
        finally:
            signal.signal(signal.SIGUSR1, before)

    def test_what_progress_raises_ends_the_work(self):
        def fail(phase, fraction):
            raise RuntimeError(phase)

        with self.assertRaises(RuntimeError):
            sweepscope.open(room()).estimate(progress=fail, **LONG)

    def test_other_threads_run_on_while_the_engine_works(self):
        # The work ends only by what another thread does after a thousand steps of Python.
        steps = []

        def count_and_interrupt():
            while len(steps) < 1000:
                steps.append(len(steps))
            press_ctrl_c()

        with self.assertRaises(KeyboardInterrupt):
            sweepscope.estimate(room(), progress=once_under_way(count_and_interrupt), **LONG)
        self.assertEqual(len(steps), 1000)

    def test_two_threads_work_at_the_same_time_with_the_same_answers(self):
        alone = sweepscope.estimate(room())
        found = []
        threads = [threading.Thread(target=lambda: found.append(sweepscope.estimate(room()))) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([one.offset_ms for one in found], 3 * [alone.offset_ms])

    def test_progress_is_told_by_the_calling_thread(self):
        told = []
        sweepscope.simulate(
            "metro-station",
            FOLDER / "told.bag",
            duration_s=20,
            progress=lambda phase, fraction: told.append((threading.get_ident(), fraction)),
        )
        self.assertEqual({thread for thread, fraction in told}, {threading.get_ident()})
        self.assertTrue(all(0 <= fraction <= 1 for thread, fraction in told))


if __name__ == "__main__":
    unittest.main()
