"""Articulated low-poly pedestrians, about 1.7 m, facing -Z, feet on y = 0; one primitive each.

The skeleton is posed in the sagittal plane by joint angles in degrees (positive swings forward, to -Z).
"""

import math
from dataclasses import dataclass

import numpy as np

from .geometry import Mesh, translation
from .layout import stream
from .tex_small import CLOTH_CELLS

COAT, TROUSERS, SKIRT, SHIRT, SKIN, HAIR, SHOES, BAG = range(8)  # rows of the clothing atlas
SIDES = 6


@dataclass(frozen=True)
class Pose:
    """Joint angles: hips, knees (bending back), shoulders, elbows (bending forward), as (left, right)."""

    hips: tuple
    knees: tuple
    shoulders: tuple
    elbows: tuple
    lean: float = 0.0


POSES = (
    Pose((24, -20), (6, 22), (-22, 24), (14, 22), 3.0),
    Pose((-16, 20), (32, 4), (18, -18), (20, 12), 3.0),
    Pose((10, -8), (4, 10), (-10, 10), (12, 12), 1.0),
    Pose((2, -2), (2, 4), (2, 28), (8, 95), 0.0),
    Pose((-3, 5), (3, 8), (30, 4), (88, 10), 0.0),
    Pose((28, -22), (10, 30), (-26, 26), (26, 34), 5.0),
)


