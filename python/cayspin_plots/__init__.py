# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws pictures of cayspin's files (docs/reference/file_format.md) and measurements."""

import logging
import pathlib
import sys

# For `texture` and `command_line`, parts of the package that need nothing compiled.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cayspin"))

import command_line  # noqa: E402, F401

# Silences matplotlib's notes about its cache of fonts.
logging.getLogger("matplotlib").setLevel(logging.ERROR)
