# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The environment of programs that the package starts."""

from __future__ import annotations

import os

# A process with one of these is a rank. src/program/launch/with_mpi.cpp has the same list.
SET_BY_LAUNCHERS = ("PMI_RANK", "PMI_SIZE", "PMIX_RANK", "OMPI_COMM_WORLD_SIZE")


def environment(**more: str) -> dict[str, str]:
    """Returns this process's environment with `more`, in which a program does not become a rank if
    mpiexec has started this process."""
    kept = {name: value for name, value in os.environ.items() if name not in SET_BY_LAUNCHERS}
    return {**kept, **more}
