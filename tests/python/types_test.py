"""What a type checker says of the stubs, and of programs that use them. Requires mypy."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2]
PACKAGE = SOURCES / "app" / "python"
MYPY = shutil.which("mypy")


def findings(text, *options):
    """mypy's, of a program of this text."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.py"
        program.write_text(text)
        done = subprocess.run([MYPY, "--strict", "--no-error-summary", "--cache-dir", os.devnull, *options, program],
                              env=dict(os.environ, MYPYPATH=str(PACKAGE)), capture_output=True, text=True)
    return done.stdout.replace(folder, "") + done.stderr


@unittest.skipUnless(MYPY, "mypy is not installed")
class Types(unittest.TestCase):
    def test_a_correct_program_passes_with_the_types_of_its_results(self):
        self.assertEqual(findings("""
import sweepscope
found = sweepscope.estimate("walk.bag", method="direct", threads=2)
offset_ms: float | None = found.offset_ms
warnings: list[str] = found.warnings
"""), "")

    def test_a_wrong_argument_is_found(self):
        found = findings('import sweepscope\nsweepscope.estimate("walk.bag", threads="two")\n')
        self.assertIn("incompatible type", found)

    def test_a_wrong_member_is_found(self):
        self.assertIn("has no attribute", findings('import sweepscope\nsweepscope.open("walk.bag").maps(24)\n'))

    def test_the_documented_programs_pass_where_an_offset_was_found(self):
        page = (SOURCES / "docs/python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 5)
        self.assertEqual(findings("\n".join(blocks), "--no-strict-optional"), "")


if __name__ == "__main__":
    sys.exit(unittest.main())
