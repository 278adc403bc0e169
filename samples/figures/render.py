#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws points and meshes side by side into a PNG.

Each panel is CAPTION=FILE or CAPTION=FILE@x,y,z,r, where the latter is a close-up of a ball. Files are .xyz and .pcd
(ASCII, x y z nx ny nz) and .off (vertices only) for points, and .ply for meshes with normals. Points that look away are
left out. All panels are seen from the same side and, but for close-ups, in the same scale.
"""
import argparse
import sys

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

BACKGROUND = (0.96, 0.96, 0.95)
SURFACE = (0.80, 0.77, 0.70)
INSIDE = (0.55, 0.25, 0.20)
POINT = (0.25, 0.30, 0.40)
CAPTION_HEIGHT = 34  # pixels


def numbers(text):
    return numpy.array([float(word) for word in text.split(",")])


def read_table(name):
    if name.endswith(".pcd"):
        return numpy.loadtxt(name, skiprows=11)
    if not name.endswith(".off"):
        return numpy.loadtxt(name)
    with open(name, encoding="ascii") as file:
        words = file.read().split()[1:]
    return numpy.array(words[3 : 3 + 3 * int(words[0])], dtype=float).reshape(-1, 3)


def read_points(name):
    table = read_table(name)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(table[:, :3], deep=True))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    if table.shape[1] >= 6:
        data.GetPointData().SetNormals(numpy_to_vtk(table[:, 3:6], deep=True))
    return data


def read_mesh(name):
    reader = vtk.vtkPLYReader()
    reader.SetFileName(name)
    reader.Update()
    if reader.GetOutput().GetNumberOfPolys() == 0:
        sys.exit("render.py: no mesh in " + name)
    return reader.GetOutput()


def towards(data, direction):
    """The points whose normals do not look away."""
    normals = data.GetPointData().GetNormals()
    if normals is None:
        return data
    keep = numpy.flatnonzero(vtk_to_numpy(normals) @ direction > 0.0)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(positions(data)[keep], deep=True))
    front = vtk.vtkPolyData()
    front.SetPoints(points)
    return front


def positions(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def point_actor(data, direction, size):
    glyphs = vtk.vtkVertexGlyphFilter()
    glyphs.SetInputData(towards(data, direction))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyphs.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetPointSize(size)
    actor.GetProperty().RenderPointsAsSpheresOn()
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(POINT)
    return actor


def shaded(data, crease):
    """The triangles, each with corners of its own and the stored normals at them.

    Where a normal is off the triangle's own by more than crease degrees it is that of the other side of an edge, and
    the triangle's own is taken, but for slivers, which have none.
    """
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    places = positions(data)[corners].astype(float)
    normals = vtk_to_numpy(data.GetPointData().GetNormals())[corners].astype(float)
    own = numpy.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    double_areas = numpy.linalg.norm(own, axis=1)
    own /= numpy.maximum(double_areas, 1e-300)[:, None]
    off = numpy.einsum("tcx,tx->tc", normals, own) < numpy.cos(numpy.radians(crease))
    off &= (double_areas > 0.02 * numpy.median(double_areas))[:, None]
    normals = numpy.where(off[:, :, None], own[:, None, :], normals)

    points, triangles, result = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    points.SetData(numpy_to_vtk(places.reshape(-1, 3), deep=True))
    ends = numpy.arange(0, corners.size + 1, 3)
    triangles.SetData(
        numpy_to_vtkIdTypeArray(ends, deep=True), numpy_to_vtkIdTypeArray(numpy.arange(corners.size), deep=True)
    )
    result.SetPoints(points)
    result.SetPolys(triangles)
    result.GetPointData().SetNormals(numpy_to_vtk(normals.reshape(-1, 3), deep=True))
    return result


def mesh_actor(data, crease):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(shaded(data, crease))
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    front, back = actor.GetProperty(), vtk.vtkProperty()
    front.SetColor(SURFACE)
    back.SetColor(INSIDE)
    for face in (front, back):
        face.SetAmbient(0.08)
        face.SetDiffuse(0.9)
    front.SetSpecular(0.15)
    front.SetSpecularPower(25)
    actor.SetBackfaceProperty(back)
    return actor


def add_lights(renderer):
    """A key light from the upper left, a little from the right and from the eye, all moving with the camera."""
    for position, intensity in (((-1.2, 1.2, 1.5), 0.85), ((1.5, 0.0, 0.8), 0.3), ((0, 0, 1), 0.25)):
        light = vtk.vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(intensity)
        renderer.AddLight(light)


def draw_caption(text, width):
    caption = vtk.vtkTextActor()
    caption.SetInput(text)
    caption.SetPosition(width / 2, 10)
    style = caption.GetTextProperty()
    style.SetFontSize(17)
    style.SetColor(0.15, 0.15, 0.15)
    style.SetJustificationToCentered()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(BACKGROUND)
    renderer.AddViewProp(caption)
    return renderer


class View:
    """The direction all panels are seen from."""

    def __init__(self, direction, up):
        self.back = direction / numpy.linalg.norm(direction)  # towards the eye
        self.right = numpy.cross(up, self.back)
        self.right /= numpy.linalg.norm(self.right)
        self.up = numpy.cross(self.back, self.right)

    def frame(self, points):
        """Center, half width and half height of the points on the screen."""
        low, high = points.min(axis=0), points.max(axis=0)
        center = 0.5 * (low + high)
        across, along = (points - center) @ self.right, (points - center) @ self.up
        center = center + 0.5 * (across.max() + across.min()) * self.right + 0.5 * (along.max() + along.min()) * self.up
        return center, 0.5 * numpy.ptp(across), 0.5 * numpy.ptp(along)

    def aim(self, camera, center, half_height, far):
        """Parallel projection on center, from far away."""
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(center)
        camera.SetPosition(center + far * self.back)
        camera.SetViewUp(self.up)
        camera.SetParallelScale(half_height)
        camera.SetClippingRange(0.01 * far, 2.0 * far)


class Panel:
    def __init__(self, text):
        self.caption, _, rest = text.partition("=")
        name, _, focus = rest.partition("@")
        self.data = read_mesh(name) if name.endswith(".ply") else read_points(name)
        self.focus = numbers(focus) if focus else None


def half_height(panels, view, width, height):
    """Half of what a panel shows from bottom to top, so that all fit."""
    most = 0.0
    for panel in panels:
        if panel.focus is None:
            _, across, along = view.frame(positions(panel.data))
            most = max(most, along, across * height / width)
    return 1.06 * most


def draw(panel, view, scale, arguments):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(BACKGROUND)
    if panel.data.GetNumberOfPolys() > 0:
        renderer.AddActor(mesh_actor(panel.data, arguments.crease))
    else:
        close = 1.0 if panel.focus is None else 1.6
        renderer.AddActor(point_actor(panel.data, view.back, close * arguments.point_size))
    add_lights(renderer)
    center, size = view.frame(positions(panel.data))[0], scale
    if panel.focus is not None:
        center, size = panel.focus[:3], panel.focus[3]
    view.aim(renderer.GetActiveCamera(), center, size, 10.0 * panel.data.GetLength())
    return renderer


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", metavar="OUT.png")
    parser.add_argument("panels", nargs="+", metavar="CAPTION=FILE[@x,y,z,r]")
    parser.add_argument("--columns", type=int, default=3)
    parser.add_argument("--width", type=int, default=400, help="of a panel, in pixels")
    parser.add_argument("--height", type=int, default=400)
    parser.add_argument("--from", dest="direction", type=numbers, default="1,1,1", help="the side it is seen from")
    parser.add_argument("--up", type=numbers, default="0,0,1")
    parser.add_argument("--crease", type=float, default=30, help="edges of more degrees are shaded sharp")
    parser.add_argument("--point-size", type=float, default=4)
    arguments = parser.parse_args()

    panels = [Panel(text) for text in arguments.panels]
    view = View(arguments.direction, arguments.up)
    scale = half_height(panels, view, arguments.width, arguments.height)
    columns = arguments.columns
    rows = -(-len(panels) // columns)

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(arguments.width * columns, (arguments.height + CAPTION_HEIGHT) * rows)
    strip = CAPTION_HEIGHT / (arguments.height + CAPTION_HEIGHT)
    for i, panel in enumerate(panels):
        left, low = i % columns, rows - 1 - i // columns
        for renderer, bottom, top in (
            (draw(panel, view, scale, arguments), low + strip, low + 1),
            (draw_caption(panel.caption, arguments.width), low, low + strip),
        ):
            renderer.SetViewport(left / columns, bottom / rows, (left + 1) / columns, top / rows)
            window.AddRenderer(renderer)
    window.Render()

    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(arguments.output)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
