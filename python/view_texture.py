#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""`cayspin view` starts this script, which runs the package's viewer. It needs nothing compiled."""

import pathlib
import sys
import types

package = types.ModuleType("cayspin")  # without its compiled part
package.__path__ = [str(pathlib.Path(__file__).resolve().parent / "cayspin")]
sys.modules["cayspin"] = package

from cayspin.view.__main__ import main  # noqa: E402

if __name__ == "__main__":
    main()
