"""Run by pvpython: opens series with each of ParaView's XDMF readers and prints what it sees as JSON.

usage: pvpython paraview_series.py result.json file.xdmf ...
"""
import json
import sys

from paraview import servermanager
from paraview.simple import IntegrateVariables, Xdmf3ReaderS, Xdmf3ReaderT, XDMFReader
from vtkmodules.util.numpy_support import vtk_to_numpy


def look(reader, volume):
    reader.UpdatePipelineInformation()
    seen = []
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        data = servermanager.Fetch(reader)
        while data.IsA("vtkMultiBlockDataSet"):
            data = data.GetBlock(0)
        points = data.GetPointData()
        sums = {points.GetArrayName(k): [float(v) for v in vtk_to_numpy(points.GetArray(k)).reshape(data.GetNumberOfPoints(), -1).sum(axis=0)] for k in range(points.GetNumberOfArrays())}
        moment = {"time": time, "points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(), "sums": sums, "bounds": list(data.GetBounds())}
        if volume:
            whole = IntegrateVariables(Input=reader)
            whole.UpdatePipeline(time)
            total = servermanager.Fetch(whole).GetCellData().GetArray("Volume")
            moment["volume"] = total.GetValue(0) if total else None
        seen.append(moment)
    return seen


def main():
    answer = {}
    for file in sys.argv[2:]:
        answer[file] = {}
        for name, make in (("XDMFReader", lambda: XDMFReader(FileNames=[file])), ("Xdmf3ReaderT", lambda: Xdmf3ReaderT(FileName=[file])), ("Xdmf3ReaderS", lambda: Xdmf3ReaderS(FileName=[file]))):
            answer[file][name] = look(make(), "fluid" in file)
    with open(sys.argv[1], "w") as out:
        json.dump(answer, out)


main()
