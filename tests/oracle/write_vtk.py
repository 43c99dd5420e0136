"""Writes one network with VTK's own writers, in every version and encoding that they have.

    write_vtk.py FOLDER    prints the names of the files
"""
import sys

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import (VTK_LINE, VTK_POLY_LINE, VTK_TRIANGLE, vtkCellArray,
                                           vtkPolyData, vtkUnstructuredGrid)
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

# A trunk 0 1 2, branches 2 3 4 and 2 5, a triangle beside it.
POINTS = [(0, 0, 0), (1.5, 0.25, 0), (3, 0, 0.5), (4, 1, 1), (5, 2, 1.25), (4, -1, -0.5)]
LINES = [(0, 1, 2), (2, 3, 4), (2, 5)]
RADII = [1.625, 1.5, 1.375, 0.75, 0.625, 0.5]
PRESSURES = [100.5, 98, 95.25, 93, 92.125, 91]


def array(name, values):
    made = vtkDoubleArray()
    made.SetName(name)
    for value in values:
        made.InsertNextValue(value)
    return made


def fill(data, kind):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for point in POINTS:
        points.InsertNextPoint(point)
    data.SetPoints(points)
    data.GetPointData().AddArray(array("Vessel Radius", RADII))
    data.GetPointData().SetScalars(array("pressure [Pa]", PRESSURES))
    # VTK counts vertices, lines, then polygons.
    cells = 5 if kind is vtkPolyData else 4
    data.GetCellData().AddArray(array("flow", [8.5, 7.5, 6.25, 5.125, 4.5][-cells:]))
    territories = vtkStringArray()
    territories.SetName("territory")
    for cell in range(cells):
        territories.InsertNextValue(f"left anterior descending {cell}")
    data.GetCellData().AddArray(territories)
    words = vtkStringArray()
    words.SetName("words")
    words.InsertNextValue("a b")
    words.InsertNextValue("c%d")
    data.GetFieldData().AddArray(words)
    return data


def poly_data():
    data = vtkPolyData()
    verts, lines, polys = vtkCellArray(), vtkCellArray(), vtkCellArray()
    verts.InsertNextCell(1, (0,))
    for line in LINES:
        lines.InsertNextCell(len(line), line)
    polys.InsertNextCell(3, (0, 1, 2))
    data.SetVerts(verts)
    data.SetLines(lines)
    data.SetPolys(polys)
    return fill(data, vtkPolyData)


def grid():
    data = vtkUnstructuredGrid()
    for line in LINES:
        data.InsertNextCell(VTK_LINE if len(line) == 2 else VTK_POLY_LINE, len(line), line)
    data.InsertNextCell(VTK_TRIANGLE, 3, (0, 1, 2))
    return fill(data, vtkUnstructuredGrid)


def write(writer, data, name):
    writer.SetInputData(data)
    writer.SetFileName(f"{sys.argv[1]}/{name}")
    assert writer.Write() == 1
    print(name)


def legacy():
    for data, make in ((poly_data(), vtkPolyDataWriter), (grid(), vtkUnstructuredGridWriter)):
        for version in (42, 51):
            for binary in (False, True):
                writer = make()
                writer.SetFileVersion(version)
                (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
                write(writer, data, f"{data.GetClassName()}-{version}-{binary}.vtk")


def xml():
    for data, make, extension in ((poly_data(), vtkXMLPolyDataWriter, "vtp"),
                                  (grid(), vtkXMLUnstructuredGridWriter, "vtu")):
        for mode in ("Ascii", "Binary", "Appended"):
            for packed in (False, True):
                for encoded in (False, True):
                    for wide in (False, True):
                        for big in (False, True):
                            if mode != "Appended" and encoded or mode == "Ascii" and packed:
                                continue
                            writer = make()
                            getattr(writer, f"SetDataModeTo{mode}")()
                            writer.SetEncodeAppendedData(encoded)
                            writer.SetBlockSize(32)
                            (writer.SetHeaderTypeToUInt64 if wide else
                             writer.SetHeaderTypeToUInt32)()
                            (writer.SetByteOrderToBigEndian if big else
                             writer.SetByteOrderToLittleEndian)()
                            if packed:
                                writer.SetCompressorTypeToZLib()
                            else:
                                writer.SetCompressorTypeToNone()
                            write(writer, data, f"{mode}-{packed}-{encoded}-{wide}-{big}"
                                                f".{extension}")


legacy()
xml()
