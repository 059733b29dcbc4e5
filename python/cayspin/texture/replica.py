# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""One replica of an ensemble's file, which is read as a trajectory."""

OF_REPLICAS = ("spins", "energy", "norm_defect", "magnetization", "sublattice_magnetization",
               "checksum")


def is_ensemble(file):
    return "ensemble_format" in file.attrs


class _Dataset:
    """One replica of a dataset (frame, replica, ..), as a dataset (frame, ..)."""

    def __init__(self, dataset, number):
        self.dataset, self.number = dataset, number
        self.shape = (dataset.shape[0], *dataset.shape[2:])
        self.ndim, self.dtype = len(self.shape), dataset.dtype

    def __len__(self):
        return self.shape[0]

    def __getitem__(self, frame):
        return self.dataset[frame, self.number]


class Replica:
    """One replica of an open file (h5py.File), for drawing it like a trajectory. Raises ValueError
    if there is no such replica."""

    def __init__(self, file, number):
        count = int(file.attrs["replicas"])
        if not -count <= number < count:
            raise ValueError(f"replica {number}; accepted: {-count} to {count - 1}")
        self.file, self.number, self.attrs = file, number % count, file.attrs

    def __contains__(self, name):
        return name in self.file

    def __getitem__(self, name):
        dataset = self.file[name]
        return _Dataset(dataset, self.number) if name in OF_REPLICAS else dataset
