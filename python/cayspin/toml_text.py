# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Tables of a scene as TOML text."""

import contextlib
import json
import os
import re

import numpy as np

from cayspin import arguments
from cayspin._cayspin import SceneError

ARRAY = {"given": True}  # stands in the text for an array


def _key(name):
    if not isinstance(name, str):
        raise SceneError(f"{name!r}: is no key of a scene; accepted: a string")
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else value(name, "a key")


def value(thing, key):
    """Returns a value as TOML text on one line. `key`: its name in the message of a SceneError."""
    if isinstance(thing, (np.generic, np.ndarray)):
        thing = thing.tolist()
    if isinstance(thing, np.floating):  # a longdouble, which tolist() does not convert
        thing = float(thing)
    if isinstance(thing, bool):
        return "true" if thing else "false"
    if isinstance(thing, (int, float)):
        return repr(thing)
    if isinstance(thing, os.PathLike):
        thing = os.fspath(thing)
    if isinstance(thing, str):
        if not arguments.is_unicode(thing):
            raise SceneError(f"{key}: {thing!r} is no Unicode text; accepted: a string")
        return json.dumps(thing, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(thing, (list, tuple, range)):
        return "[" + ", ".join(value(entry, key) for entry in thing) + "]"
    if isinstance(thing, dict):
        pairs = (f"{_key(name)} = {value(entry, f'{key}.{name}')}" for name, entry in thing.items())
        return "{ " + ", ".join(pairs) + " }"
    raise SceneError(f"{key}: is of type {type(thing).__name__}; accepted: bool, int, float, str, "
                     "lists and dicts of them, and a function of t for field.applied")


def document(tables):
    """The text of a scene: keys without a table first, then [table] after [table]."""
    lines = [f"{_key(name)} = {value(entry, name)}" for name, entry in tables.items()
             if not isinstance(entry, dict)]
    for name, table in tables.items():
        if isinstance(table, dict):
            lines += ["", f"[{_key(name)}]"]
            lines += [f"{_key(key)} = {value(entry, f'{name}.{key}')}"
                      for key, entry in table.items()]
    return "\n".join(lines).lstrip("\n") + "\n"


def overrides(tables):
    """Returns tables and dotted keys as a list of key.path=VALUE. The keys of a table are changed
    one by one, but [initial] is replaced as a whole, and so is the value of a dotted key that has a
    dict."""
    assignments = []
    for name, entry in tables.items():
        if isinstance(entry, dict) and name != "initial" and "." not in str(name):
            assignments += [f"{name}.{_key(key)}={value(one, f'{name}.{key}')}"
                            for key, one in entry.items()]
        else:
            assignments.append(f"{name}={value(entry, name)}")
    return assignments


@contextlib.contextmanager
def errors_of_overrides():
    """Makes errors name overrides as the caller wrote them: without --set, and with "an array"
    instead of the text that stands for it."""
    try:
        yield
    except SceneError as error:
        message = str(error).removeprefix("--set ").replace(value(ARRAY, ""), "an array")
        raise SceneError(message) from None
