"""The examples of docs/python.md and of help(sweepscope) do what they say: they are run as they stand."""

import contextlib
import csv
import io
import os
import re
import shutil
import unittest

import sweepscope
from support import FOLDER, SOURCES, room, walk


def blocks(text):
    """The Python blocks of a page, in order."""
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


def in_help():
    """The indented block of the package's own description."""
    lines = [line[4:] for line in sweepscope.__doc__.splitlines() if line.startswith("    ") or not line]
    return "\n".join(lines).strip() + "\n"


class Examples(unittest.TestCase):
    def setUp(self):
        folder = FOLDER / self.id().rsplit(".", 1)[-1]
        folder.mkdir()
        shutil.copy(room(), folder / "room.bag")
        shutil.copy(walk(), folder / "walk.bag")
        self.before = os.getcwd()
        os.chdir(folder)

    def tearDown(self):
        os.chdir(self.before)

    def run_blocks(self, blocks_to_run):
        printed = io.StringIO()
        names = {}
        with contextlib.redirect_stdout(printed):
            for block in blocks_to_run:
                exec(compile(block, "example", "exec"), names)
        return printed.getvalue()

    def test_those_of_the_page(self):
        page = blocks((SOURCES / "docs/python.md").read_text())
        self.assertGreater(len(page), 4)
        self.assertLessEqual(len([line for line in page[0].splitlines() if line]), 8, "the first has eight lines")
        self.run_blocks(page)
        self.check_table("offsets.csv")

    def check_table(self, path):
        """What the example for many recordings wrote: the motor of stuck.bag does not turn."""
        with open(path, newline="") as table:
            offsets_ms = {row["recording"]: row["offset_ms"] for row in csv.DictReader(table)}
        self.assertEqual(list(offsets_ms), ["applied.bag", "room.bag", "stuck.bag", "walk.bag"])
        self.assertAlmostEqual(float(offsets_ms["applied.bag"]), 0, delta=0.2)
        self.assertAlmostEqual(float(offsets_ms["room.bag"]), 24, delta=0.2)
        self.assertEqual(offsets_ms["stuck.bag"], "")

    def test_that_of_help_is_the_pages_first(self):
        self.assertEqual(in_help(), blocks((SOURCES / "docs/python.md").read_text())[0])
        self.assertRegex(self.run_blocks([in_help()]), r"^2[34]\.\d+ \+- 0\.\d+ ms")
        self.assertTrue(os.path.exists("maps.png") and os.path.exists("applied.bag"))


if __name__ == "__main__":
    unittest.main()
