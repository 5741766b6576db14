"""Keywords from the engine's tables of options: names, checks and help are declared there once."""

import difflib
import inspect
import os
from numbers import Real

_KINDS = inspect.Parameter


def keyword_of(name):
    """The Python keyword of an option: "weight-c" is weight_c."""
    return name.replace("-", "_")


def _text(value, separator):
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, int)):
        return str(value).lower()
    if isinstance(value, Real):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, dict):
        return ",".join(f"{key}={_text(item, separator)}" for key, item in value.items())
    return separator.join(_text(item, separator) for item in value)


def _separator(option):
    if option["type"] == "WxH":
        return "x"
    return ":" if ":" in option["type"] else ","


def _is_one(value):
    """Whether the value of an option that repeats is a single one: text, or a tuple of numbers."""
    return isinstance(value, str) or all(isinstance(item, Real) for item in value)


def _texts_of(option, value):
    if option.get("value_optional") and isinstance(value, bool):
        return [""] if value else []
    separator = _separator(option)
    if option["repeats"] and not _is_one(value):
        return [_text(item, separator) for item in value]
    return [_text(value, separator)]


def texts(function, options, given):
    """The words of options and their texts, as on the command line. None: not given."""
    return [
        (option["name"], text)
        for option, value in known(function, options, given)
        for text in _texts_of(option, value)
    ]


def known(function, options, given):
    """Each option that was given, with its value. A keyword that does not exist is a TypeError."""
    declared = {keyword_of(option["name"]): option for option in options}
    for keyword in given:
        if keyword not in declared:
            near = difflib.get_close_matches(keyword, list(declared), 1)
            hint = f". Did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"{function}() got an unexpected keyword argument {keyword!r}{hint}")
    return [(declared[keyword], value) for keyword, value in given.items() if value is not None]


def _described(option):
    shape = f"{option['type']}. " if option["type"] else ""
    default = option.get("default")
    shown = f" (default: {default})" if isinstance(default, (str, int, float)) and default != "" else ""
    return shape + option["help"] + shown


def takes(options):
    """Completes a function that ends in **options: its signature and its help name each of them."""

    def complete(function):
        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind != _KINDS.VAR_KEYWORD]
        more = [_KINDS(keyword_of(option["name"]), _KINDS.KEYWORD_ONLY, default=None) for option in options]
        function.__signature__ = signature.replace(parameters=own + more)
        lines = [f"    {keyword_of(option['name'])}: {_described(option)}" for option in options]
        function.__doc__ = (function.__doc__ or "").rstrip() + "\n\n" + "\n".join(lines) + "\n"
        return function

    return complete
