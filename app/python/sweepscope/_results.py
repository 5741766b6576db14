"""The results of the functions of sweepscope."""

import json
import os
from collections.abc import Mapping

from . import _engine


class Estimate(Mapping):
    """The offset with its evidence: t_motor = t_laser + offset.

    Keys and attributes are those of `sweepscope estimate --json`: offset_ms and sigma_ms (milliseconds; sigma is one
    standard deviation, None where the method has none), method, warnings, criteria, curve, sweeps, scans, fit ...
    """

    def __init__(self, engine, text=None):
        self._engine = engine
        self._text = engine.json() if text is None else text
        self._values = json.loads(self._text)

    @classmethod
    def _of_text(cls, text):
        return cls(_engine.parse_estimate(text, "the estimate"), text)

    def __reduce__(self):
        return Estimate._of_text, (self._text,)

    def __getitem__(self, key):
        return self._values[key]

    def __iter__(self):
        return iter(self._values)

    def __len__(self):
        return len(self._values)

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._values:
            raise AttributeError(f"an estimate has no {name!r}")
        return self._values[name]

    def __dir__(self):
        return [*super().__dir__(), *self._values]

    def __repr__(self):
        if not self["identifiable"]:
            return "offset cannot be determined from this recording: " + " ".join(self["reasons"])
        sigma = "" if self["sigma_ms"] is None else f" +- {self['sigma_ms']:.3f} ms (1 sigma)"
        return f"offset {self['offset_ms']:.3f} ms{sigma}, t_motor = t_laser + offset, by {self['method']}"

    def to_json(self):
        """The text that `sweepscope estimate --json` writes."""
        return self._text

    def save(self, path):
        """Writes that text to a file, whole or not at all."""
        _engine.write_text(path, self.to_json())


class Curve(dict):
    """The criteria over the offset: a NumPy array for each name, NaN where a value is absent.

    offset_ms: the candidates, ascending, in milliseconds.
    d, translation_m, rotation_rad, signed_rotation_rad: of a stationary rig, means over the pairs of sweeps.
    n, e_m: of a moving rig, the number of matches and their mean distance in metres.
    capped_cost_m: of the coarse search and the direct method, in metres.

    The arrays are views of the engine's memory and read-only; use copy() to write.
    """

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a curve has no {name!r}") from None


class Map:
    """The map at an offset, as NumPy arrays that are read-only views of the engine's memory.

    The map frame is the base frame at the beginning of the first sweep. Times are seconds on the laser's clock since epoch_ns.

    offset_ms: t_motor = t_laser + offset, in milliseconds.
    xyz_m: (points, 3) float32, in metres, in the map frame.
    intensity: (points,) float32; 0 where the laser has none.
    time_s: (points,) float64, when the beam was fired.
    sweep: (points,) uint32; consecutive sweeps turn in opposite directions.
    pose_time_s, position_m, orientation_xyzw: the trajectory, map_from_base: (poses,), (poses, 3) in metres, and
        (poses, 4) unit quaternions.
    moving: whether the rig moved. lost: tracking was lost, do not trust the map.
    numpy.asarray(map) is xyz_m.
    """

    def __init__(self, engine, offset_ms):
        self._engine = engine
        self.offset_ms = offset_ms
        for name in _MAP_MEMBERS:
            setattr(self, name, getattr(engine, name))

    @classmethod
    def _of_members(cls, offset_ms, members):
        points = [members[name] for name in _MAP_MEMBERS[:4]]
        return cls(_engine.rebuilt_map(*points, members), offset_ms)

    def __reduce__(self):
        return Map._of_members, (self.offset_ms, {name: getattr(self, name) for name in _MAP_MEMBERS})

    def __array__(self, dtype=None, copy=None):
        if copy is False and dtype not in (None, self.xyz_m.dtype):
            raise ValueError("another dtype needs a copy")
        points = self.xyz_m if dtype is None else self.xyz_m.astype(dtype, copy=False)
        return points.copy() if copy else points

    def __len__(self):
        return len(self.xyz_m)

    def __repr__(self):
        kind = "moving" if self.moving else "stationary"
        return f"{len(self)} points of a {kind} rig at t_motor = t_laser + {self.offset_ms:.3f} ms"

    def save(self, path):
        """Writes a .pcd or .ply file: x y z (m), intensity, time (s), sweep."""
        self._engine.save(path)

    def save_trajectory(self, path):
        """Writes the trajectory as TUM: time (s), position (m), quaternion x y z w."""
        self._engine.save_trajectory(path)


_MAP_MEMBERS = (
    "xyz_m",
    "intensity",
    "time_s",
    "sweep",
    "pose_time_s",
    "position_m",
    "orientation_xyzw",
    "moving",
    "lost",
    "epoch_ns",
)


class Picture:
    """A picture that a notebook shows.

    png: its bytes. facts: what `sweepscope compare --json` writes (the thickness of the maps and the places where they
    differ most), or None.
    """

    def __init__(self, png, facts=None):
        self.png = png
        self.facts = facts

    def _repr_png_(self):
        return self.png

    def __repr__(self):
        return f"a picture, {len(self.png)} bytes of PNG"

    def save(self, path):
        """Writes the PNG, whole or not at all."""
        _engine.write_bytes(os.fspath(path), self.png)
