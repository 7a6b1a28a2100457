# SPDX-License-Identifier: BSD-3-Clause
"""Rounder triangles for a closed mesh: edges inside flat faces are flipped until the faces are Delaunay."""

import math

import numpy as np

from shapes import on_grid


def minus(p, q):
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def dot(u, v):
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def normal(p, q, r):
    u, v = minus(q, p), minus(r, p)
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


class Surface:
    """A closed mesh by its directed edges: `apex[a, b]` is the third corner of the triangle that runs from a to b."""

    def __init__(self, triangles):
        index, self.apex = {}, {}
        for triangle in on_grid(triangles):
            self.add(*(index.setdefault(tuple(p), len(index)) for p in triangle.tolist()))
        self.points = list(index)

    def add(self, a, b, c):
        self.apex[a, b], self.apex[b, c], self.apex[c, a] = c, a, b

    def edges(self):
        return sorted(edge for edge in self.apex if edge[0] < edge[1])

    def wants_flip(self, a, b):
        """True inside a flat face where the angles that face the edge add up to more than half a turn."""
        c, d = self.apex[a, b], self.apex[b, a]
        if (c, d) in self.apex or (d, c) in self.apex:
            return False
        pa, pb, pc, pd = (self.points[i] for i in (a, b, c, d))
        left, right = normal(pa, pb, pc), normal(pb, pa, pd)
        areas = math.sqrt(dot(left, left)), math.sqrt(dot(right, right))
        if dot(left, right) < (1 - 1e-9) * areas[0] * areas[1]:
            return False
        return dot(minus(pa, pc), minus(pb, pc)) / areas[0] + dot(minus(pa, pd), minus(pb, pd)) / areas[1] < -1e-6

    def flip(self, a, b):
        c, d = self.apex.pop((a, b)), self.apex.pop((b, a))
        self.add(a, d, c)
        self.add(d, b, c)

    def make_delaunay(self):
        flipped = True
        while flipped:
            flipped = False
            for a, b in self.edges():
                if (a, b) in self.apex and self.wants_flip(a, b):
                    self.flip(a, b)
                    flipped = True

    def triangles(self):
        faces = sorted((a, b, c) for (a, b), c in self.apex.items() if a < b and a < c)
        return np.array([[self.points[i] for i in corners] for corners in faces])


def delaunay(triangles):
    """The same closed surface with the roundest triangles its corners allow."""
    surface = Surface(triangles)
    surface.make_delaunay()
    return surface.triangles()
