"""Python's numbers are the command line's, to the last digit."""

import copy
import json
import pickle
import unittest

import numpy as np
import support
import sweepscope
from support import FOLDER, SOURCES, program, program_json, room, untimed, walk


class Numbers(unittest.TestCase):
    maxDiff = None

    def assert_equals_the_program(self, recording, words, keywords):
        expected = program_json("estimate", recording, *words)
        found = sweepscope.open(recording).estimate(**keywords)
        self.assertEqual(untimed(found), untimed(expected))
        self.assertEqual(list(found), list(expected), "the order of the keys")

    def test_of_a_stationary_rig(self):
        self.assert_equals_the_program(room(), [], {})
        self.assert_equals_the_program(room(), ["--threads", "1"], {"threads": 2})

    def test_of_the_papers_method_with_ranges_given_as_numbers(self):
        words = ["--method", "stationary", "--range", "19:29:1", "--range", "23:25:0.1", "--weight-c", "0.3"]
        ranges = [(19, 29, 1), (23, 25, 0.1)]
        self.assert_equals_the_program(room(), words, {"method": "stationary", "range": ranges, "weight_c": 0.3})

    def test_of_a_rig_that_is_solved_for(self):
        words = ["--solve", "mount,play", "--prior", "mount_deg=2,play_deg=0.3"]
        given = {"solve": ["mount", "play"], "prior": {"mount_deg": 2, "play_deg": 0.3}}
        self.assert_equals_the_program(room(), words, given)

    def test_of_recordings_of_one_rig(self):
        other = FOLDER / "other.bag"
        sweepscope.simulate("room-2", other, offset_ms=24, seed=6)
        expected = program_json("estimate", room(), other, "--together", "--solve", "mount")
        found = sweepscope.together([sweepscope.open(room()), other], solve="mount")
        self.assertEqual(untimed(found), untimed(expected))
        found.save(FOLDER / "together.json")
        self.assertEqual(sweepscope.read_estimate(FOLDER / "together.json").recordings, found.recordings)
        each = sweepscope.together([room(), other], offsets="each")
        self.assertEqual([each.offset_ms, each.offsets], [None, "each"])

    def test_of_an_offset_over_time(self):
        self.assert_equals_the_program(room(), ["--over-time"], {"over_time": True})
        self.assert_equals_the_program(room(), ["--over-time", "2"], {"over_time": 2})
        self.assert_equals_the_program(room(), [], {"over_time": False})

    def test_of_a_walk(self):
        words = ["--range", "22:26:1", "--assume", "moving"]
        self.assert_equals_the_program(walk(), words, {"range": (22, 26, 1), "assume": "moving"})

    def test_of_a_part_with_a_rig_file(self):
        rig = SOURCES / "assets/rigs/utm30lx_mx64r.yaml"
        expected = program_json("estimate", room(), "--window", "0.5:4", "--rig", rig, "--stamps", "receive")
        part = sweepscope.open(room(), window_s=(0.5, 4), rig=rig, stamps="receive")
        self.assertEqual(untimed(part.estimate()), untimed(expected))

    def test_of_info(self):
        self.assertEqual(sweepscope.open(room()).info(), program_json("info", room()))

    def test_the_json_is_the_programs_text(self):
        found = sweepscope.estimate(room())
        found.save(FOLDER / "found.json")
        self.assertEqual((FOLDER / "found.json").read_text(), found.to_json())
        self.assertEqual(untimed(json.loads(found.to_json())), untimed(program_json("estimate", room())))
        again = sweepscope.read_estimate(FOLDER / "found.json")
        self.assertEqual(dict(again), dict(found))

    def test_of_a_simulation(self):
        words = ["room-2", "-o", "a.bag", "--offset-ms", "7.3", "--mount-error-deg", "1,0,-0.5", "--imu"]
        program("simulate", *words)
        truth = sweepscope.simulate(
            "room-2", FOLDER / "b.bag", offset_ms=7.3, mount_error_deg=(1, 0, -0.5), imu=True
        )
        self.assertEqual((FOLDER / "a.bag").read_bytes(), (FOLDER / "b.bag").read_bytes())
        self.assertEqual(truth, json.loads((FOLDER / "a.truth.json").read_text()))

    def test_of_an_applied_offset(self):
        found = sweepscope.estimate(room())
        found.save(FOLDER / "e.json")
        program("apply", room(), "-o", "by_program.mcap", "--estimate", "e.json")
        applied = sweepscope.apply(room(), FOLDER / "by_python.mcap", estimate=FOLDER / "e.json")
        by_program, by_python = FOLDER / "by_program.mcap", FOLDER / "by_python.mcap"
        self.assertEqual(by_program.read_bytes(), by_python.read_bytes())
        self.assertEqual(applied["record"]["offset_ms"], found.offset_ms)
        self.assertEqual(applied["moved"], applied["record"]["messages"])
        in_memory = sweepscope.open(room()).apply(FOLDER / "in_memory.bag", estimate=found)
        self.assertEqual(in_memory["record"]["offset_ms"], found.offset_ms)
        self.assertLess(abs(sweepscope.estimate(FOLDER / "in_memory.bag").offset_ms), 0.1)

    def test_of_a_comparison(self):
        words = ["--offsets-ms", "19,24", "--size", "640x480", "--colour-by", "direction", "--slab", "-3:3"]
        facts = program_json("compare", room(), "-o", "maps.png", *words)
        picture = sweepscope.open(room()).compare(
            [19, 24], size=(640, 480), colour_by="direction", slab=(-3, 3), output=FOLDER / "again.png"
        )
        self.assertEqual(picture.png, (FOLDER / "maps.png").read_bytes())
        self.assertEqual((FOLDER / "again.png").read_bytes(), picture.png)
        self.assertEqual(picture.facts, facts)

    def test_of_the_figures_of_a_recipe(self):
        recipe = {
            "recordings": {"room": {"simulate": "room-1"}},
            "estimates": {"room": {"recording": "room", "method": "stationary", "ranges_ms": [[20, 28, 1]]}},
            "figures": {"d": {"kind": "curves", "estimates": "room", "criteria": "d", "size": "640x480"}},
        }
        (FOLDER / "recipe").write_text(json.dumps(recipe))
        program("figures", "recipe", "-o", "figures")
        pictures = sweepscope.figures(recipe)
        self.assertEqual(list(pictures), ["d"])
        self.assertEqual(pictures["d"].png, (FOLDER / "figures/d.png").read_bytes())


