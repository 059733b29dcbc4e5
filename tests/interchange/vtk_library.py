# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The XDMF file of a run as VTK's reader sees it, beside the HDF5 file as h5py reads it."""

import xml.etree.ElementTree

import numpy as np
from interchange_test import SHAPE, SPACING, InterchangeTest, main
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader


class VtkLibrary(InterchangeTest):
    def test_times_grid_and_vectors_are_those_of_the_trajectory(self):
        for precision in ("double", "single"):
            file = self.run_scene(f"{precision}.h5", "--precision", precision, "--set",
                                  "output.xdmf=true")
            xdmf = file.with_suffix(".xdmf")
            xml.etree.ElementTree.parse(xdmf)
            reader = vtkXdmfReader()
            reader.SetFileName(str(xdmf))
            reader.UpdateInformation()
            times = reader.GetOutputInformation(0).Get(
                vtkStreamingDemandDrivenPipeline.TIME_STEPS())
            self.assertEqual(times, tuple(self.dataset(file, "time")))
            spins = self.dataset(file, "spins")
            for time, expected in zip(times, spins):
                reader.UpdateTimeStep(time)
                grid = reader.GetOutputDataObject(0)
                self.assertEqual(grid.GetDimensions(), SHAPE)
                self.assertEqual(grid.GetSpacing(), SPACING)
                self.assertEqual(grid.GetOrigin(), tuple(np.divide(SPACING, 2)))
                vectors = grid.GetPointData().GetArray("m")
                site = grid.FindPoint(0.25 + 0.5 * 4, 0.5 + 1.0 * 2, 1.0 + 2.0 * 1)
                self.assertEqual(vectors.GetTuple(site), tuple(expected[1, 2, 4]))
                np.testing.assert_array_equal(vtk_to_numpy(vectors), expected.reshape(-1, 3))


main()
