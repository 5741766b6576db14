"""Memory stays flat over many recordings.  memory_test.py [RECORDINGS]: 200 by hand, fewer in ctest."""

import gc
import sys
import unittest

import numpy as np
import sweepscope
from support import FOLDER, stuck

RECORDINGS = 40


def resident_mb():
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


def work_on(path):
    """All that holds memory of the engine: reading, an estimate, a map and its arrays, and a failure."""
    recording = sweepscope.open(path)
    found = recording.estimate()
    map = recording.map(found.offset_ms)
    curve = sweepscope.curve(found)
    assert np.isfinite(map.xyz_m).all() and len(curve.offset_ms) > 0
    try:
        sweepscope.estimate(stuck())
    except sweepscope.CannotAnswer:
        pass
    return map.xyz_m.nbytes


def resident_after_each(recordings, told=lambda done, resident: None):
    paths = [FOLDER / f"{i}.bag" for i in range(4)]
    for i, path in enumerate(paths):
        sweepscope.simulate("room-1", path, seed=i + 1)
    resident = []
    for i in range(recordings):
        work_on(paths[i % len(paths)])
        gc.collect()
        resident.append(resident_mb())
        told(i + 1, resident[-1])
    return resident


class Memory(unittest.TestCase):
    def test_stays_flat(self):
        resident = resident_after_each(RECORDINGS)
        # The allocators' caches fill at first. A map that were kept each time would be 6 MB a recording.
        quarter = RECORDINGS // 4
        early, late = max(resident[quarter : 2 * quarter]), max(resident[-quarter:])
        self.assertLess(late - early, quarter * 1.0, resident)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        resident_after_each(
            int(sys.argv[1]),
            lambda done, resident: done % 10 == 0 and print(f"after {done:4}: {resident:.1f} MB", flush=True),
        )
    else:
        unittest.main()
