# SPDX-License-Identifier: BSD-3-Clause
"""The models of the examples: closed meshes, the published kinematics, and a plug that fits its socket one way round only."""

import collections
import itertools
import math
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

MODELS = pathlib.Path(__file__).resolve().parents[2] / "examples" / "models"
URDF = MODELS / "ur10e" / "ur10e.urdf"
MESHES = sorted(path.relative_to(MODELS).as_posix() for path in MODELS.rglob("*.stl"))

# The tables of examples/models/README.md.
DH_A = [0, -0.6127, -0.57155, 0, 0, 0]
DH_D = [0.1807, 0, 0, 0.17415, 0.11985, 0.11655]
DH_ALPHA = [math.pi / 2, 0, 0, math.pi / 2, -math.pi / 2, 0]
PINS = [(-0.011, -0.004, 0.0025), (0.011, -0.004, 0.0025), (0.0, 0.009, 0.003)]
PLUG_FRONT, PIN_TIP, HOLE_DEPTH = 0.160, 0.179, 0.024
SEATED = (-0.1605, 0, 0, -math.pi / 2, 0, -math.pi / 2)


# --- reading and geometry

def read_stl(path):
    """(n x 3 x 3) corners of a binary STL."""
    data = path.read_bytes()
    assert not data.startswith(b"solid")
    count = int.from_bytes(data[80:84], "little")
    assert len(data) == 84 + 50 * count
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, record, count, 84)["corners"].astype(float)


def welded(triangles):
    points, faces = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    return points, faces.reshape(-1, 3)


def shells(triangles):
    """The connected parts of a mesh."""
    points, faces = welded(triangles)
    parent = list(range(len(points)))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b, c in faces.tolist():
        parent[root(a)] = parent[root(b)] = root(c)
    label = np.array([root(a) for a in faces[:, 0].tolist()])
    return [triangles[label == i] for i in np.unique(label)]


def volume(triangles):
    return (triangles[:, 0] * np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6


def edge_lengths(triangles):
    return np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)


def inside(points, triangles):
    """True for points with a winding number above one half (solid angles after van Oosterom and Strackee)."""
    result = []
    for chunk in np.array_split(points, len(points) // 200 + 1):
        a, b, c = (triangles[:, i] - chunk[:, None] for i in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
        below = la * lb * lc + (a * b).sum(2) * lc + (b * c).sum(2) * la + (c * a).sum(2) * lb
        result.append(np.arctan2((a * np.cross(b, c)).sum(2), below).sum(1) / (2 * math.pi) > 0.5)
    return np.concatenate(result)


def segment_distance(point, start, end):
    """From a point in the plane to each of many segments."""
    along = end - start
    s = np.clip(((point - start) * along).sum(1) / (along ** 2).sum(1), 0, 1)
    return np.linalg.norm(start + s[:, None] * along - point, axis=1)


def rotation(roll, pitch, yaw):
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]])


def pose(x, y, z, roll, pitch, yaw):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation(roll, pitch, yaw), (x, y, z)
    return result


def apply(transform, points):
    return points @ transform[:3, :3].T + transform[:3, 3]


def plug_vertices():
    return welded(read_stl(MODELS / "plug" / "plug.stl"))[0]


def pin_vertices():
    points = plug_vertices()
    return points[points[:, 2] > PLUG_FRONT + 1e-6]


# --- kinematics

def urdf_joints():
    for joint in ElementTree.parse(URDF).getroot().iter("joint"):
        origin = joint.find("origin")
        numbers = [float(n) for n in (origin.get("xyz") + " " + origin.get("rpy")).split()]
        yield joint, pose(*numbers)


def link_poses(q):
    """base_link_from_link for every link, by following the joints of the URDF."""
    angles = dict(zip([j.get("name") for j, _ in urdf_joints() if j.get("type") == "revolute"], q))
    children = collections.defaultdict(list)
    for joint, origin in urdf_joints():
        turn = pose(0, 0, 0, 0, 0, angles.get(joint.get("name"), 0.0))
        children[joint.find("parent").get("link")].append((joint.find("child").get("link"), origin @ turn))
    poses, waiting = {"base_link": np.eye(4)}, ["base_link"]
    while waiting:
        parent = waiting.pop()
        for child, transform in children[parent]:
            poses[child] = poses[parent] @ transform
            waiting.append(child)
    return poses


def dh_pose(q):
    """base_link_from_tool0; the DH base is turned by pi about z."""
    result = pose(0, 0, 0, 0, 0, math.pi)
    for theta, a, d, alpha in zip(q, DH_A, DH_D, DH_ALPHA):
        result = result @ pose(0, 0, d, 0, 0, theta) @ pose(a, 0, 0, alpha, 0, 0)
    return result


