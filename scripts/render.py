"""A picture of a run by ParaView (pvbatch): particles coloured by speed, beside them a slice of the fluid; see scripts/render."""
import argparse
import math
import os
import sys

from paraview import servermanager
from paraview.simple import *  # noqa: F403  ParaView's own idiom: its sources and filters are made at run time

INK = [0.13, 0.13, 0.16]
# From blue over green to red, without the dark ends that shading would turn black.
SPEED_COLOURS = [0.0, 0.17, 0.37, 0.72, 0.25, 0.15, 0.66, 0.76, 0.5, 0.56, 0.81, 0.42, 0.75, 0.98, 0.75, 0.26, 1.0, 0.85, 0.21, 0.13]


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/render")
    parser.add_argument("directory")
    parser.add_argument("picture", nargs="?")
    parser.add_argument("-time", "--time", type=float)  # pvbatch hands on the second form
    parser.add_argument("-field", "--field")
    parser.add_argument("-size", "--size", default="1600x1200")
    given = parser.parse_args()
    given.picture = given.picture or os.path.join(given.directory, "render.png")
    words = given.size.split("x")
    if len(words) != 2 or not all(word.isdigit() and int(word) > 0 for word in words):
        sys.exit(f"render: error: -size {given.size}: width and height in pixels, as in 1600x1200")
    given.size = [int(word) for word in words]
    return given


def open_series(path):
    """The reader of a series, or None where the case has none."""
    if not os.path.exists(path):
        return None
    reader = Xdmf3ReaderS(FileName=[path])
    reader.UpdatePipeline()
    return reader


def series_time(readers, wanted):
    """The output nearest to the time asked for; the last one by default."""
    times = sorted({t for r in readers if r for t in (r.TimestepValues if hasattr(r.TimestepValues, "__iter__") else [r.TimestepValues])})
    if not times:
        sys.exit("render: error: the series hold no output yet")
    return times[-1] if wanted is None else min(times, key=lambda t: abs(t - wanted))


def point_arrays(source):
    info = source.GetPointDataInformation()
    return {info.GetArray(k).GetName(): info.GetArray(k) for k in range(info.GetNumberOfArrays())}


def magnitude_range(array):
    return array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0)


def nice_top(value):
    """The next round number above: a colour bar ends where one can read it."""
    if value <= 0:
        return 1.0
    power = 10 ** math.floor(math.log10(value))
    return next(m * power for m in (1, 1.5, 2, 3, 4, 5, 6, 8, 10) if m * power >= value * 0.999)


def letters(view, size):
    """A size of letters that is meant for a view 800 pixels wide: narrower views have smaller ones, or words are cut off."""
    return max(6, round(size * min(1, view.ViewSize[0] / 800)))


def colour(display, view, name, title, low, high, preset, position, vector):
    ColorBy(display, ("POINTS", name, "Magnitude") if vector else ("POINTS", name))
    table = GetColorTransferFunction(name, display, separate=True)
    display.LookupTable = table
    if preset:
        table.ApplyPreset(preset, True)
    else:
        table.RGBPoints, table.ColorSpace = SPEED_COLOURS, "Lab"
    table.RescaleTransferFunction(low, high)
    bar = GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize = letters(view, 20), letters(view, 18)
    bar.HorizontalTitle = True
    bar.Orientation, bar.WindowLocation, bar.Position = "Vertical", "Any Location", position
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.4, letters(view, 22)
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = False, "%.3g", "%.3g"
    bar.Visibility = True
    return bar


def new_view(size):
    view = CreateRenderView(ViewSize=size)
    view.UseColorPaletteForBackground = False
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = False
    view.UseFXAA = True
    view.CameraParallelProjection = True
    return view


