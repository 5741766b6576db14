"""The message if a library that the engine loads is not installed."""

PACKAGES = ""  # of Debian, with the libraries that the engine loads; a wheel names those of the machine that made it


def words_for(error):
    cure = f"apt install {PACKAGES}" if PACKAGES else "the Debian package python3-sweepscope brings them"
    return f"{error}. sweepscope needs libraries of Debian 12 that are not installed here: {cure}"
