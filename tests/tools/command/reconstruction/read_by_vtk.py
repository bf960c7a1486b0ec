#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads meshes and lines with VTK and prints what it finds; shares no code with the program.

usage: read_by_vtk.py FILE ...
Per file one line of JSON: name, points, triangles, lines, bounds, volume of a closed mesh, and for each point array of a
.vtp its name with the least and greatest value. The exit code is 1 when VTK reports an error.
"""
import json
import sys

import vtk

READERS = {".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader, ".vtp": vtk.vtkXMLPolyDataReader}


def main(files):
    errors = []
    for file in files:
        reader = READERS[file[-4:]]()
        reader.AddObserver("ErrorEvent", lambda *_: errors.append(file))
        reader.SetFileName(file)
        reader.Update()
        data = reader.GetOutput()
        found = {"name": file, "points": data.GetNumberOfPoints(), "triangles": data.GetNumberOfPolys(),
                 "lines": data.GetNumberOfLines(), "bounds": data.GetBounds()}
        if data.GetNumberOfPolys():
            mass = vtk.vtkMassProperties()
            mass.SetInputData(data)
            mass.Update()
            found["volume"] = mass.GetVolume()
        arrays = data.GetPointData()
        found["arrays"] = {arrays.GetArrayName(n): arrays.GetArray(n).GetRange()
                           for n in range(arrays.GetNumberOfArrays()) if arrays.GetArray(n)}
        print(json.dumps(found))
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