# --- meshes

@pytest.mark.parametrize("name", MESHES)
def test_mesh_is_closed_and_faces_outwards(name):
    triangles = read_stl(MODELS / name)
    _, faces = welded(triangles)
    edges = collections.Counter(tuple(e) for i in range(3) for e in faces[:, [i, (i + 1) % 3]].tolist())
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    assert np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).min() > 1e-9
    assert len(shells(triangles)) == 1
    assert volume(triangles) > 0


def test_all_meshes_are_there_and_small():
    assert len(MESHES) == 10
    assert sum((MODELS / name).stat().st_size for name in MESHES) < 1_500_000


def test_files_are_what_the_generator_writes(tmp_path):
    subprocess.run([sys.executable, "-B", str(MODELS / "generate.py"), str(tmp_path)], check=True)
    for name in [*MESHES, "ur10e/ur10e.urdf"]:
        assert (tmp_path / name).read_bytes() == (MODELS / name).read_bytes(), name


# --- the arm

def test_forward_kinematics_follow_the_published_table():
    rng = np.random.default_rng(1)
    for q in rng.uniform(-math.pi, math.pi, (200, 6)):
        np.testing.assert_allclose(link_poses(q)["tool0"], dh_pose(q), rtol=0, atol=1e-12)


def test_joints_have_the_published_names_and_limits():
    revolute = [joint for joint, _ in urdf_joints() if joint.get("type") == "revolute"]
    limits = {joint.get("name"): {k: float(v) for k, v in joint.find("limit").attrib.items()} for joint in revolute}
    assert list(limits) == ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]
    assert [limit["upper"] for limit in limits.values()] == pytest.approx([2 * math.pi] * 2 + [math.pi] + [2 * math.pi] * 3)
    assert [limit["lower"] for limit in limits.values()] == pytest.approx([-limit["upper"] for limit in limits.values()])
    assert [limit["velocity"] for limit in limits.values()] == pytest.approx([2.094] * 2 + [3.142] * 4, abs=1e-3)
    assert [limit["effort"] for limit in limits.values()] == [330, 330, 150, 56, 56, 56]


def test_meshes_are_named_relative_to_the_urdf():
    names = {mesh.get("filename") for mesh in ElementTree.parse(URDF).getroot().iter("mesh")}
    assert len(names) == 7
    assert all((URDF.parent / name).is_file() for name in names)


@pytest.mark.parametrize("q", [(0, -1.57, 1.57, -1.57, -1.57, 0), (0.5, -1.2, 2.0, -0.8, -1.57, 0.7), (-0.6, -0.9, 1.4, -0.5, -1.2, 2.0),
                               (0, -1.57, 0, -1.57, 0, 0), (0, 0, 0, 0, 0, 0)])
def test_links_that_are_not_neighbours_keep_apart(q):
    poses, links = link_poses(q), []
    for link in ElementTree.parse(URDF).getroot().iter("link"):
        if link.find("collision") is not None:
            triangles = read_stl(URDF.parent / link.find("collision/geometry/mesh").get("filename"))
            links.append(apply(poses[link.get("name")], triangles))
    links[-1] = np.concatenate([links[-1], apply(poses["tool0"], read_stl(MODELS / "plug" / "plug.stl"))])
    for (i, a), (j, b) in itertools.combinations(enumerate(links), 2):
        if j - i > 1 and (a.max((0, 1)) > b.min((0, 1))).all() and (b.max((0, 1)) > a.min((0, 1))).all():
            assert not inside(welded(a)[0], b).any() and not inside(welded(b)[0], a).any(), (i, j)


# --- plug and socket

def test_socket_has_many_even_triangles():
    triangles = read_stl(MODELS / "socket" / "socket.stl")
    assert len(triangles) >= 2000
    assert edge_lengths(triangles).max() < 0.015
    np.testing.assert_allclose(triangles.min((0, 1)), [0, -0.058, -0.036], atol=1e-7)
    np.testing.assert_allclose(triangles.max((0, 1)), [0.045, 0.058, 0.036], atol=1e-7)


def test_pins_have_their_radius_and_length():
    points = pin_vertices()
    assert points[:, 2].max() == pytest.approx(PIN_TIP, abs=1e-7)
    distances = np.array([np.hypot(points[:, 0] - x, points[:, 1] - y) for x, y, _ in PINS])
    for k, (_, _, radius) in enumerate(PINS):
        assert distances[k][distances.argmin(0) == k].max() == pytest.approx(radius, abs=1e-7)