def outline(box, view):
    frame = Box(XLength=max(box[1] - box[0], 1e-12), YLength=max(box[3] - box[2], 1e-12), ZLength=max(box[5] - box[4], 1e-12),
                Center=[(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2])
    shown = Show(frame, view)
    shown.Representation = "Outline"
    shown.AmbientColor = shown.DiffuseColor = [0.55, 0.55, 0.6]
    shown.LineWidth = 1.5


def look(view, box, axis, tilt):
    """Looks along `axis` with the tall direction up; everything in the box is in the picture, with a margin for the bar."""
    centre = [(box[2 * d] + box[2 * d + 1]) / 2 for d in range(3)]
    size = [box[2 * d + 1] - box[2 * d] for d in range(3)]
    up = 2 if axis != 2 else 1
    across = next(d for d in range(3) if d not in (axis, up))
    reach = math.sqrt(sum(s * s for s in size)) * 3
    direction = [0.0, 0.0, 0.0]
    direction[axis] = -1.0 if axis == 1 else 1.0
    direction[across] += tilt
    direction[up] += 0.7 * tilt
    length = math.sqrt(sum(c * c for c in direction))
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[d] + reach * direction[d] / length for d in range(3)]
    view.CameraViewUp = [1.0 if d == up else 0.0 for d in range(3)]
    aspect = view.ViewSize[0] / view.ViewSize[1]
    high = size[up] + 2 * tilt * size[axis]
    wide = (size[across] + 2 * tilt * size[axis]) / aspect
    view.CameraParallelScale = 0.5 * max(high * 1.22, wide * 1.75)
    # Left of the middle: the colour bar stands at the right edge.
    shift = 0.11 * 2 * view.CameraParallelScale * aspect
    right = [0.0, 0.0, 0.0]
    right[across] = 1.0
    view.CameraFocalPoint = [centre[d] + shift * right[d] for d in range(3)]
    view.CameraPosition = [view.CameraPosition[d] + shift * right[d] for d in range(3)]


def caption(view, text, place="Upper Center"):
    words = Text(Text=text)
    shown = Show(words, view)
    shown.WindowLocation, shown.FontSize, shown.Color, shown.Bold = place, letters(view, 22), INK, 0


def draw_particles(particles, view, box, axis, time):
    arrays = point_arrays(particles)
    size = next((n for n in ("radius", "diameter") if n in arrays), None)
    speed = next((n for n in ("velocity",) if n in arrays), None)
    shown = Show(particles, view)
    # Spheres drawn by the shader: a million of them cost no triangles.
    shown.Representation = "Point Gaussian"
    shown.ShaderPreset = "Sphere"
    shown.GaussianRadius = 1.0 if size == "radius" else 0.5
    if size:
        shown.ScaleByArray, shown.UseScaleFunction, shown.SetScaleArray = True, False, ["POINTS", size]
    else:
        shown.GaussianRadius = 0.005 * max(box[1] - box[0], box[5] - box[4])
    if speed:
        top = nice_top(robust_top(particles, speed))
        colour(shown, view, speed, "particle speed\n(m/s)\n", 0, top, None, [0.80, 0.28], True)
    else:
        shown.DiffuseColor = [0.8, 0.6, 0.35]
    count = particles.GetDataInformation().GetNumberOfPoints()
    outline(box, view)
    look(view, box, axis, 0.22 if box[2 * axis + 1] > box[2 * axis] else 0.0)  # a plane is not looked at askew
    caption(view, f"{count} particle{'s' if count != 1 else ''}, t = {time:.4g} s")


def robust_top(source, name):
    """The 99.5 % quantile of the magnitude, so that one stray particle does not make the rest uniformly dark."""
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy

    data = servermanager.Fetch(source)
    blocks = [data.GetBlock(k) for k in range(data.GetNumberOfBlocks())] if hasattr(data, "GetNumberOfBlocks") else [data]
    values = []
    for block in blocks:
        array = block.GetPointData().GetArray(name) if block else None
        if array is not None and array.GetNumberOfTuples():
            v = vtk_to_numpy(array)
            values.append(np.sqrt((v * v).sum(axis=1)) if v.ndim == 2 else np.abs(v))
    return float(np.quantile(np.concatenate(values), 0.995)) if values else 0.0


TITLES = {"void_fraction": "void fraction\n", "velocity": "gas speed\n(m/s)\n", "pressure": "pressure\n(Pa)\n"}


