# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a run: a small renderer with a depth buffer, and four panels around it."""

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.collections import PolyCollection
from matplotlib.ticker import MaxNLocator

INK, PAPER = "#22303c", np.array([1.0, 1.0, 1.0])
COLOURS = {"robot": (0.70, 0.74, 0.79), "tool": (0.20, 0.47, 0.74), "world": (0.93, 0.90, 0.85), "target": (0.95, 0.60, 0.16)}
BELIEF, CONTACT = (0.45, 0.23, 0.66), (0.85, 0.10, 0.16)
SUPERSAMPLING = 2


class Camera:
    """Perspective, z up, zoomed until the points of `subject` fill the picture. `width` and `height` in pixels of the finished picture."""

    def __init__(self, eye, subject, width, height):
        centre = (subject.max(0) + subject.min(0)) / 2
        self.eye = np.asarray(eye, float)
        self.width, self.height = width * SUPERSAMPLING, height * SUPERSAMPLING
        forward = (centre - self.eye) / np.linalg.norm(centre - self.eye)
        right = np.cross(forward, [0, 0, 1])
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(forward, right), forward])
        self.focal, self.shift = 1.0, np.zeros(2)
        ends = np.array([self.project(subject)[:, :2].min(0), self.project(subject)[:, :2].max(0)])
        self.focal = 0.96 * (np.array([self.width, self.height]) / (ends[1] - ends[0])).min()
        self.shift = 0.5 * np.array([self.width, self.height]) - self.focal * ends.mean(0)

    def project(self, points):
        """Pixel column, pixel row and depth of points (... x 3)."""
        x, y, depth = np.moveaxis((points - self.eye) @ self.axes.T, -1, 0)
        scale = self.focal / np.maximum(depth, 1e-6)
        return np.stack([self.shift[0] + x * scale, self.shift[1] + y * scale, depth], -1)