@pytest.mark.parametrize("x, y, radius", PINS)
def test_holes_leave_one_millimetre_around_the_pins(x, y, radius):
    triangles = read_stl(MODELS / "socket" / "socket.stl")
    centre = np.array([-x, -y])
    depth, across = triangles[..., 0], triangles[..., 1:]
    near = (np.linalg.norm(across - centre, axis=2) < radius + 0.0012).all(1)
    hole = near & (depth < 0.04).all(1)
    assert depth[hole].max() == pytest.approx(HOLE_DEPTH, abs=1e-7)
    sides = across[hole & (np.ptp(depth, axis=1) > 1e-6)]
    start, end = sides.reshape(-1, 2), np.roll(sides, -1, axis=1).reshape(-1, 2)
    level = np.linalg.norm(end - start, axis=1) > 1e-6
    assert segment_distance(centre, start[level], end[level]).min() == pytest.approx(radius + 0.001, abs=1e-6)


def test_seated_plug_is_clear_of_the_socket():
    socket = read_stl(MODELS / "socket" / "socket.stl")
    seated = apply(pose(*SEATED), plug_vertices())
    assert not inside(seated, socket).any()
    depth = seated[:, 0]
    assert depth.max() == pytest.approx(PIN_TIP - PLUG_FRONT - 0.0005, abs=1e-7)
    assert depth[depth < 0].max() == pytest.approx(-0.0005, abs=1e-7)


@pytest.mark.parametrize("sideways, hits", [(0.0009, False), (0.0011, True)])
def test_seated_plug_has_one_millimetre_of_play(sideways, hits):
    socket = read_stl(MODELS / "socket" / "socket.stl")
    pins = apply(pose(*SEATED), pin_vertices())
    for direction in np.eye(3)[1:]:
        assert inside(pins + sideways * direction, socket).any() == hits
        assert inside(pins - sideways * direction, socket).any() == hits


def test_plug_fits_at_one_roll_only():
    socket = read_stl(MODELS / "socket" / "socket.stl")
    pins = pin_vertices()
    tips = pins[pins[:, 2] > PIN_TIP - 0.001]
    for degrees in range(15, 360, 15):
        assert inside(apply(pose(*SEATED) @ pose(0, 0, 0, 0, 0, math.radians(degrees)), tips), socket).any(), degrees


# --- shelf

def test_shelf_is_open_to_the_robot_with_walls_of_two_centimetres():
    shelf = read_stl(MODELS / "shelf" / "shelf.stl")
    np.testing.assert_allclose(shelf.min((0, 1)), [0.70, -0.52, -0.07], atol=1e-6)
    np.testing.assert_allclose(shelf.max((0, 1)), [1.07, 0.52, 1.07], atol=1e-6)
    free = np.array([(x, y, z) for x in (0.69, 0.71, 1.049) for y in (-0.499, 0, 0.499) for z in (-0.049, 0.5, 1.049)])
    solid = np.array([(1.051, 0, 0.5), (1.069, 0, 0.5), (0.9, 0.501, 0.5), (0.9, -0.519, 0.5), (0.9, 0, -0.051), (0.9, 0, 1.069)])
    assert not inside(free, shelf).any()
    assert inside(solid, shelf).all()


def test_no_socket_of_the_prior_touches_the_shelf():
    socket = welded(read_stl(MODELS / "socket" / "socket.stl"))[0]
    low, high = np.array([0.70, -0.50, -0.05]), np.array([1.05, 0.50, 1.05])
    for y, z in itertools.product((-0.25, 0, 0.25), (0.25, 0.5, 0.75)):
        for roll in np.radians(range(0, 360, 5)):
            base_from_socket = pose(1.05 - 0.045 - 0.001, y, z, roll, 0, 0)
            np.testing.assert_allclose(base_from_socket[:3, 0], [1, 0, 0], atol=1e-12)
            points = apply(base_from_socket, socket)
            assert (points > low + 0.0009).all() and (points < high - 0.0009).all()


def test_seated_tool_points_into_the_socket():
    np.testing.assert_allclose(rotation(*SEATED[3:]), [[0, 0, 1], [-1, 0, 0], [0, -1, 0]], atol=1e-12)


def test_upright_socket_has_its_earth_hole_below_the_others():
    """The approach leads along +x of a base with z up, the long side is level."""
    socket = read_stl(MODELS / "socket" / "socket.stl")
    depths = (socket[..., 0] > HOLE_DEPTH - 1e-6).all(1) & (socket[..., 0] < HOLE_DEPTH + 1e-6).all(1)
    bottoms = socket[depths].reshape(-1, 3)
    assert bottoms[np.abs(bottoms[:, 1]) < 0.005][:, 2].max() < 0 < bottoms[np.abs(bottoms[:, 1]) > 0.006][:, 2].min()
