"""The functions of sweepscope. Each takes an opened recording or its path, and is a method of Recording as well."""

import json
import os
import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path

from . import _engine, _options
from ._errors import CannotAnswer
from ._results import Curve, Estimate, Map, Picture

_SEARCH = _engine.estimate_options()
_LOOK = _engine.look_options()
_SIMULATION = [{**option, "repeats": False} for option in _engine.simulation_options()]


def open(path, *, rig=None, stamps=None, window_s=None, laser=None, motor=None, joint=None, progress=None):
    """Reads a recording: a ROS 1 or ROS 2 bag (.bag, .db3, .mcap), or a folder of either or of CSV tables.

    rig: a rig file (YAML): topics, joint, stamps and mount. Without it they are detected, rolling about x.
    stamps: "header" or "receive", for both streams.
    window_s: (A, B), only that part, in seconds since the first scan.
    laser, motor, joint: where several are there; they override the rig file's.
    """
    return Recording(_engine.open(path, rig, stamps, window_s, laser, motor, joint, _call(0, progress)))


def _call(threads, progress):
    if not 0 <= threads <= 1024:
        raise ValueError(f"threads needs a number from 1 to 1024, or 0 for all processors, not {threads}")
    return _engine.Call(threads, progress)


def _opened(recording, progress=None):
    """The engine's recording of an opened one, or of a path."""
    return recording._engine if isinstance(recording, Recording) else open(recording, progress=progress)._engine


def info(recording, *, progress=None):
    """The recording's streams and the expected accuracy, with the keys of `sweepscope info --json`."""
    return json.loads(_engine.info(_opened(recording, progress), _call(0, progress)))


@_options.takes(_SEARCH)
def estimate(recording, *, assume=None, poses=None, trust_poses=False, threads=0, progress=None, **options):
    """Finds the offset: t_motor = t_laser + offset. Gives an Estimate, whose keys are those of `estimate --json`.

    A recording that does not determine the offset raises CannotAnswer, with the reasons and the Estimate. Options are
    the command line's, with _ for -: text as there, or numbers, such as range=(19, 29, 1) in milliseconds.

    assume: "stationary" or "moving", instead of the motion test.
    poses: a trajectory of a moving rig (TUM file, poses of the base frame) as a prior, or with trust_poses the truth.
    threads, progress: see help(sweepscope)."""
    given = _options.texts("estimate", _SEARCH, options)
    engine = _opened(recording, progress)
    call = _call(threads, progress)
    return _answer(Estimate(_engine.estimate(engine, given, assume, poses, trust_poses, call)), "this recording")


def _answer(found, of_what):
    """The estimate, if it has an answer."""
    if not found.identifiable:
        why = f"the offset cannot be determined from {of_what}: " + " ".join(found.reasons)
        raise CannotAnswer(why, found.reasons, found)
    return found


def together(recordings, *, offsets="one", assume=None, threads=0, progress=None, **options):
    """Finds one answer from several recordings of one rig, by the direct method: an Estimate, whose "recordings" say what
    each of them contributes. Recordings that do not agree on one rig raise CannotAnswer, which names the one that differs.

    recordings: at least two recordings or paths.
    offsets: "one" for all recordings, or "each": every recording has its own, and the rig is common (offset_ms is None).
    assume: "stationary" or "moving", instead of the motion test.
    threads, progress: see help(sweepscope).
    options: solve, search and the others of estimate().
    """
    if offsets not in ("one", "each"):
        raise ValueError(f'offsets needs "one" or "each", not {offsets!r}')
    given = _options.texts("together", _SEARCH, options)
    opened = [_opened(recording, progress) for recording in recordings]
    call = _call(threads, progress)
    return _answer(Estimate(_engine.together(opened, offsets == "each", given, assume, call)), "these recordings")


def curve(recording, **options):
    """The criteria over the offset as NumPy arrays: a Curve, from an Estimate or from one made with these options."""
    if not isinstance(recording, Estimate):
        recording = estimate(recording, **options)
    elif options:
        raise TypeError("the curve of an estimate takes no options")
    return Curve(recording._engine.curve())


def map(
    recording,
    offset_ms,
    *,
    assume=None,
    poses=None,
    voxel_m=None,
    remove_outliers=False,
    threads=0,
    progress=None,
):
    """The map at an offset, in milliseconds: a Map of NumPy arrays, in metres and seconds.

    assume: "stationary" or "moving", instead of the motion test.
    poses: a trajectory of the rig (TUM file), used instead of solving for it; the map is in its frame.
    voxel_m: one point per cube of this size is kept. remove_outliers: outliers are left out.
    threads, progress: see help(sweepscope).
    """
    opened = _opened(recording, progress)
    built = _engine.map(opened, offset_ms, assume, poses, voxel_m, remove_outliers, _call(threads, progress))
    if built.warning:
        warnings.warn(built.warning, stacklevel=2)
    if built.lost:
        warnings.warn("tracking was lost at this offset: do not trust the map", stacklevel=2)
    return Map(built, offset_ms)


