# SPDX-License-Identifier: BSD-3-Clause
"""Watertight solids from outlines, revolved profiles and bent tubes.

A loop is an (n x 2) array of corners, counter-clockwise. A ring is an (n x 3) array of corners around a tube, counter-clockwise
as seen from where the tube goes. Triangles are an (n x 3 x 3) array, wound so that the normal points out of the solid. Metres.
"""

import math

import numpy as np

GRID = 1e-9  # coordinates are multiples of this, so that equal corners are equal and files do not depend on libm


def on_grid(points):
    return np.round(np.asarray(points, float) / GRID) * GRID + 0.0


# --- loops

def circle(radius, segments, centre=(0.0, 0.0), phase=0.0):
    """Corners on the circle: the polygon lies inside it."""
    angles = [2 * math.pi * i / segments + phase for i in range(segments)]
    return on_grid([(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles])


def bore(radius, segments, centre=(0.0, 0.0)):
    """Sides tangent to the circle: the polygon lies outside it, so a hole is nowhere narrower than its radius."""
    half = math.pi / segments
    return circle(radius / math.cos(half), segments, centre, half)


def rectangle(x0, x1, y0, y1):
    return on_grid([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def rounded_rectangle(width, height, radius, segments=5):
    """Centred; `segments` per corner."""
    corners = []
    for quarter, (sx, sy) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)]):
        for i in range(segments + 1):
            a = math.pi / 2 * (quarter + i / segments)
            corners.append((sx * (width / 2 - radius) + radius * math.cos(a), sy * (height / 2 - radius) + radius * math.sin(a)))
    return on_grid(corners)


def divided(loop, step):
    """The same outline with further corners, so that no side is longer than a step."""
    corners = []
    for a, b in zip(loop, np.roll(loop, -1, axis=0)):
        n = math.ceil(math.dist(a, b) / step - 1e-6)
        corners += [a + (b - a) * (k / n) for k in range(n)]
    return on_grid(corners)


def at_height(loop, z):
    return np.column_stack([loop, np.full(len(loop), z)])


# --- flat faces: holes are bridged to the outline, then ears are cut

def cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def segments_cross(a, b, c, d):
    return cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0


def bridged(outline, holes):
    """One loop (with its bridges walked twice) around an outline and its holes."""
    ring = [tuple(p) for p in outline]
    waiting = [[tuple(p) for p in hole[::-1]] for hole in holes]
    while waiting:
        edges = [(r[i - 1], r[i]) for r in [ring, *waiting] for i in range(len(r))]
        pairs = sorted((round(math.dist(p, q), 9), h, i, j) for h, hole in enumerate(waiting)
                       for i, p in enumerate(ring) for j, q in enumerate(hole))
        for _, h, i, j in pairs:
            if not any(segments_cross(ring[i], waiting[h][j], a, b) for a, b in edges):
                break
        hole = waiting.pop(h)
        ring = ring[:i + 1] + hole[j:] + hole[:j + 1] + ring[i:]
    return ring


def is_ear(ring, i):
    a, b, c = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
    if cross(a, b, c) < 1e-12:
        return False
    return not any(cross(a, b, p) >= 0 and cross(b, c, p) >= 0 and cross(c, a, p) >= 0 for p in ring if p not in (a, b, c))


def roundness(a, b, c):
    return cross(a, b, c) / (math.dist(a, b) ** 2 + math.dist(b, c) ** 2 + math.dist(c, a) ** 2)


def triangulate(outline, holes=()):
    """Counter-clockwise triangles that cover the outline without its holes; always the roundest ear first."""
    ring, triangles = bridged(outline, holes), []
    while len(ring) > 3:
        roundest = sorted((-round(roundness(ring[i - 1], ring[i], ring[(i + 1) % len(ring)]), 9), i) for i in range(len(ring)))
        i = next(i for _, i in roundest if is_ear(ring, i))
        triangles.append((ring[i - 1], ring[i], ring[(i + 1) % len(ring)]))
        del ring[i]
    return [*triangles, tuple(ring)]


def distance_to(loops, p):
    """From a point to the sides of some loops."""
    start = np.concatenate(loops)
    along = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops]) - start
    s = np.clip(((p - start) * along).sum(axis=1) / (along ** 2).sum(axis=1), 0, 1)
    return float(np.sqrt(((start + s[:, None] * along - p) ** 2).sum(axis=1)).min())


def grid_points(loops, step):
    """A triangular grid within the box of the outline, off its symmetry axes, without the points close to a loop."""
    (x0, y0), (x1, y1) = loops[0].min(axis=0), loops[0].max(axis=0)
    rows, columns = range(int((y1 - y0) / (step * 0.866)) + 1), range(int((x1 - x0) / step) + 2)
    points = on_grid([(x0 + (j + 0.213 + i % 2 / 2) * step, y0 + (i + 0.571) * 0.866 * step) for i in rows for j in columns])
    return [tuple(p) for p in points.tolist() if distance_to(loops, p) > 0.55 * step]


def with_points(triangles, points):
    """Each triangle that holds a point is split in three; points outside and on edges are left out."""
    for p in points:
        for k, (a, b, c) in enumerate(triangles):
            if min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) > 1e-10:
                triangles[k:k + 1] = [(a, b, p), (b, c, p), (c, a, p)]
                break
    return triangles


