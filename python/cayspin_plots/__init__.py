# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Pictures of cayspin's trajectory files (docs/reference/file_format.md)."""
