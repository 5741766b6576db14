"""The wheel that `pip install .` makes holds the package, whole, and works.  wheel_test.py BUILD_FOLDER"""

import base64
import csv
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

from support import SOURCES, room

sys.path.insert(0, str(SOURCES / "app/python"))
import wheel_backend  # noqa: E402

BUILD = sys.argv.pop(1)


def digest(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        name = wheel_backend.build_wheel(cls.folder.name, {"build": BUILD})
        cls.wheel = Path(cls.folder.name) / name

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_holds_every_file_of_the_package_with_its_hash(self):
        with zipfile.ZipFile(self.wheel) as archive:
            names = archive.namelist()
            record = next(name for name in names if name.endswith("/RECORD"))
            rows = list(csv.reader(archive.read(record).decode().splitlines()))
            self.assertEqual([row[0] for row in rows], names)
            for name, hashed, size in rows[:-1]:
                content = archive.read(name)
                self.assertEqual((hashed, int(size)), ("sha256=" + digest(content), len(content)))
        package = SOURCES / "app/python/sweepscope"
        for source in package.iterdir():
            if source.is_file():
                self.assertIn(f"sweepscope/{source.name}", names)

    def run_installed(self, folder):
        words = f"import sweepscope; print(sweepscope.__file__); print(sweepscope.estimate({str(room())!r}).offset_ms)"
        clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        done = subprocess.run(
            [sys.executable, "-c", words], env={**clean, "PYTHONPATH": folder}, capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        path, offset_ms = done.stdout.split()
        self.assertTrue(path.startswith(folder), path)
        self.assertAlmostEqual(float(offset_ms), 24, delta=0.2)

    def test_works_where_it_is_unpacked(self):
        with tempfile.TemporaryDirectory() as folder:
            zipfile.ZipFile(self.wheel).extractall(folder)
            self.run_installed(folder)

    def test_names_the_packages_to_install_where_a_library_is_missing(self):
        with tempfile.TemporaryDirectory() as folder:
            with zipfile.ZipFile(self.wheel) as archive:
                archive.extractall(folder, [name for name in archive.namelist() if "/_engine" not in name])
            missing = "libvtkCommonCore-9.1.so.1: cannot open shared object file: No such file or directory"
            (Path(folder) / "sweepscope/_engine.py").write_text(f"raise ImportError({missing!r})\n")
            done = subprocess.run([sys.executable, "-c", "import sweepscope"], env={**os.environ, "PYTHONPATH": folder},
                                  capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        sentence = done.stderr.splitlines()[-1]
        self.assertIn(f"ImportError: {missing}. sweepscope needs", sentence)
        if shutil.which("dpkg-query") and shutil.which("objdump"):
            self.assertRegex(sentence, r"apt install .*\blibvtk9\.1\b")

    def test_pip_installs_it(self):
        pip = [sys.executable, "-m", "pip"]
        if subprocess.run([*pip, "--version"], capture_output=True).returncode != 0:
            self.skipTest("pip is not installed")
        with tempfile.TemporaryDirectory() as folder:
            words = ["install", "--no-index", "--no-deps", "--quiet", "--target", folder, self.wheel]
            done = subprocess.run([*pip, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.run_installed(folder)


if __name__ == "__main__":
    unittest.main()
