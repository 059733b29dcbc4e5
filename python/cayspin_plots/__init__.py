# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Pictures of cayspin's trajectory files (docs/reference/file_format.md)."""

import pathlib
import sys

# For `texture`, a part of the package that needs nothing compiled.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cayspin"))