def face(outline, holes, z, up, step=None):
    """A flat face at height z that looks up or down, with points inside it a step apart."""
    flat = triangulate(outline, holes)
    if step:
        flat = with_points(flat, grid_points([outline, *holes], step))
    triangles = np.concatenate([np.array(flat), np.full((len(flat), 3, 1), z)], axis=2)
    return triangles if up else triangles[:, ::-1]


# --- skins

def skin(rings):
    """The quads between consecutive rings, each as two triangles; open at both ends."""
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for i in range(len(low)):
            a, b, c, d = low[i - 1], low[i], high[i], high[i - 1]
            triangles += [(a, b, c), (a, c, d)]
    return np.array(triangles)


def wall(loop, z0, z1, step, inwards=False):
    """The upright wall over a loop, in rows of about a step; `inwards` for the wall of a hole."""
    rows = math.ceil((z1 - z0) / step - 1e-6)
    triangles = skin([at_height(loop, z) for z in on_grid(np.linspace(z0, z1, rows + 1))])
    return triangles[:, ::-1] if inwards else triangles


def capped(rings):
    """A tube closed at both ends by fans; its end rings must be star-shaped about their centres."""
    rings = [on_grid(ring) for ring in rings]
    first, last = on_grid(rings[0].mean(axis=0)), on_grid(rings[-1].mean(axis=0))
    bottom = [(first, rings[0][i], rings[0][i - 1]) for i in range(len(rings[0]))]
    top = [(last, rings[-1][i - 1], rings[-1][i]) for i in range(len(rings[-1]))]
    return np.concatenate([bottom, skin(rings), top])


def lathe(profile, segments):
    """The solid of revolution about z of (radius, z) corners, from its bottom to its top."""
    return capped([at_height(circle(radius, segments), z) for radius, z in profile])


def pieces(rings, step):
    """The same tube with further rings wherever two are more than a step apart."""
    result = [rings[0]]
    for low, high in zip(rings, rings[1:]):
        n = math.ceil(float(np.max(np.sqrt(((high - low) ** 2).sum(axis=1)))) / step)
        result += [low + (high - low) * (k / n) for k in range(1, n + 1)]
    return result


def bent_tube(path, radii, bulge=0.0, rim=0.003, inner=0.003, outer=0.04, segments=36, step=0.05):
    """A round tube along a path in the x-y plane that turns left at every corner.

    Corners are mitred, then rounded from `inner` on the inside of the bend to `outer` on the outside; `bulge` swells the
    outside of the bends, `rim` chamfers the ends. One radius for each corner of the path.
    """
    path = [np.array([x, y, 0.0]) for x, y in path]
    leg = [(b - a) / math.dist(a, b) for a, b in zip(path, path[1:])]
    right = [np.array([d[1], -d[0], 0.0]) for d in leg]
    unit = circle(1.0, segments)
    up, out = unit[:, :1] * np.array([0.0, 0.0, 1.0]), unit[:, 1:]

    def disc(centre, i, radius):
        return centre + radius * (up + out * right[i])

    rings = [disc(path[0], 0, radii[0] / 2), disc(path[0], 0, radii[0] - rim), disc(path[0] + rim * leg[0], 0, radii[0])]
    for i in range(1, len(leg)):
        mitre = (right[i - 1] + right[i]) / (1 + right[i - 1] @ right[i])
        corner = path[i] + radii[i] * up + np.where(out > 0, radii[i] + bulge, radii[i]) * out * mitre
        fillet = inner + (outer - inner) * (1 + out) / 2
        before, after = corner - fillet * leg[i - 1], corner + fillet * leg[i]
        rings += [(1 - s) ** 2 * before + 2 * s * (1 - s) * corner + s ** 2 * after for s in (0.0, 0.25, 0.5, 0.75, 1.0)]
    rings += [disc(path[-1] - rim * leg[-1], -1, radii[-1]), disc(path[-1], -1, radii[-1] - rim), disc(path[-1], -1, radii[-1] / 2)]
    return capped(pieces(rings, step))


# --- whole meshes

def turned(triangles, x, y, z):
    """The solid with its axes laid along the given (right-handed) unit vectors."""
    return on_grid(triangles[..., :1] * np.array(x) + triangles[..., 1:2] * np.array(y) + triangles[..., 2:] * np.array(z))


def mass_properties(triangles, mass):
    """Centre of mass and inertia about it of a closed mesh of uniform density."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    volumes = (a * np.cross(b, c)).sum(axis=1) / 6
    density = mass / volumes.sum()
    centre = ((a + b + c) * volumes[:, None]).sum(axis=0) / 4 / volumes.sum()
    second = np.zeros((3, 3))
    for p, q, r, v in zip(a - centre, b - centre, c - centre, ((a - centre) * np.cross(b - centre, c - centre)).sum(axis=1) / 6):
        s = p + q + r
        second += density * v / 20 * (np.outer(p, p) + np.outer(q, q) + np.outer(r, r) + np.outer(s, s))
    return centre, np.eye(3) * np.trace(second) - second


def write_stl(path, triangles):
    """Binary STL; the header must not begin with 'solid', by which readers know the text form."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.sqrt((normals ** 2).sum(axis=1, keepdims=True))
    records = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records["normal"], records["corners"] = normals + 0.0, triangles
    header = f"tactus {path.stem}, metres".encode().ljust(80, b"\0")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header + len(triangles).to_bytes(4, "little") + records.tobytes())
