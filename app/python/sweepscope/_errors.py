"""Errors as exceptions. Wrong usage is a ValueError or, for a keyword that does not exist, a TypeError."""

import re

_FLAGS = ("again", "far", "imu", "laser_upside_down", "speed_ramp", "tf", "trajectory_upright")


def in_python(sentence):
    """The sentence with keywords for the options of the command line: weight_c for --weight-c, again=True for --again."""

    def keyword(option):
        name = option[1].replace("-", "_")
        return name + "=True" if name in _FLAGS else name

    return re.sub(r"(?<![\w-])--([a-z][a-z0-9]*(?:-[a-z0-9]+)*)", keyword, sentence)


class Error(Exception):
    """An expected failure; its text is the sentence that the program `sweepscope` prints."""


class InputError(Error):
    """A file cannot be read (exit code 3 of the program). The sentence names the file and the place in it."""


class CannotAnswer(Error):
    """The recording does not determine the offset (exit code 4 of the program).

    reasons: why, whole sentences.
    estimate: the sweepscope.Estimate with all its evidence, where an estimate was asked for; otherwise None.
    """

    def __init__(self, message, reasons=None, estimate=None):
        super().__init__(message)
        self.reasons = [message] if reasons is None else reasons
        self.estimate = estimate
