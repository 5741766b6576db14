"""What goes wrong is an exception, with the program's sentence."""

import copy
import multiprocessing
import pickle
import unittest

import sweepscope
from support import FOLDER, program, program_json, room, stuck


def sentence(*words, exit_code):
    """What the program says on stderr, without its name."""
    return program(*words, exit_code=exit_code).stderr.strip().removeprefix("sweepscope: ")


class Errors(unittest.TestCase):
    def test_a_missing_file_is_an_input_error(self):
        missing = FOLDER / "missing.bag"
        with self.assertRaises(sweepscope.InputError) as raised:
            sweepscope.open(missing)
        self.assertEqual(str(raised.exception), sentence("info", missing, exit_code=3))

    def test_a_cut_file_is_an_input_error_that_names_the_place(self):
        cut = FOLDER / "cut.bag"
        cut.write_bytes(room().read_bytes()[:3000])
        with self.assertRaises(sweepscope.InputError) as raised:
            sweepscope.estimate(cut)
        self.assertEqual(str(raised.exception), sentence("estimate", cut, exit_code=3))

    def test_a_recording_that_cannot_answer_says_why_and_holds_the_estimate(self):
        with self.assertRaises(sweepscope.CannotAnswer) as raised:
            sweepscope.estimate(stuck())
        expected = program_json("estimate", stuck(), exit_code=4)
        self.assertEqual(raised.exception.reasons, expected["reasons"])
        self.assertEqual(raised.exception.estimate["reasons"], expected["reasons"])
        self.assertIsNone(raised.exception.estimate.offset_ms)
        for reason in expected["reasons"]:
            self.assertIn(reason, str(raised.exception))

    def test_a_map_that_cannot_be_built_says_why(self):
        with self.assertRaises(sweepscope.CannotAnswer) as raised:
            sweepscope.map(stuck(), 24)
        said = sentence("map", stuck(), "--offset-ms", "24", "-o", "no.pcd", exit_code=4)
        self.assertEqual(str(raised.exception), said)
        self.assertEqual(raised.exception.reasons, [said])

    def test_wrong_usage_is_a_value_error_with_the_programs_sentence(self):
        with self.assertRaises(ValueError) as raised:
            sweepscope.estimate(room(), range=(-1000, 1000, 1))
        self.assertEqual(
            str(raised.exception), sentence("estimate", room(), "--range", "-1000:1000:1", exit_code=2)
        )
        for keywords, words in (
            ({"method": "fast"}, "takes stationary, moving, direct"),
            ({"range": "19:29"}, "needs FROM:TO:STEP in milliseconds"),
            ({"weight_c": -1}, "needs a number of at least 0"),
            ({"assume": "flying"}, "stationary or moving"),
            ({"threads": 5000}, "1 to 1024"),
            ({"trust_poses": True}, "needs poses"),
            ({"over_time": 3, "method": "stationary"}, "direct method"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                sweepscope.estimate(room(), **keywords)

    def test_a_keyword_that_does_not_exist_is_a_type_error_that_names_the_nearest(self):
        with self.assertRaisesRegex(TypeError, "'rnage'. Did you mean 'range'"):
            sweepscope.estimate(room(), rnage=(19, 29, 1))
        with self.assertRaisesRegex(TypeError, "Did you mean 'noise_mm'"):
            sweepscope.simulate("room-1", FOLDER / "no.bag", nois_mm=3)
        with self.assertRaisesRegex(TypeError, "Did you mean 'colour_by'"):
            sweepscope.compare(room(), [19, 24], color_by="time")

    def test_options_of_pictures_and_windows_are_checked_before_the_work(self):
        with self.assertRaisesRegex(ValueError, "two to four offsets"):
            sweepscope.compare(room(), [24])
        with self.assertRaisesRegex(ValueError, "colour-table"):
            sweepscope.compare(room(), [19, 24], colour_table="jet")
        with self.assertRaisesRegex(ValueError, "A less than B"):
            sweepscope.open(room(), window_s=(3, 2))

    def test_no_output_takes_the_place_of_an_input(self):
        before = room().read_bytes()
        with self.assertRaisesRegex(ValueError, "room.bag"):
            sweepscope.apply(room(), room(), offset_ms=24)
        with self.assertRaises(ValueError):
            sweepscope.apply(room(), FOLDER / "a.bag")
        with self.assertRaisesRegex(ValueError, "no-folder"):
            sweepscope.map(room(), 24).save(FOLDER / "no-folder" / "map.pcd")
        self.assertEqual(room().read_bytes(), before)

    def test_an_offset_is_not_applied_twice(self):
        sweepscope.apply(room(), FOLDER / "once.bag", offset_ms=24)
        with self.assertRaises(ValueError) as raised:
            sweepscope.apply(FOLDER / "once.bag", FOLDER / "twice.bag", offset_ms=24)
        said = sentence("apply", FOLDER / "once.bag", "-o", "twice.bag", "--offset-ms", "24", exit_code=2)
        self.assertEqual(str(raised.exception), said.replace("--again", "again=True"))
        self.assertFalse((FOLDER / "twice.bag").exists())

    def test_wrong_usage_names_keywords_and_not_options_of_the_command_line(self):
        for call, words in (
            (lambda: sweepscope.estimate(room(), weight_c=-1), "^weight_c needs a number"),
            (lambda: sweepscope.simulate("room-1", FOLDER / "no.bag", imu_shift_ms=3), "^imu_shift_ms needs imu=True"),
            (lambda: sweepscope.simulate("room-1", FOLDER / "no.bag", beam_times="back"), "^beam_times needs one of"),
            (lambda: sweepscope.apply(room(), FOLDER / "no.bag", offset_ms=24000), "with far=True$"),
        ):
            with self.assertRaisesRegex(ValueError, words) as raised:
                call()
            self.assertNotIn("--", str(raised.exception))

    def test_an_offset_beyond_the_motors_period_is_applied_if_asked_for(self):
        done = sweepscope.apply(room(), FOLDER / "far.bag", offset_ms=24000, far=True)
        self.assertEqual(done["record"]["offset_ms"], 24000)

    def test_errors_are_pickled_with_their_reasons(self):
        try:
            sweepscope.estimate(stuck())
        except sweepscope.CannotAnswer as error:
            for other in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):
                self.assertEqual(str(other), str(error))
                self.assertEqual(other.reasons, error.reasons)
                self.assertEqual(dict(other.estimate), dict(error.estimate))

    def test_a_pool_of_processes_gives_the_reasons(self):
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            self.assertEqual(pool.map(sweepscope.estimate, [room()])[0].method, "direct")
            with self.assertRaises(sweepscope.CannotAnswer) as raised:
                pool.map(sweepscope.estimate, [stuck()])
        self.assertGreater(len(raised.exception.reasons), 0)
        self.assertIsNone(raised.exception.estimate.offset_ms)

    def test_every_expected_failure_is_a_sweepscope_error(self):
        self.assertTrue(issubclass(sweepscope.InputError, sweepscope.Error))
        self.assertTrue(issubclass(sweepscope.CannotAnswer, sweepscope.Error))


if __name__ == "__main__":
    unittest.main()
