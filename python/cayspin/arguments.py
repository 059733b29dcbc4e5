# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""What functions of the package are called with, or one line about what is wrong with it."""

from __future__ import annotations

import operator
import os
from typing import Any

import numpy as np

from cayspin._cayspin import CayspinError


def whole(number: Any, name: str, bits: int = 64) -> int:
    """A whole number of so many bits."""
    try:
        value = operator.index(number)
    except TypeError:
        raise CayspinError(f"{name}: {number!r}; accepted: a whole number") from None
    if not -2**(bits - 1) <= value < 2**(bits - 1):
        raise CayspinError(f"{name}: {value}; accepted: a whole number of {bits} bits")
    return value


def real(number: Any, name: str) -> float:
    """A number, no text."""
    try:
        if not isinstance(number, (str, bytes)):
            return float(number)
    except (TypeError, ValueError, OverflowError):
        pass
    raise CayspinError(f"{name}: {number!r}; accepted: a number")


def is_unicode(text: str) -> bool:
    """Whether a string has no half of a surrogate pair, which UTF-8 does not have."""
    return not any("\ud800" <= letter <= "\udfff" for letter in text)


def word(text: Any, name: str) -> str:
    """A string."""
    if not isinstance(text, str) or not is_unicode(text):
        raise CayspinError(f"{name}: {text!r}; accepted: a string")
    return text


def file_name(path: Any, name: str) -> str:
    """The name of a file."""
    try:
        text = os.fsdecode(os.fsencode(path))
    except (TypeError, UnicodeEncodeError):
        raise CayspinError(f"{name}: {path!r}; accepted: the name of a file") from None
    if "\0" in text:
        raise CayspinError(f"{name}: {text!r}; accepted: a name without a null character")
    return text


def numbers(array: Any, name: str) -> np.ndarray:
    """A numpy array of float32 or float64 in whole, aligned steps; of these it is no copy."""
    try:
        array = np.asarray(array)
    except ValueError:
        raise CayspinError(f"{name}: rows of other lengths; accepted: an array") from None
    if array.dtype.kind not in "buif":
        raise CayspinError(f"{name}: an array of {array.dtype}; accepted: one of real numbers")
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    if not array.flags.aligned or any(step % array.itemsize for step in array.strides):
        array = array.copy()
    return array
