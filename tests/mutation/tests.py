# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Which files are mutated, and the smallest tests that ought to see it."""
import typing

SOURCES = ["include/cayspin/stepper/*.hpp", "include/cayspin/observer/*.hpp",
           "src/trajectory/*.cpp", "src/simulation/guard.[ch]pp", "src/program/*.[ch]pp",
           "src/program/sweep/*.[ch]pp", "src/program/trade/*.[ch]pp"]

# These send signals and remove files: broken, they could reach what is not theirs.
EXCLUDED = ["src/program/sweep/child.cpp", "src/program/sweep/session.cpp"]


class Test(typing.NamedTuple):
    target: str
    filter: str = ""


def source(name):
    """tests/NAME.cpp alone, as a program."""
    return Test("mutant_" + name.replace("/", "_"))


def program(tests):
    return Test("program_tests", tests)


# The first that a file's name begins with, below the folder; the last of a folder is the rest.
STEPPERS = {
    "step_control": ["adaptive/step_control", "adaptive/control"],
    "adaptive_": ["adaptive/dense_output", "adaptive/control", "adaptive/orders"],
    "tableau": ["adaptive/orders", "order/high_order", "order/chain"],
    "energy_projection": ["stepper/energy_projection", "wrong_calls/steppers"],
    "implicit": ["stepper/implicit", "order/chain", "wrong_calls/steppers"],
    "newton_krylov": ["stepper/implicit"],
    "red_black": ["stepper/red_black", "wrong_calls/steppers"],
    "exact_flow": ["stepper/red_black"],
    "field_extrapolation": ["field_extrapolation/memory", "field_extrapolation/accuracy",
                            "wrong_calls/steppers"],
    "field_history": ["field_extrapolation/memory", "field_extrapolation/accuracy"],
    "two_point": ["stepper/remembering", "order/chain_sigma", "order/chain_energy",
                  "wrong_calls/steppers"],
    "corrected_euler": ["order/chain_sigma", "order/chain_energy", "oracles/chain"],
    "rate": ["order/chain_sigma", "order/chain_energy", "oracles/chain"],
    "series4": ["order/chain", "order/rigid_body", "oracles/rigid_body"],
    "runge_kutta": ["observer/batches", "stepper/compensated", "backends/sweep",
                    "wrong_calls/steppers"],
    "stepper_base": ["wrong_calls/steppers", "backends/labels"],
    "field_algebra": ["order/chain", "field/composition"],
    "": ["order/chain", "order/rigid_body"],
}
OBSERVERS = {
    "energy_control": ["energy_control/control", "wrong_calls/fields"],
    "normalize": ["observer/normalize", "wrong_calls/fields"],
    "": ["observer/scalars", "observer/energies", "observer/integrate"],
}
TRAJECTORY = [Test("test_trajectory", "-*FullDisk*")]
PROGRAM = {
    "sweep/": program("Sweeping*"),
    "trade": program("Trading*"),
    "export": program("Exporting*"),
    "info": program("Info*:*WrongCommand*"),
    "check": program("Checking*:RefuseUnstable*"),
    "describe": program("Checking*"),
    "watch": program("Watching*"),
    "relax": program("Relax*"),
    "new": program("NewScenes*"),
    "terminal_picture": program("Terminal*:Checking*"),
    "": program("FailingRun*:EarlyEnd*:Running*:Restarting*:OutputFiles*:*WrongCommand*:Terminal*"),
}


def first_of(table, name):
    return next(value for key, value in table.items() if name.startswith(key))


def tests_of(path):
    folder, _, name = path.rpartition("/")
    if folder == "include/cayspin/stepper":
        return [source(test) for test in first_of(STEPPERS, name)]
    if folder == "include/cayspin/observer":
        return [source(test) for test in first_of(OBSERVERS, name)]
    if folder == "src/trajectory":
        return TRAJECTORY
    if path.startswith("src/simulation/guard"):
        return [Test("test_guard")]
    return [first_of(PROGRAM, path.removeprefix("src/program/"))]
