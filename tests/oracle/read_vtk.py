"""Reads a VTP or legacy VTK file with VTK's own reader, puts tubes about its lines at once, and
prints JSON of what it found.

    read_vtk.py FILE
"""
import json
import math
import sys

from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkFiltersCore import vtkTubeFilter
from vtkmodules.vtkIOLegacy import vtkPolyDataReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

reader = (vtkXMLPolyDataReader if sys.argv[1].endswith("vtp") else vtkPolyDataReader)()
reader.SetFileName(sys.argv[1])
reader.Update()
data = reader.GetOutput()
values = data.GetPointData()
names = [values.GetArrayName(i) for i in range(values.GetNumberOfArrays())]
radius = values.GetArray("radius")
length = volume = 0
ids = vtkIdList()
lines = data.GetLines()
lines.InitTraversal()
while lines.GetNextCell(ids):
    for k in range(1, ids.GetNumberOfIds()):
        a, b = (data.GetPoint(ids.GetId(i)) for i in (k - 1, k))
        length += math.dist(a, b)
        volume += math.pi * radius.GetValue(ids.GetId(k)) ** 2 * math.dist(a, b)

values.SetActiveScalars("radius")
tubes = vtkTubeFilter()
tubes.SetInputData(data)
tubes.SetNumberOfSides(24)
tubes.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
tubes.Update()
texts = data.GetFieldData().GetAbstractArray("corcast")
json.dump({
    "points": data.GetNumberOfPoints(),
    "verts": data.GetNumberOfVerts(),
    "lines": data.GetNumberOfLines(),
    "arrays": names,
    "sums": {name: math.fsum(values.GetArray(name).GetValue(i)
                             for i in range(data.GetNumberOfPoints())) for name in names},
    "length_mm": length,
    "volume_mm3": volume,
    "tube_strips": tubes.GetOutput().GetNumberOfStrips(),
    "tube_bounds": tubes.GetOutput().GetBounds(),
    "remarks": [texts.GetValue(i) for i in range(texts.GetNumberOfValues())] if texts else None,
}, sys.stdout)