def draw_fluid(fluid, view, box, axis, field, time):
    arrays = point_arrays(fluid)
    if field and field not in arrays:
        sys.exit(f"render: error: the fluid has no array '{field}'; there are: {' '.join(sorted(arrays))}")
    if not field:
        varies = lambda n: n in arrays and arrays[n].GetRange(0)[1] - arrays[n].GetRange(0)[0] > 1e-6
        field = "void_fraction" if varies("void_fraction") else "velocity" if "velocity" in arrays else sorted(arrays)[0]
    flat = box[2 * axis + 1] - box[2 * axis] < 1e-12
    cut = fluid
    if not flat:
        cut = Slice(Input=fluid, SliceType="Plane")
        cut.SliceType.Origin = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2]
        cut.SliceType.Normal = [1.0 if d == axis else 0.0 for d in range(3)]
    shown = Show(cut, view)
    shown.Representation = "Surface"
    shown.Ambient, shown.Diffuse, shown.Specular = 1.0, 0.0, 0.0
    cut.UpdatePipeline()
    array = point_arrays(cut)[field]
    vector = array.GetNumberOfComponents() > 1
    low, high = magnitude_range(array)
    if field == "void_fraction":
        low, high, preset = min(0.35, math.floor(low * 20) / 20), 1.0, "Viridis (matplotlib)"
    elif vector:
        low, high, preset = 0.0, nice_top(robust_top(cut, field)), "Inferno (matplotlib)"
    else:
        preset = "Cool to Warm"
    if high <= low:
        high = low + 1
    colour(shown, view, field, TITLES.get(field, field + "\n"), low, high, preset, [0.80, 0.28], vector)
    outline(box, view)
    look(view, box, axis, 0.0)
    caption(view, f"{'slice through the middle' if not flat else 'fluid'}, t = {time:.4g} s")


def main():
    given = arguments()
    fluid = open_series(os.path.join(given.directory, "fluid.xdmf"))
    particles = open_series(os.path.join(given.directory, "particles.xdmf"))
    time = series_time([fluid, particles], given.time)
    scene = GetAnimationScene()
    scene.AnimationTime = time
    for source in (fluid, particles):
        if source:
            source.UpdatePipeline(time)
    if particles and particles.GetDataInformation().GetNumberOfPoints() == 0:
        particles = None
    if not (fluid or particles):
        sys.exit("render: error: neither particles nor fluid to draw")
    box = list((fluid or particles).GetDataInformation().GetBounds())
    if not fluid:  # the spheres, not their centres alone
        arrays = point_arrays(particles)
        radius = arrays["radius"].GetRange(0)[1] if "radius" in arrays else 0
        box = [edge + (radius if k % 2 else -radius) for k, edge in enumerate(box)]
    sizes = [box[2 * d + 1] - box[2 * d] for d in range(3)]
    # Along the thinnest direction; a box as thick as it is wide is looked at along y.
    axis = min((1, 0, 2), key=lambda d: round(sizes[d] / max(sizes), 3) if sizes[d] < 0.999 * min(s for k, s in enumerate(sizes) if k != d) or d == 1 else 9)
    drawn = [p for p in (("particles", particles), ("fluid", fluid)) if p[1]]
    width, height = given.size
    views = []
    for kind, source in drawn:
        view = new_view([width // len(drawn), height])
        if kind == "particles":
            draw_particles(source, view, box, axis, time)
        else:
            draw_fluid(source, view, box, axis, given.field, time)
        view.ViewTime = time
        views.append(view)
    layout = CreateLayout("picture")
    layout.SplitHorizontal(0, 0.5) if len(views) > 1 else None
    for k, view in enumerate(views):
        layout.AssignView(k + 1 if len(views) > 1 else 0, view)
    layout.SetSize(*given.size)
    layout.SeparatorColor = [1, 1, 1]
    SaveScreenshot(given.picture, layout, ImageResolution=given.size)
    print(f"render: {given.picture} (t = {time:.4g} s)")


main()