class _Figure:
    """Builds one person into a mesh."""

    def __init__(self, name, index):
        random = stream("person", index)
        self.mesh = Mesh(name)
        self.size = random.uniform(0.94, 1.05)
        self.female = index % 2 == 1
        self.pose = POSES[index % len(POSES)]
        self.long_coat = random.random() < 0.35
        self.skirt = self.female and random.random() < 0.45
        self.bag = random.random() < 0.5
        self.pick = {row: random.randrange(CLOTH_CELLS) for row in range(8)}
        self.bulk = random.uniform(0.94, 1.1) * (0.92 if self.female else 1.0)
        self.top = COAT if not self.female or self.long_coat else SHIRT

    def build(self):
        """Assemble all parts and return the mesh, its lowest point on y = 0."""
        hip, width = 0.92, 0.095
        lean = math.radians(self.pose.lean)
        chest = np.array([0.0, 1.38, -math.sin(lean) * 0.5])
        self._torso(hip, chest)
        self._head(chest)
        for side, k in ((-1, 0), (1, 1)):
            self._leg(np.array([side * width, hip, 0.0]), self.pose.hips[k], self.pose.knees[k])
            shoulder = chest + np.array([side * 0.185 * self.bulk, 0.035, 0.0])
            hand = self._arm(shoulder, side, self.pose.shoulders[k], self.pose.elbows[k], self.top)
            if self.bag and k == 1:
                self._handbag(hand)
        grounded = Mesh(self.mesh.name)
        grounded.merge(self.mesh, translation(0.0, -self.mesh.lowest(), 0.0))
        return grounded

    def _torso(self, hip, chest):
        b = self.bulk
        waist = 0.125 if self.female else 0.145
        sections = [
            ((0, hip - 0.06, 0), 0.15 * b, 0.105),
            ((0, hip + 0.06, 0), 0.165 * b, 0.115),
            (chest * 0.45 + np.array([0, 0.5, 0]), waist * b, 0.098),
            (chest - (0, 0.1, 0), 0.175 * b, 0.118),
            (chest + (0, 0.05, 0), 0.185 * b, 0.095),
            (chest + (0, 0.11, 0), 0.09, 0.07),
            (chest + (0, 0.13, 0), 0.05, 0.05),
        ]
        self._rings(sections, self.top, 8)
        if self.long_coat:
            skirt = [
                ((0, 0.5, 0.02), 0.23 * b, 0.19),
                ((0, hip - 0.02, 0), 0.18 * b, 0.13),
                ((0, hip + 0.14, 0), 0.15 * b, 0.12),
            ]
            self._rings(skirt, COAT, 8)
        elif self.skirt:
            self._rings(
                [((0, 0.52, 0.0), 0.21, 0.18), ((0, hip, 0), 0.17 * b, 0.12), ((0, hip + 0.08, 0), 0.15 * b, 0.11)],
                SKIRT,
                8,
            )

    def _head(self, chest):
        neck = chest + (0, 0.1, 0)
        self._rings([(neck, 0.055, 0.055), (neck + (0, 0.1, -0.01), 0.05, 0.055)], SKIN, 7)
        h = neck + (0, 0.09, -0.015)
        face = [
            (h, 0.045, 0.05),
            (h + (0, 0.04, -0.012), 0.062, 0.078),
            (h + (0, 0.11, -0.008), 0.074, 0.092),
            (h + (0, 0.17, -0.004), 0.072, 0.088),
            (h + (0, 0.215, 0), 0.045, 0.055),
            (h + (0, 0.23, 0), 0.005, 0.005),
        ]
        self._rings(face, SKIN, 8)
        back = 0.022
        low = -0.03 if self.female else 0.075
        hair = [
            (h + (0, low, back + 0.02), 0.068, 0.06),
            (h + (0, 0.1, back), 0.081, 0.088),
            (h + (0, 0.175, back - 0.008), 0.08, 0.094),
            (h + (0, 0.228, back - 0.015), 0.05, 0.06),
            (h + (0, 0.245, back - 0.015), 0.005, 0.005),
        ]
        self._rings(hair, HAIR, 8)

    def _leg(self, hip, swing, bend):
        knee = hip + _sagittal(0.43, swing)
        ankle = knee + _sagittal(0.42, swing - bend)
        cloth = SKIN if self.skirt else TROUSERS
        wide = 0.75 if self.skirt else 1.0
        self._limb(
            [hip + (0, 0.04, 0), hip * 0.5 + knee * 0.5, knee, knee * 0.5 + ankle * 0.5, ankle],
            [0.088, 0.079, 0.060 * wide, 0.056 * wide, 0.048 * wide],
            cloth,
        )
        pitch = math.radians((swing - bend) * 0.6)
        forward = np.array([0.0, math.sin(pitch), -math.cos(pitch)])
        heel, toe = ankle - forward * 0.07 - (0, 0.05, 0), ankle + forward * 0.17 - (0, 0.052, 0)
        up = np.cross((1.0, 0.0, 0.0), forward) * -1.0
        self._shoe(heel, toe, up if up[1] > 0 else -up)

    def _shoe(self, heel, toe, up):
        rings = []
        for t, half, high in ((0.0, 0.035, 0.07), (0.35, 0.045, 0.085), (0.75, 0.048, 0.045), (1.0, 0.03, 0.03)):
            centre = heel + (toe - heel) * t
            right = np.array([half, 0.0, 0.0])
            rings.append(
                [
                    centre - right - up * 0.025,
                    centre + right - up * 0.025,
                    centre + right * 0.8 + up * high,
                    centre - right * 0.8 + up * high,
                ]
            )
        self._skin_rings(np.asarray(rings), SHOES, caps=True)

    def _arm(self, shoulder, side, swing, bend, cloth):
        out = np.array([side * 0.07, 0.0, 0.0])
        elbow = shoulder + _sagittal(0.29, swing) + out
        wrist = elbow + _sagittal(0.25, swing + bend) + out * 0.1
        self._limb(
            [shoulder + (-side * 0.03, 0.02, 0), shoulder * 0.6 + elbow * 0.4, elbow, wrist],
            [0.062, 0.053, 0.046, 0.036],
            cloth,
        )
        hand = wrist + _sagittal(0.15, swing + bend)
        self._limb([wrist, wrist * 0.5 + hand * 0.5, hand], [0.03, 0.042, 0.018], SKIN)
        return hand

    def _handbag(self, hand):
        rings = []
        for y, half, deep in ((-0.34, 0.05, 0.15), (-0.2, 0.06, 0.16), (-0.08, 0.02, 0.12)):
            c = hand + np.array([0.02, y, 0.0])
            rings.append([c + (-half, 0, deep), c + (half, 0, deep), c + (half, 0, -deep), c + (-half, 0, -deep)])
        self._skin_rings(np.asarray(rings), BAG, caps=True)
        self._limb([hand + (0.02, -0.09, 0.05), hand + (0.02, 0.0, 0.0)], [0.008, 0.008], BAG)

    def _rings(self, sections, cloth, sides):
        rings = []
        for centre, half_x, half_z in sections:
            angles = math.tau * np.arange(sides) / sides
            ring = np.stack([half_x * np.sin(angles), np.zeros(sides), half_z * np.cos(angles)], 1)
            rings.append(ring + np.asarray(centre, float))
        self._skin_rings(np.asarray(rings), cloth)

    def _limb(self, path, radii, cloth):
        path = np.asarray(path, float)
        directions = np.gradient(path, axis=0)
        rings = []
        for point, direction, radius in zip(path, directions, radii):
            axis = direction / np.linalg.norm(direction)
            right = np.array([1.0, 0.0, 0.0]) - axis * axis[0]
            right /= np.linalg.norm(right)
            up = np.cross(axis, right)
            angles = math.tau * np.arange(SIDES) / SIDES
            rings.append(point + radius * (np.cos(angles)[:, None] * right + np.sin(angles)[:, None] * up))
        self._skin_rings(np.asarray(rings), cloth, caps=True)

    def _skin_rings(self, rings, cloth, caps=False):
        """Loft with texture coordinates inside the person's swatch of row ``cloth``."""
        rings = rings * self.size
        count, points = rings.shape[:2]
        u0, v0 = (self.pick[cloth] + 0.12) / CLOTH_CELLS, (cloth + 0.12) / CLOTH_CELLS
        span = 0.76 / CLOTH_CELLS
        uvs = [
            (u0 + span * abs(2 * j / points - 1), v0 + span * i / max(1, count - 1))
            for i in range(count)
            for j in range(points)
        ]
        self.mesh.loft("clothing", rings, uvs=uvs, crease_deg=75.0, cap_start=caps, cap_end=caps)


def _sagittal(length, degrees):
    """A bone hanging down, swung forward (to -Z) by ``degrees``."""
    angle = math.radians(degrees)
    return np.array([0.0, -length * math.cos(angle), -length * math.sin(angle)])


def person(index):
    """The mesh of pedestrian variant ``index``."""
    return _Figure(f"pedestrian_{index:02d}", index).build()
