"""What pip calls to make a wheel (PEP 517): CMake builds the package, and this packs it. Requires no other package.

The build's folder is build-wheel and is used again. `--config-settings build=FOLDER` uses one that is configured
already, such as build, where only the Python package may still be built.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2]


def version():
    return re.search(r"project\(sweepscope VERSION ([0-9.]+)", (SOURCES / "CMakeLists.txt").read_text())[1]


def get_requires_for_build_wheel(config_settings=None):
    return []


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _metadata():
    return (
        f"Metadata-Version: 2.1\nName: sweepscope\nVersion: {version()}\n"
        "Summary: The time offset between an actuated 2D laser scanner and its motor\n"
        "License: BSD-3-Clause\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
    )


def _run(command, **options):
    """pip isolates this process by PYTHONPATH, which is not meant for CMake: packages that it finds (ROS 1's) run
    Python scripts of their own, with the system's modules."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run(command, check=True, env=environment, **options)


def _configure(build):
    """CMake's own choice of compiler and options, for the Python that pip runs with."""
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF", "-DSWEEPSCOPE_BUILD_PYTHON=ON",
               "-DCMAKE_UNITY_BUILD=ON"]
    python = [f"-DPython_EXECUTABLE={sys.executable}"]
    _run(["cmake", "-S", SOURCES, "-B", build, "-G", "Ninja", *options, *python])


def _packed(folder):
    """The files of the package, as they are in the wheel; CMake's part `python` is installed into the folder."""
    installed = next(Path(folder).rglob("sweepscope/__init__.py")).parent
    files = {f"sweepscope/{path.name}": path.read_bytes() for path in sorted(installed.iterdir())}
    packages = f'PACKAGES = "{_packages(next(installed.glob("_engine*.so"), ""))}"'
    words = "sweepscope/_libraries.py"
    files[words] = files[words].replace(b'PACKAGES = ""', packages.encode())
    return files


def _packages(engine):
    """Debian's packages of the libraries that the module names, where Debian's tools are: for who has them not."""
    def output(*command):
        return subprocess.run(command, capture_output=True, text=True).stdout

    try:
        places = dict(re.findall(r"(\S+) => (/\S+)", output("ldd", engine)))
        names = re.findall(r"NEEDED +(\S+)", output("objdump", "-p", engine))
        found = output("dpkg-query", "-S", *(os.path.realpath(places[name]) for name in names if name in places))
    except FileNotFoundError:
        return ""
    packages = {line.split(":")[0] for line in found.splitlines()} - {"libc6", "libgcc-s1", "libstdc++6"}
    return " ".join(sorted(packages | {"libosmesa6"}))  # which is loaded at run time


def _build(build, folder):
    if not (build / "CMakeCache.txt").exists():
        _configure(build)
    _run(["cmake", "--build", build, "--target", "sweepscope_python"])
    _run(["cmake", "--install", build, "--component", "python", "--prefix", folder], stdout=subprocess.DEVNULL)


def _write(wheel, files, information):
    """A wheel is a zip file with a record of its files' hashes."""
    record = ""
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record += f"{name},sha256={digest},{len(content)}\n"
            archive.writestr(zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0)), content, zipfile.ZIP_DEFLATED)
        name = f"{information}/RECORD"
        archive.writestr(zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0)), record + f"{name},,\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = Path((config_settings or {}).get("build", SOURCES / "build-wheel")).absolute()
    information = f"sweepscope-{version()}.dist-info"
    with tempfile.TemporaryDirectory() as folder:
        _build(build, folder)
        files = _packed(folder)
    if not any(name.startswith("sweepscope/_engine") for name in files):
        raise SystemExit("the Python module was not built: install pybind11-dev and python3-dev")
    files[f"{information}/METADATA"] = _metadata().encode()
    wheel = f"Wheel-Version: 1.0\nGenerator: sweepscope\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    files[f"{information}/WHEEL"] = wheel.encode()
    files[f"{information}/LICENSE"] = (SOURCES / "LICENSE").read_bytes()
    name = f"sweepscope-{version()}-{_tag()}.whl"
    _write(Path(wheel_directory) / name, files, information)
    return name

