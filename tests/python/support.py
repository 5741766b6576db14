"""What the tests of the Python module share: small recordings, and the program beside it."""

import functools
import json
import os
import subprocess
import tempfile
from pathlib import Path

import sweepscope

SOURCES = Path(__file__).resolve().parents[2]
PROGRAM = os.environ["SWEEPSCOPE_EXECUTABLE"]
_folder = tempfile.TemporaryDirectory()
FOLDER = Path(_folder.name)


def program(*words, exit_code=0):
    """Runs the program in FOLDER; its result."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == exit_code, done.stderr
    return done


def program_json(*words, exit_code=0):
    return json.loads(program(*words, "--json", "-", exit_code=exit_code).stdout)


@functools.cache
def room():
    """4.5 s of a stationary rig, truth 24 ms."""
    path = FOLDER / "room.bag"
    sweepscope.simulate("room-1", path, offset_ms=24, seed=5)
    return path


@functools.cache
def walk():
    """12 s of a moving one."""
    path = FOLDER / "walk.bag"
    sweepscope.simulate("metro-station", path, offset_ms=24, seed=5, duration_s=12)
    return path


@functools.cache
def stuck():
    """A motor that does not turn: no offset can be found."""
    path = FOLDER / "stuck.bag"
    sweepscope.simulate("room-1", path, motor="stuck")
    return path


def untimed(values):
    return {key: value for key, value in values.items() if key not in ("cpu_s", "wall_s")}
