# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks of arguments. A check returns the value, or raises CayspinError with a one-line message.

A NumPy scalar, or an array without axes, counts as the value that it holds."""

from __future__ import annotations

import operator
import os
import re
from typing import Any, Iterable

import numpy as np

from cayspin._cayspin import CayspinError


def _one(thing: Any) -> Any:
    """Converts a NumPy scalar, or an array without axes, to a Python object."""
    is_numpy = isinstance(thing, (np.generic, np.ndarray))
    return thing.item() if is_numpy and thing.ndim == 0 else thing


def shown(thing: Any) -> str:
    """Returns a value as text for a one-line message, cut to 80 characters."""
    text = " ".join(repr(thing).split())
    return text if len(text) <= 80 else text[:77] + "..."


def without_line(message: str) -> str:
    """Returns a warning without "Scene:LINE: " or "--set " at its start. Neither means anything to
    a caller in Python: LINE counts in a text that was made from tables, and --set is an option of
    the command line."""
    return re.sub(r"^(replica \d+: )?(Scene:\d+: |--set )", r"\1", message)


def whole(number: Any, name: str, bits: int = 64) -> int:
    """Returns a whole number, which must fit into a signed integer of `bits` bits."""
    try:
        if isinstance(number, np.ndarray) and number.ndim:
            raise TypeError
        value = operator.index(_one(number))
    except TypeError:
        raise CayspinError(f"{name}: {shown(number)}; accepted: a whole number") from None
    if not -2**(bits - 1) <= value < 2**(bits - 1):
        raise CayspinError(f"{name}: {value}; accepted: a whole number of {bits} bits")
    return value


def real(number: Any, name: str) -> float:
    """Returns a number as a float. Text is refused."""
    value = _one(number)
    try:
        is_number = hasattr(type(value), "__float__") or hasattr(type(value), "__index__")
        if is_number and not isinstance(value, (np.ndarray, complex, np.complexfloating)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise CayspinError(f"{name}: {shown(number)}; accepted: a number")


def three(values: Any, name: str) -> tuple[float, float, float]:
    """Returns three numbers."""
    array = numbers(values, name)
    if array.shape != (3,):
        raise CayspinError(f"{name} of shape {array.shape}; accepted: three numbers")
    return (float(array[0]), float(array[1]), float(array[2]))


def flag(truth: Any, name: str) -> bool:
    """Returns True or False, which may be given as 1 or 0."""
    value = _one(truth)
    if isinstance(value, (bool, int)) and value in (0, 1):
        return bool(value)
    raise CayspinError(f"{name}: {shown(truth)}; accepted: True or False")


def is_false(thing: Any) -> bool:
    """Whether a value is the False of Python or NumPy. The number 0 and empty values are not."""
    return _one(thing) is False


def wants_stop(answer: Any) -> bool:
    """Whether an observer returned the True of Python or NumPy."""
    if isinstance(answer, np.ndarray) and answer.dtype == bool and answer.ndim:
        raise CayspinError(f"observe: the function returned an array of {answer.size}; "
                           "accepted: one boolean, as from all() or any()")
    return _one(answer) is True


def is_unicode(text: str) -> bool:
    """Whether UTF-8 can encode a string. It cannot if the string has half of a surrogate pair."""
    return not any("\ud800" <= letter <= "\udfff" for letter in text)


def word(text: Any, name: str) -> str:
    """Returns a string, which UTF-8 must be able to encode."""
    value = _one(text)
    if not isinstance(value, str) or not is_unicode(value):
        raise CayspinError(f"{name}: {shown(text)}; accepted: a string")
    return str(value)


def entries(things: Any, name: str, accepted: str) -> list:
    """Returns the entries of a list, a tuple or another iterable. Text, dicts and sets are
    refused."""
    if not isinstance(things, (str, bytes, bytearray, dict, set, frozenset)):
        try:
            return list(things)
        except TypeError:
            pass
    raise CayspinError(f"{name}: {shown(things)}; accepted: {accepted}")


def options(given: Iterable[str], accepted: Iterable[str], name: str) -> None:
    """Raises CayspinError if one of the names in `given` is not in `accepted`."""
    for option in given:
        if option not in accepted:
            raise CayspinError(f"{name}: no option {option}; accepted: {', '.join(accepted)}")


def axes(given: Any) -> Any:
    """Returns the given matplotlib axes, or new ones for None."""
    if given is None:
        import matplotlib.pyplot

        return matplotlib.pyplot.subplots(figsize=(8, 6))[1]
    if not hasattr(given, "quiver"):
        raise CayspinError(f"plot: axes {shown(given)}; accepted: matplotlib axes, or None")
    return given


def file_name(path: Any, name: str) -> str:
    """Returns the name of a file as a string."""
    try:
        text = os.fsdecode(os.fsencode(_one(path)))
    except (TypeError, UnicodeEncodeError):
        raise CayspinError(f"{name}: {shown(path)}; accepted: the name of a file") from None
    if not text:
        raise CayspinError(f"{name}: an empty name; accepted: the name of a file")
    if "\0" in text:
        raise CayspinError(f"{name}: {shown(text)}; accepted: a name without a null character")
    return text


def counted(count: int, what: str) -> str:
    """A text such as "1 site" or "2 sites"."""
    return f"{count} {what}{'' if count == 1 else 's'}"


def numbers(array: Any, name: str) -> np.ndarray:
    """Returns an array of numbers as float32 or float64 with aligned elements, copied only if
    necessary."""
    try:
        array = np.asarray(array)
    except ValueError:
        raise CayspinError(f"{name}: rows of different lengths; accepted: an array") from None
    if array.dtype.kind not in "buif":
        raise CayspinError(f"{name}: an array of {array.dtype}; accepted: one of real numbers")
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    if not array.flags.aligned or any(step % array.itemsize for step in array.strides):
        array = array.copy()
    return array
