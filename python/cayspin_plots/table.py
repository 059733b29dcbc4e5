# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads the CSV files of `cayspin reproduce`."""

import csv

import numpy as np


def read_table(path, texts, numbers):
    """Returns columns by name: `texts` as arrays of str, `numbers` as arrays of float."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        table = {name: np.array([row[name] for row in rows]) for name in texts}
        table.update({name: np.array([float(row[name]) for row in rows]) for name in numbers})
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise SystemExit(f"{path}: cannot read the table: {error}") from None
    if not rows:
        raise SystemExit(f"{path}: it holds no row")
    return table


def groups(table, *names):
    """Yields (values, part) for each combination of values in the columns `names`, in the order of
    the file. `part` is the table with only the rows that have these values."""
    keys = list(zip(*(table[name] for name in names)))
    for key in dict.fromkeys(keys):
        chosen = np.array([other == key for other in keys])
        part = {name: column[chosen] for name, column in table.items()}
        yield (key if len(names) > 1 else key[0]), part