def _curve_below(estimate):
    """The engine's estimate of an Estimate or a file; None for True and False, which say whether to make one."""
    if estimate is None or isinstance(estimate, bool):
        return None
    return estimate._engine if isinstance(estimate, Estimate) else _engine.read_estimate(estimate)


@_options.takes(_LOOK)
def compare(
    recording,
    offsets_ms=None,
    *,
    curve=True,
    assume=None,
    poses=None,
    output=None,
    threads=0,
    progress=None,
    **look,
):
    """Two to four maps side by side, with the same camera, and the criteria below: a Picture.

    recording: a recording, to be mapped at offsets_ms (milliseconds); or a list of maps, each a Map or a .pcd or .ply
        file.
    curve: an Estimate or its JSON file, whose criteria are drawn. True: computed, for a recording, in steps of 1 ms
        from 2 to 5 ms below the offsets to as much above. False: none.
    assume, poses: as for map().
    output: a .png, .svg or .pdf file to write as well.
    threads, progress: see help(sweepscope).

    How it looks, as on the command line:"""
    texts = _options.texts("compare", _LOOK, look)
    call = _call(threads, progress)
    below = _curve_below(curve)
    if isinstance(recording, (list, tuple)):
        if offsets_ms is not None or assume is not None or poses is not None:
            raise TypeError("offsets_ms, assume and poses belong to a recording: maps have theirs")
        maps = [one._engine if isinstance(one, Map) else Path(one) for one in recording]
        png, facts = _engine.compare_maps(maps, texts, below, output, call)
    else:
        offsets_ms = [float(offset_ms) for offset_ms in ([] if offsets_ms is None else offsets_ms)]
        engine = _opened(recording, progress)
        png, facts = _engine.compare_recording(
            engine, offsets_ms, texts, below, curve is True, assume, poses, output, call
        )
    return Picture(png, json.loads(facts))


def _pictures(files):
    pngs = [Path(file) for file in files if file.endswith(".png")]
    return {png.stem: Picture(png.read_bytes()) for png in pngs}


def figures(recipe, output=None, *, threads=0, progress=None):
    """Makes the figures of a recipe: a dict from the name of each to a Picture.

    recipe: a YAML file such as assets/figures/quick.yaml, or the same as a dict; a dict's files are relative to the
        current folder.
    output: the folder for pictures, tables, and estimates to be used again. None: only the pictures are kept.
    threads, progress: see help(sweepscope).
    """
    if output is None:
        with tempfile.TemporaryDirectory() as folder:
            return figures(recipe, folder, threads=threads, progress=progress)
    if isinstance(recipe, dict):
        return _pictures(_engine.figures_of_text(json.dumps(recipe), output, _call(threads, progress)))
    return _pictures(_engine.figures(recipe, output, _call(threads, progress)))


@_options.takes(_SIMULATION)
def simulate(scene, output, *, threads=0, progress=None, **options):
    """Simulates a recording whose offset is known, as a ROS 1 bag, with OUT.truth.json and OUT.truth.tum beside it.

    scene: one of sweepscope.scenes(), or None with mesh or world. output: the .bag file.
    Gives the truth: offset_ms, and the other keys of OUT.truth.json. Units are in the names of the options:"""
    given = {
        option["name"]: _simulation_value(option, value)
        for option, value in _options.known("simulate", _SIMULATION, options)
    }
    return json.loads(_engine.simulate(scene, output, given, _call(threads, progress)))


def _simulation_value(option, value):
    """Three numbers become text for the engine; other values are unchanged."""
    is_triple = isinstance(option["default"], str) and not isinstance(value, (str, os.PathLike))
    return ",".join(repr(float(number)) for number in value) if is_triple else value


def scenes():
    """The names of the scenes that can be simulated."""
    return _engine.scenes()


def _estimate_to_apply(estimate):
    """The name of an estimate's file ("" if there is none) and its JSON."""
    if estimate is None:
        return None
    if isinstance(estimate, Estimate):
        return "", estimate.to_json()
    if isinstance(estimate, Mapping):
        return "", json.dumps(estimate)
    return os.fspath(estimate), _engine.read_text(estimate)