class Layer:
    """Colour and inverse depth (0: nothing there) of what is nearest, or of what is farthest."""

    def __init__(self, camera, farthest=False):
        self.camera, self.farthest = camera, farthest
        self.colour = np.ones((camera.height, camera.width, 3)) * PAPER
        self.inverse = np.zeros((camera.height, camera.width))

    def draw(self, vertices, triangles, colour):
        corners = vertices[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-12
        towards = self.camera.eye - corners.mean(1)
        normals *= np.sign((normals * towards).sum(1))[:, None]
        lamp, viewer = np.array([-0.45, -0.45, 0.77]), towards / np.linalg.norm(towards, axis=1, keepdims=True)
        light = 0.46 + 0.32 * np.clip(normals @ lamp, 0, 1) + 0.32 * (normals * viewer).sum(1)
        for (p, shade) in zip(self.camera.project(corners), np.clip(light[:, None] * np.array(colour), 0, 1)):
            if p[:, 2].min() > 0.02:
                self._fill(p, shade)

    def _fill(self, p, shade):
        x0, y0 = np.maximum(np.ceil(p[:, :2].min(0)).astype(int), 0)
        x1, y1 = np.minimum(np.floor(p[:, :2].max(0)).astype(int) + 1, (self.camera.width, self.camera.height))
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = p
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if x0 >= x1 or y0 >= y1 or abs(area) < 1e-9:
            return
        x, y = np.arange(x0, x1), np.arange(y0, y1)[:, None]
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        inverse = (1 - b - c) / az + b / bz + c / cz
        old = self.inverse[y0:y1, x0:x1]
        seen = (b >= 0) & (c >= 0) & (b + c <= 1)
        seen &= ((old == 0) | (inverse < old)) if self.farthest else (inverse > old)
        old[seen] = inverse[seen]
        self.colour[y0:y1, x0:x1][seen] = shade

    def outline(self, strength=0.55):
        """Darkens where the depth jumps."""
        jump = np.zeros_like(self.inverse)
        for axis in (0, 1):
            step = np.abs(np.diff(self.inverse, n=2, axis=axis)) / (np.abs(self.inverse).max() + 1e-12)
            jump += np.pad(step, [(1, 1), (0, 0)] if axis == 0 else [(0, 0), (1, 1)])
        self.colour *= (1 - strength * np.clip(jump / 0.012 - 0.3, 0, 1))[..., None]

    def cover(self, upper, opacity, where):
        mask = where[..., None] * opacity
        self.colour = self.colour * (1 - mask) + upper.colour * mask

    def dots(self, points, colour, radius, opacity, on_top=False):
        """Round dots of so many metres; behind what is drawn they are hidden."""
        if not len(points):
            return
        for u, v, depth in self.camera.project(points):
            r = max(radius * self.camera.focal / depth, SUPERSAMPLING)
            x = np.arange(max(int(u - r), 0), min(int(u + r) + 2, self.camera.width))
            y = np.arange(max(int(v - r), 0), min(int(v + r) + 2, self.camera.height))[:, None]
            if depth <= 0.02 or not x.size or not y.size:
                continue
            part = np.s_[y[0, 0]:y[-1, 0] + 1, x[0]:x[-1] + 1]
            mask = opacity * np.clip(r + 0.5 - np.hypot(x - u, y - v), 0, 1)
            if not on_top:
                mask *= self.inverse[part] <= 1 / depth
            self.colour[part] = self.colour[part] * (1 - mask[..., None]) + np.array(colour) * mask[..., None]

    def pixels(self):
        s = SUPERSAMPLING
        return self.colour.reshape(self.camera.height // s, s, self.camera.width // s, s, 3).mean((1, 3)).clip(0, 1)


def view(run, frame, camera, belief=None, contacts=(), target_opacity=1.0):
    """A frame, with walls that let one see through: their far side is solid, their near side a veil."""
    picture, near = Layer(camera, farthest=True), Layer(camera)
    for body, vertices in run.placed(frame, {"world"}):
        picture.draw(vertices, body.triangles, COLOURS["world"])
        near.draw(vertices, body.triangles, COLOURS["world"])
    picture.outline(0.25)
    picture.farthest, picture.inverse = False, np.zeros_like(picture.inverse)
    for body, vertices in run.placed(frame, {"robot", "tool"}):
        picture.draw(vertices, body.triangles, COLOURS[body.kind])
    target = Layer(camera)
    for body, vertices in run.placed(frame, {"target"}):
        target.draw(vertices, body.triangles, COLOURS["target"])
    picture.outline()
    target.outline()
    if belief:
        picture.dots(belief.points, BELIEF, belief.dot, 0.3)
    picture.cover(target, target_opacity, target.inverse > picture.inverse)
    near.outline(0.8)
    picture.cover(near, 0.22, near.inverse > np.maximum(picture.inverse, target.inverse))
    picture.dots(contacts, CONTACT, 0.008, 1.0, on_top=True)
    return picture.pixels()


def show(axes, pixels, title):
    axes.imshow(pixels, interpolation="antialiased")
    axes.set_title(title, fontsize=19, color=INK, loc="left", pad=10)
    axes.axis("off")


def moments(run, most=4):
    """Up to so many steps whose beliefs have points, from the first to the last: [(number of actions done, step)]."""
    all_steps = [(i, step) for i, step in enumerate([run.start, *run.steps]) if len(step.points)]
    wanted = np.unique(np.rint(np.linspace(0, len(all_steps) - 1, most)).astype(int)) if all_steps else []
    return [all_steps[i] for i in wanted]


def belief_panel(axes, run, done, step, planes, limits):
    u, v = planes
    for body, vertices in run.placed(-1, {"target"}):
        axes.add_collection(PolyCollection(vertices[:, [u, v]][body.triangles], facecolors=COLOURS["target"], edgecolors="none", alpha=1, zorder=1))
    spots = np.unique(np.round(step.points[:, [u, v]], 3), axis=0)
    axes.plot(*spots.T, "o", ms=2.4 if len(spots) > 400 else 4, mew=0, color=BELIEF, alpha=0.55, zorder=2)
    touched = np.array([point for action, point in run.contacts if action < done]).reshape(-1, 3)
    axes.plot(touched[:, u], touched[:, v], "o", ms=8, mew=1.5, mec="white", color=CONTACT, zorder=3)
    axes.set(xlim=limits[0], ylim=limits[1], aspect="equal", xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_color("#c8ced4")
    count, unit = step.belief.get("cells"), "pose cells"
    if not count:
        count, unit = step.belief.get("possibly_occupied"), "voxels"
    axes.set_title(f"after {done} action{'s' * (done != 1)}" if done else "at first", fontsize=16, color=INK)
    axes.set_xlabel(f"{count:,} {unit}" if count else "", fontsize=15, color=BELIEF)


def belief_panels(figure, grid, run):
    """The belief seen along the axis in which it is thinnest; along x as the robot sees it."""
    chosen = moments(run)
    if not chosen:
        return
    first = chosen[0][1].points
    target = [vertices for _, vertices in run.placed(-1, {"target"})]
    everything = np.concatenate([first, *target])
    u, v = [(1, 2), (0, 2), (0, 1)][int(np.argmin(np.ptp(first, axis=0)))]
    centre, half = (everything.max(0) + everything.min(0)) / 2, np.ptp(everything[:, [u, v]], axis=0).max() / 2 + 0.02
    limits = [(centre[u] - half, centre[u] + half), (centre[v] - half, centre[v] + half)]
    if (u, v) == (1, 2):
        limits[0] = limits[0][::-1]
    for i, (done, step) in enumerate(chosen):
        belief_panel(figure.add_subplot(grid[i]), run, done, step, (u, v), limits)


def chart(axes, run):
    """What is not yet known, action by action."""
    key = next((k for k in ("bits", "possibly_occupied", "cells") if any(step.belief.get(k) is not None for step in run.steps)), None)
    if key is None:
        return axes.axis("off")
    rows = [(i, step, step.belief[key]) for i, step in enumerate([run.start, *run.steps]) if step.belief.get(key) is not None]
    label = {"bits": "bits left", "possibly_occupied": "voxels left", "cells": "pose cells left"}[key]
    axes.plot([i for i, _, _ in rows], [value for _, _, value in rows], "-o", lw=2.5, ms=5 if len(rows) < 60 else 0, color=BELIEF)
    touched = [(i, value) for i, step, value in rows if step.contact]
    if touched:
        axes.plot(*zip(*touched), "o", ms=11, mec="white", mew=1.5, color=CONTACT, label="contact", ls="none")
        axes.legend(fontsize=15, frameon=False, loc="upper right")
    axes.set_title("What is not yet known", fontsize=19, color=INK, loc="left", pad=10)
    axes.set_xlabel("actions", fontsize=16, color=INK)
    axes.set_ylabel(label, fontsize=16, color=INK)
    axes.set_ylim(bottom=0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.tick_params(labelsize=14, colors=INK)
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)


def wide_view(axes, run, away, beside):
    """The whole scene at the first contact, or halfway."""
    touching = np.flatnonzero(run.contact)
    frame = touching[0] if len(touching) else len(run.poses) // 2
    action = run.action[frame]
    scene = np.concatenate([vertices for _, vertices in run.placed(frame, {"robot", "tool", "world", "target"})])
    middle, reach = (scene.max(0) + scene.min(0)) / 2, np.linalg.norm(np.ptp(scene, axis=0))
    camera = Camera(middle + reach * (0.85 * away + 1.25 * beside + [0, 0, 0.45]), scene, 900, 960)
    before = run.steps[action - 1] if 0 < action <= len(run.steps) else run.start
    contacts = [point for touched, point in run.contacts if touched <= action]
    show(axes, view(run, frame, camera, before, contacts, 0.55), f"Action {action + 1}" + (": the first contact" if len(touching) else ""))


def close_view(axes, run, away, beside):
    """Target and tool at the end."""
    parts = np.concatenate([vertices for _, vertices in run.placed(-1, {"tool", "target"}) or run.placed(-1, COLOURS)])
    middle = (parts.max(0) + parts.min(0)) / 2
    camera = Camera(middle + 0.55 * away + 0.50 * beside + [0, 0, 0.30], parts, 540, 560)
    show(axes, view(run, -1, camera), "Plugged in" if run.inserted else "The end")


def write_picture(run, path):
    target = np.concatenate([vertices for _, vertices in run.placed(-1, {"target"}) or run.placed(-1, COLOURS)]).mean(0)
    towards = (target - run.poses[0, 0, :3])[:2]
    away = -np.append(towards / np.linalg.norm(towards), 0) if towards.any() else np.array([-1.0, 0, 0])
    beside = np.array([-away[1], away[0], 0])

    figure = pyplot.figure(figsize=(19, 10.4), facecolor="white")
    grid = figure.add_gridspec(2, 2, width_ratios=[0.92, 1.08], height_ratios=[0.5, 1], left=0.02, right=0.985, bottom=0.075, top=0.865,
                               wspace=0.05, hspace=0.30)
    wide_view(figure.add_subplot(grid[:, 0]), run, away, beside)
    belief_panels(figure, grid[0, 1].subgridspec(1, 4, wspace=0.08), run)
    below = grid[1, 1].subgridspec(1, 2, width_ratios=[1, 0.9], wspace=0.2)
    close_view(figure.add_subplot(below[0]), run, away, beside)
    chart(figure.add_subplot(below[1]), run)
    cost = max((step.cost or 0 for step in run.steps), default=0)
    figure.suptitle(f"{run.scenario}: {len(run.steps)} actions, {sum(step.contact for step in run.steps)} contacts, cost {cost:.2f} m",
                    x=0.02, y=0.965, ha="left", fontsize=26, color=INK, weight="bold")
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
