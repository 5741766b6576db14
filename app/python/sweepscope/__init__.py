"""The time offset between an actuated 2D laser scanner and its motor: t_motor = t_laser + offset.

    import sweepscope

    recording = sweepscope.open("room.bag")
    found = recording.estimate()
    print(found.offset_ms, "+-", found.sigma_ms, "ms")
    room = recording.map(found.offset_ms)
    print(room.xyz_m.min(axis=0), room.xyz_m.max(axis=0))
    recording.compare([found.offset_ms - 5, found.offset_ms]).save("maps.png")
    recording.apply("applied.bag", estimate=found)

Every function that takes a recording takes its path, too. threads is how many the engine uses (0: as many as there are
processors; the result is the same); progress(phase, fraction) is called now and then, by the calling thread. Ctrl-C
stops long work within a fraction of a second, other threads run on meanwhile, and what goes wrong is an exception:
InputError, CannotAnswer, or ValueError for wrong usage.
"""

try:
    from ._engine import __version__
except ImportError as error:
    if "shared object file" not in str(error):
        raise
    from ._libraries import words_for

    raise ImportError(words_for(error)) from None
from ._errors import CannotAnswer, Error, InputError
from ._recording import (
    Recording,
    apply,
    compare,
    curve,
    estimate,
    figures,
    info,
    map,
    open,
    read_estimate,
    scenes,
    simulate,
    together,
)
from ._results import Curve, Estimate, Map, Picture

# Without map and open: `from sweepscope import *` hides no builtin.
__all__ = [
    "CannotAnswer",
    "Curve",
    "Error",
    "Estimate",
    "InputError",
    "Map",
    "Picture",
    "Recording",
    "apply",
    "compare",
    "curve",
    "estimate",
    "figures",
    "info",
    "read_estimate",
    "scenes",
    "simulate",
    "together",
]