def _check_apply(output, estimate, offset_ms, shift, clouds, tf, clouds_only, clouds_format, poses):
    """Contradictions among the arguments, whatever the files hold."""
    if (estimate is None) == (offset_ms is None):
        raise ValueError("apply needs the offset: one of estimate and offset_ms")
    if output is None and clouds_only is None:
        raise ValueError("apply needs an output: output, or clouds_only")
    if (clouds is not None or tf) and output is None:
        raise ValueError("clouds and tf add topics to a recording: name it with output")
    if poses is not None and clouds is None and clouds_only is None:
        raise ValueError("poses is used by clouds and clouds_only")
    if shift not in ("motor", "laser"):
        raise ValueError(f"shift takes motor or laser, not {shift}")
    if clouds_format not in ("pcd", "ply"):
        raise ValueError(f"clouds_format takes pcd or ply, not {clouds_format}")


def apply(
    recording,
    output=None,
    *,
    estimate=None,
    offset_ms=None,
    shift="motor",
    rig=None,
    stamps=None,
    clouds=None,
    tf=False,
    clouds_only=None,
    clouds_format="pcd",
    poses=None,
    assume=None,
    base_frame="base_link",
    again=False,
    far=False,
    threads=0,
    progress=None,
):
    """Writes the recording with the offset applied to the stamps; all other messages stay byte for byte.

    output: OUT.bag, OUT.mcap, OUT.db3, or a folder for a ROS 2 bag.
    estimate: an Estimate, its JSON file or the same as a dict, whose offset is applied; or offset_ms, in milliseconds.
    shift: "motor" moves its stamps onto the laser's clock, "laser" the other way.
    rig, stamps: as for open(); those of an opened recording are known.
    clouds: a topic, on which each sweep is added as a sensor_msgs/PointCloud2 in the base frame of its first beam,
        with the motion of the motor and of the rig removed. tf: the laser's pose in the base frame is added to /tf.
    clouds_only: a new folder, into which each sweep is written as a file (clouds_format: "pcd" or "ply") with its pose.
    poses, assume: as for map(), for the rig's motion. base_frame: the clouds' frame.
    again: also where an offset was applied before. far: also if the offset is longer than the motor's period.

    Gives a dict: "record" (what was written into the recording about this), "moved" (messages), "sweeps" (files), and
    "warnings".
    """
    _check_apply(output, estimate, offset_ms, shift, clouds, tf, clouds_only, clouds_format, poses)
    opened = recording._engine if isinstance(recording, Recording) else None
    keywords = {
        "shift": shift,
        "rig": rig,
        "stamps": stamps,
        "clouds": clouds,
        "tf": tf,
        "clouds_only": clouds_only,
        "clouds_format": clouds_format,
        "poses": poses,
        "assume": assume,
        "base_frame": base_frame,
        "again": again,
        "far": far,
    }
    record, moved, sweeps, warned = _engine.apply(
        opened.path if opened else recording,
        opened,
        output or "",
        _estimate_to_apply(estimate),
        offset_ms,
        keywords,
        _call(threads, progress),
    )
    return {"record": record and json.loads(record), "moved": moved, "sweeps": sweeps, "warnings": warned}


def read_estimate(path):
    """An Estimate from the JSON file that `sweepscope estimate --json` or Estimate.save() wrote."""
    return Estimate(_engine.read_estimate(path), _engine.read_text(path))


class Recording:
    """An opened recording; see open(). Times are seconds since epoch_ns (ns since 1970), each on its own clock.

    path, name: of the file. scans: their number. warnings: of reading, whole sentences.
    motor_time_s, motor_angle_rad: the motor's track, on the motor's clock.
    scan_time_s: when each scan's first beam was fired, on the laser's clock. ranges_m: of all beams, one scan after the
    other, in metres; NaN without a return. They are NumPy arrays: read-only views of the recording, without copies.
    """

    def __init__(self, engine):
        self._engine = engine

    def __repr__(self):
        return f"{self.name}: {self.scans} scans"

    path = property(lambda self: self._engine.path)
    name = property(lambda self: self._engine.name)
    epoch_ns = property(lambda self: self._engine.epoch_ns)
    scans = property(lambda self: self._engine.scans)
    warnings = property(lambda self: self._engine.warnings)
    motor_time_s = property(lambda self: self._engine.motor_time_s)
    motor_angle_rad = property(lambda self: self._engine.motor_angle_rad)
    scan_time_s = property(lambda self: self._engine.scan_time_s)
    ranges_m = property(lambda self: self._engine.ranges_m)

    info = info
    estimate = estimate
    curve = curve
    map = map
    compare = compare
    apply = apply
