#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the vertices of a mesh of triangles (.off) with the mean normals of the faces around them (.xyz)."""
import sys

import numpy


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: normals_from_faces.py IN.off OUT.xyz")
    with open(sys.argv[1], encoding="ascii") as file:
        words = file.read().split()[1:]
    vertices, faces = int(words[0]), int(words[1])
    end = 3 + 3 * vertices
    points = numpy.array(words[3:end], dtype=float).reshape(vertices, 3)
    corners = numpy.array(words[end : end + 4 * faces], dtype=int).reshape(faces, 4)[:, 1:]

    edges = points[corners[:, 1:]] - points[corners[:, :1]]
    normals = numpy.zeros_like(points)
    for corner in range(3):
        numpy.add.at(normals, corners[:, corner], numpy.cross(edges[:, 0], edges[:, 1]))  # larger faces count more
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    numpy.savetxt(sys.argv[2], numpy.hstack([points, normals]), fmt="%.9g")


if __name__ == "__main__":
    main()
