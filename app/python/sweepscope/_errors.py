"""Errors as exceptions. Wrong usage is a ValueError or, for a keyword that does not exist, a TypeError."""


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