class Arrays(unittest.TestCase):
    def test_a_map_is_the_programs(self):
        program("map", room(), "--offset-ms", "24", "-o", "program.pcd", "--trajectory", "program.tum")
        map = sweepscope.map(room(), 24)
        map.save(FOLDER / "python.pcd")
        map.save_trajectory(FOLDER / "python.tum")
        for name in ("pcd", "tum"):
            by_program, by_python = FOLDER / f"program.{name}", FOLDER / f"python.{name}"
            self.assertEqual(by_program.read_bytes(), by_python.read_bytes())
        head, body = by_pcd((FOLDER / "program.pcd").read_bytes())
        self.assertEqual(len(map), len(body))
        for i, axis in enumerate("xyz"):
            np.testing.assert_array_equal(map.xyz_m[:, i], body[axis])
        for name, column in (("intensity", "intensity"), ("time_s", "time"), ("sweep", "sweep")):
            np.testing.assert_array_equal(getattr(map, name), body[column], head)

    def test_results_can_be_copied_and_pickled(self):
        found = sweepscope.estimate(room())
        built = sweepscope.map(room(), 24)
        for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
            self.assertEqual(again.to_json(), found.to_json())
            np.testing.assert_array_equal(sweepscope.curve(again)["offset_ms"], sweepscope.curve(found)["offset_ms"])
        for again in (pickle.loads(pickle.dumps(built)), copy.copy(built)):
            for name in ("xyz_m", "intensity", "time_s", "sweep", "pose_time_s", "position_m", "orientation_xyzw"):
                np.testing.assert_array_equal(getattr(again, name), getattr(built, name))
            self.assertEqual((again.offset_ms, again.moving, again.lost), (24, False, False))
            built.save(FOLDER / "built.pcd")
            again.save(FOLDER / "again.pcd")
            self.assertEqual((FOLDER / "built.pcd").read_bytes(), (FOLDER / "again.pcd").read_bytes())
        curve = sweepscope.curve(found)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(curve)).offset_ms, curve.offset_ms)
        picture = sweepscope.Picture(b"png", {"a": 1})
        self.assertEqual(pickle.loads(pickle.dumps(picture)).facts, {"a": 1})

    def test_a_map_as_an_array_is_its_points(self):
        built = sweepscope.map(room(), 24)
        self.assertTrue(np.shares_memory(np.asarray(built), built.xyz_m))
        self.assertEqual(np.asarray(built, dtype=np.float64).dtype, np.float64)
        self.assertTrue(np.array(built).flags.writeable)

    def test_an_estimate_is_applied_as_a_result_or_as_a_dict(self):
        found = sweepscope.estimate(room())
        done = [sweepscope.apply(room(), FOLDER / f"as-{i}.bag", estimate=one)["record"]["offset_ms"]
                for i, one in enumerate((found, dict(found)))]
        self.assertEqual(done[0], done[1])

    def test_they_are_views_of_one_buffer_without_copies(self):
        map = sweepscope.map(room(), 24)
        self.assertFalse(map.xyz_m.flags.owndata)
        first = map._engine.xyz_m
        self.assertEqual(address(first), address(map.xyz_m))
        self.assertEqual(map.xyz_m.strides[0], map.time_s.strides[0], "members of the same points")
        self.assertTrue(0 < address(map.time_s) - address(map.xyz_m) < map.xyz_m.strides[0])
        with self.assertRaises(ValueError):
            map.xyz_m[0, 0] = 1

    def test_they_outlive_what_they_come_from(self):
        xyz_m = sweepscope.map(room(), 24).xyz_m
        ranges_m = sweepscope.open(room()).ranges_m
        kept = xyz_m.copy(), ranges_m.copy()
        others = [sweepscope.map(room(), 19) for _ in range(3)]  # would take the memory if it were free
        np.testing.assert_array_equal(xyz_m, kept[0])
        np.testing.assert_array_equal(ranges_m, kept[1])
        self.assertEqual(len(others), 3)

    def test_the_curve_is_that_of_the_json_with_nan_for_null(self):
        found = sweepscope.estimate(room(), method="stationary", range=(20, 28, 1))
        curve = sweepscope.curve(found)
        self.assertFalse(curve.offset_ms.flags.owndata)
        for name in curve:
            expected = [np.nan if point[name] is None else point[name] for point in found["curve"]]
            np.testing.assert_array_equal(curve[name], expected, name)
        self.assertTrue(np.isnan(curve.n).all())
        self.assertEqual(curve.offset_ms[np.argmin(curve.d)], 24)

    def test_maps_are_compared_as_they_are(self):
        maps = [sweepscope.map(room(), offset_ms) for offset_ms in (19, 24)]
        maps[0].save(FOLDER / "19.ply")
        picture = sweepscope.compare([*maps, FOLDER / "19.ply"], size=(900, 480))
        self.assertEqual(picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(len(picture.facts["maps"]), 3)


def address(array):
    return array.__array_interface__["data"][0]


def by_pcd(content):
    head, body = content.split(b"DATA binary\n", 1)
    words = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if line[0] != "#"}
    kinds = [f"{kind.lower()}{size}" for kind, size in zip(words["TYPE"], words["SIZE"])]
    return head, np.frombuffer(body, list(zip(words["FIELDS"], kinds)))


if __name__ == "__main__":
    unittest.main()
