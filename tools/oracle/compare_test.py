"""tools/oracle/oracle --self-test: the oracle against closed forms. SPDX-License-Identifier: MIT"""

import base64
import io
import json
import re
import struct
from pathlib import Path

import numpy as np
from PIL import Image

import light_test
import radiance
import rays as tracing
from scene import FARTHEST_ASIDE, FARTHEST_UP, LUMINANCE, BadInput, Scene

DOWN = [-np.sqrt(0.5), 0, 0, np.sqrt(0.5)]  # -z to -y
SIDE = 40.0                                 # half the ground, m


class Made:
    """A scene in parts: rectangles, lamps, a camera that looks down from 20 m."""

    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "accessors": [], "bufferViews": [],
                     "materials": [{}], "cameras": [{"type": "perspective", "perspective": {"yfov": 2 * np.arctan(0.25), "znear": 0.1}}],
                     "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": []}}}
        self.node({"name": "camera", "camera": 0, "translation": [0, 20, 0], "rotation": DOWN})
        self.plate([0, 0, 0], SIDE, SIDE)

    def node(self, node, parent=None):
        self.json["nodes"].append(node)
        number = len(self.json["nodes"]) - 1
        (self.json["scenes"][0]["nodes"] if parent is None else self.json["nodes"][parent].setdefault("children", [])).append(number)
        return number

    def array(self, values, kind):
        values = np.asarray(values, np.float32 if kind != "SCALAR" else np.uint16)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes})
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1, "count": len(values), "type": kind, "componentType": 5126 if kind != "SCALAR" else 5123})
        self.data += values.tobytes() + bytes(-values.nbytes % 4)
        return len(self.json["accessors"]) - 1

    def plate(self, place, half_x, half_z, material=0, parent=None, **more):
        corners = [[-half_x, 0, -half_z], [-half_x, 0, half_z], [half_x, 0, half_z], [half_x, 0, -half_z]]
        attributes = {"POSITION": self.array(corners, "VEC3"), "NORMAL": self.array([[0, 1, 0]] * 4, "VEC3"), "TEXCOORD_0": self.array([[0, 0], [0, 1], [1, 1], [1, 0]], "VEC2")}
        self.json["meshes"].append({"primitives": [{"attributes": attributes, "indices": self.array([0, 1, 2, 0, 2, 3], "SCALAR"), "material": material}]})
        return self.node({"mesh": len(self.json["meshes"]) - 1, "translation": place, **more}, parent)

    def lamp(self, place, parent=None, spot=None, opening=None):
        lights = self.json["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"type": "spot" if spot else "point", "intensity": 1000, **({"spot": spot} if spot else {})})
        if opening:
            self.json.setdefault("extras", {"vesper": {"version": 1, "openings": []}})["vesper"]["openings"].append({"light": len(lights) - 1, **opening})
        return self.node({"translation": place, "rotation": DOWN, "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}}, parent)

    def scene(self, folder, binary=False):
        j = json.loads(json.dumps(self.json))
        j["buffers"] = [{"byteLength": len(self.data)} | ({} if binary else {"uri": "data:;base64," + base64.b64encode(self.data).decode()})]
        text = json.dumps(j).encode()
        path = folder / ("made.glb" if binary else "made.gltf")
        if binary:
            text += b" " * (-len(text) % 4)
            text = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.data), len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.data), 0x004E4942) + self.data
        path.write_bytes(text)
        return Scene(path)


class Checks:
    def __init__(self):
        self.failed = 0

    def check(self, what, good, detail=""):
        print(f"{'good  ' if good else 'BROKEN'}  {what}{'' if good else f': {detail}'}")
        self.failed += not good


def ground(noise, count=20000, reach=4.0):
    at = noise.uniform(-reach, reach, (count, 2))
    position = np.stack([at[:, 0], np.zeros(count), at[:, 1]], axis=1)
    up = np.tile([0.0, 1.0, 0.0], (count, 1))
    return {"position": position, "normal": up, "flat": up, "depth": np.zeros(count), "eye": np.array([0.0, 20, 0])}


def seen_from(scene, surfaces, lamp=0, samples=0, noise=None):
    n = len(surfaces["depth"])
    return tracing.visible_share(tracing.Rays(scene), surfaces, np.arange(n), np.full(n, lamp), samples, noise)


def check_plate(checks, folder, noise):
    """A lamp 6 m over the ground, a plate of 2 m x 1.2 m at 2 m: a shadow of 3 m x 1.8 m."""
    made = Made()
    made.plate([0, 2, 0], 1, 0.6)
    made.lamp([0, 6, 0])
    made.lamp([0, 6, 0], spot={"innerConeAngle": 0.2, "outerConeAngle": 0.5})
    s = ground(noise)
    x, z = s["position"][:, 0], s["position"][:, 2]
    inside = np.minimum(1.5 - np.abs(x), 0.9 - np.abs(z))
    certain = np.abs(inside) > 2e-3
    for binary in (False, True):
        scene = made.scene(folder, binary)
        seen = seen_from(scene, s)
        kind = ".glb" if binary else ".gltf"
        checks.check(f"plate between a lamp and a plane, {kind}", len(scene.corners) == 4 and ((seen > 0.5) == (inside < 0))[certain].all(), f"{len(scene.corners)} triangles")
    away = np.sqrt(x * x + z * z + 36)
    light = tracing.lamp_light(scene.lamps, np.int64(0), s["position"], s["normal"])
    checks.check("light of a point lamp", np.allclose(light, 1000 * 6 / away**3, rtol=1e-12), "")
    light = tracing.lamp_light(scene.lamps, np.int64(1), s["position"], s["normal"])
    ramp = np.clip((6 / away - np.cos(0.5)) / (np.cos(0.2) - np.cos(0.5)), 0, 1) ** 2
    checks.check("light of a spot", np.allclose(light, ramp * 1000 * 6 / away**3, rtol=1e-9, atol=1e-12), "")
    pixel = np.stack(np.meshgrid(np.arange(64), np.arange(64)), axis=-1).reshape(-1, 2)
    got = tracing.Rays(scene).surfaces(scene.camera("camera"), pixel, (64, 64))
    want = (pixel + 0.5) / 64 * 2 - 1
    on_plate = (np.abs(want[:, 0] * 4.5) < 1) & (np.abs(want[:, 1] * 4.5) < 0.6)
    depth = np.where(on_plate, 18, 20)
    checks.check("what pixels see", np.allclose(got["position"][:, [0, 2]], want * (depth / 4)[:, None], atol=1e-4) and np.allclose(got["depth"], depth, atol=1e-4), "")
    maps = tracing.Maps(scene.lamps, s["eye"])
    lit = np.arange(len(x)) % 2
    texel, second = maps.place(lit, s["position"])
    back = tracing.unit(maps.direction(lit, texel, second))
    checks.check("map to direction and back", np.allclose(back, tracing.unit(s["position"] - [0, 6, 0]), atol=1e-9), "")
    # Down the axis; half a right angle to x, where o = (1/2, 0); the edge of the cone on the diagonal, near the border.
    corner = np.array([[0, 5.0, 0], [1, 5, 0], [np.sin(0.5) / np.sqrt(2), 6 - np.cos(0.5), -np.sin(0.5) / np.sqrt(2)]])
    square = 2 * maps.place(np.array([0, 0, 1]), corner)[0] / maps.side[[0, 0, 1], None] - 1
    want = [0, 0.5, 0.98]
    checks.check("places on maps", np.allclose(np.abs(square[[0, 1, 2]]).max(1), want, atol=1e-9) and maps.side[0] == 2048, f"{square.tolist()}, side {maps.side[0]}")
    # The edge of the shadow is x = 1.5 m; how far it is in texels follows from the map itself.
    rays = tracing.Rays(scene)
    line = {**s, "position": np.stack([x, np.zeros_like(x), 0.1 * z], axis=1)}
    share = tracing.visible_share(rays, line, np.arange(len(x)), np.zeros(len(x), int))
    near = tracing.near_silhouette(rays, maps, line, np.arange(len(x)), np.zeros(len(x), int), share, 2)
    at = maps.place(np.zeros(len(x), int), line["position"])[0]
    edge = maps.place(np.zeros(len(x), int), np.stack([np.sign(x) * 1.5, np.zeros_like(x), 0.1 * z], axis=1))[0]
    apart = np.linalg.norm(at - edge, axis=1)
    checks.check("distance to an edge in texels", near[apart < 1].all() and not near[apart > 4].any(), f"{near[apart < 1].mean():.3f}, {near[apart > 4].mean():.3f}")


def masked_plate(filtering):
    """A plate whose texture is opaque for u > 1/2, 4 m below a lamp."""
    made = Made()
    alpha = np.zeros((8, 8, 4), np.uint8)
    alpha[:, 4:, 3] = 255
    png = io.BytesIO()
    Image.fromarray(alpha).save(png, "PNG")
    made.json |= {"images": [{"uri": "data:image/png;base64," + base64.b64encode(png.getvalue()).decode()}], "textures": [{"source": 0, "sampler": 0}],
                  "samplers": [{"magFilter": filtering, "wrapS": 33071, "wrapT": 33071}]}
    made.json["materials"].append({"alphaMode": "MASK", "alphaCutoff": 0.5, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    made.plate([0, 2, 0], 1, 0.6, material=1)
    made.lamp([0, 6, 0])
    return made


def check_mask(checks, folder, noise):
    """A shadow from x = 0 to 1.5 m, with texels as they are and between them."""
    for filtering in (9728, 9729):
        made = masked_plate(filtering)
        s = ground(noise)
        inside = np.minimum.reduce([s["position"][:, 0], 1.5 - s["position"][:, 0], 0.9 - np.abs(s["position"][:, 2])])
        certain = np.abs(inside) > 2e-3
        scene = made.scene(folder)
        seen = seen_from(scene, s)
        checks.check(f"masked plate, {'nearest' if filtering == 9728 else 'linear'} texels", ((seen > 0.5) == (inside < 0))[certain].all(), "")
        scene.grey_copy(folder / "grey.gltf", np.array([[1.0, 0, 0]]))
        copied = Scene(folder / "grey.gltf")
        same = np.array_equal(seen_from(copied, s), seen) and np.isclose(copied.lamps["intensity"][0], 1000)
        light = copied.json["extensions"]["KHR_lights_punctual"]["lights"][0]
        checks.check("its grey copy with a red lamp", same and np.isclose(light["intensity"] * LUMINANCE[0], 1000), "")


def check_fixture(checks, folder, noise):
    """A shade right under the lamp does not hide it, unless it is no part of the fixture or that is over 20 m away."""
    s = ground(noise)
    for what, far, own, hides in (("fixture of its lamp", 0, True, False), ("plate of another node", 0, False, True), ("fixture with a part 30 m away", 30, True, True)):
        made = Made()
        post = made.node({"translation": [0, 5, 0]})
        made.plate([0, 0, 0], 5, 5, parent=post)
        if far:
            made.plate([far, -5, 0], 1, 1, parent=post)
        made.lamp([0, 1, 0], parent=post) if own else made.lamp([0, 6, 0])
        checks.check(what, (seen_from(made.scene(folder), s) == (0 if hides else 1)).all(), "")


def check_motion(checks, folder, noise):
    """Transforms at time 0, under a parent that mirrors and scales."""
    made = Made()
    parent = made.node({"scale": [-2, 1, 1]})
    plate = made.plate([9, 9, 9], 0.5, 0.6, parent=parent)
    made.json["animations"] = [{"samplers": [{"input": made.array(np.array([[-1.0], [1.0]]), "VEC2"), "output": made.array([[-0.5, 2, 0], [-1.5, 2, 0]], "VEC3")}],
                                "channels": [{"sampler": 0, "target": {"node": plate, "path": "translation"}}]}]
    time = made.json["accessors"][made.json["animations"][0]["samplers"][0]["input"]]
    time |= {"type": "SCALAR", "count": 2}
    made.lamp([0, 6, 0])
    s = ground(noise)
    x = s["position"][:, 0]
    inside = np.minimum(1.5 - np.abs(x - 3), 0.9 - np.abs(s["position"][:, 2]))
    seen = seen_from(made.scene(folder), s)
    checks.check("mirrored, moving plate at time 0", ((seen > 0.5) == (inside < 0))[np.abs(inside) > 2e-3].all(), "")


def check_opening(checks, folder, noise):
    """A disc of 0.5 m radius at 6 m over an edge at 3 m: the ground sees a segment of it."""
    made = Made()
    made.plate([20, 3, 0], 20, 40)
    made.lamp([0, 6, 0], spot={"innerConeAngle": 1.4, "outerConeAngle": 1.5}, opening={"width_m": 1.0, "height_m": 1.0, "round": True})
    s = ground(noise, 4000, 1.0)
    seen = seen_from(made.scene(folder), s, samples=256, noise=noise)
    # The edge x = 0 at half the height: of the disc's points, those with x' > -x lie behind the plate.
    d = np.clip(-s["position"][:, 0] / 0.5, -1, 1)
    want = (np.arcsin(d) + d * np.sqrt(1 - d * d)) / np.pi + 0.5
    off = np.abs(seen - want)
    checks.check("share of an opening behind an edge", off.max() < 0.03 and off.mean() < 0.004, f"off by {off.max():.4f}, in the mean {off.mean():.4f}")


def check_radiance(checks, folder, noise):
    """Radiance on a plate, a masked plate, and a shade over which its lamp stands; a second lamp sees the shade from above."""
    plate = Made()
    plate.plate([0, 2, 0], 1, 0.6)
    plate.lamp([0, 6, 0], spot={"innerConeAngle": 0.2, "outerConeAngle": 0.7})
    shade = Made()
    post = shade.node({"translation": [0, 5, 0]})
    shade.plate([0, 0, 0], 1, 1, parent=post)
    shade.lamp([0, 1, 0], parent=post)
    shade.lamp([3, 8, 0])
    for what, made in (("plate", plate), ("masked plate", masked_plate(9729)), ("shade of one of two lamps", shade)):
        scene, s = made.scene(folder), ground(noise, 1000)
        points, lit, light = tracing.pairs_of(scene.lamps, s, 1e-9)
        want = np.bincount(points, light * tracing.visible_share(tracing.Rays(scene), s, points, lit), 1000)
        got = radiance.Radiance(scene, folder).illuminance(s["position"] + [0, tracing.OFF_SURFACE, 0], s["normal"])
        same = np.abs(got - want) <= 1e-3 * want.max()
        checks.check(f"Radiance: {what}", same.mean() > 0.99, f"{same.mean():.4f} agree")


def check_refusals(checks, folder):
    for what, change in (("a required extension", {"extensionsRequired": ["KHR_draco_mesh_compression"]}), ("measured lamps", {"extensionsUsed": ["EXT_lights_ies"]})):
        made = Made()
        made.lamp([0, 6, 0])
        made.json |= change
        try:
            made.scene(folder)
            checks.check(f"refuses {what}", False, "it is read")
        except BadInput as error:
            checks.check(f"refuses {what}", "does not read" in str(error), str(error))


# Numbers of the engine that the oracle repeats, by their names there.
REPEATED = {"const uint kRegion": tracing.LEAST_SIDE, "kMostMapSide": tracing.MOST_SIDE, "kMostZoom": tracing.MOST_ZOOM,
            "kFaintestLight": tracing.FAINTEST, "kWidestFlat": tracing.WIDEST_FLAT, "kFarthestAside": FARTHEST_ASIDE, "kFarthestUp": FARTHEST_UP}


def check_constants(checks):
    root = Path(__file__).resolve().parent.parent.parent
    code = "".join(file.read_text() for folder in ("engine", "glsl") for file in sorted((root / folder).rglob("*")) if file.suffix in (".h", ".cpp"))
    for name, value in REPEATED.items():
        found = {text.strip() for text in re.findall(rf"\b{name} = ([^,;]+)[,;]", code)}
        values = {eval(re.sub(r"(\d)u\b", r"\1", text), {"kPi": np.pi}) for text in found}
        checks.check(f"{name} as in the engine", values == {value}, f"{value} here, {', '.join(found) or 'nothing'} there")
    rows = re.findall(r'X\(uint32_t, shadow_memory, "MiB", \d+, \d+, \d+, \d+, (\d+),', code)
    checks.check("shadow_memory as in the engine", rows == [str(tracing.SHADOW_MEMORY)], f"{tracing.SHADOW_MEMORY} here, {rows} there")


def main(folder):
    checks, noise = Checks(), np.random.default_rng(7)
    check_constants(checks)
    check_plate(checks, folder, noise)
    check_mask(checks, folder, noise)
    check_fixture(checks, folder, noise)
    check_motion(checks, folder, noise)
    check_opening(checks, folder, noise)
    check_radiance(checks, folder, noise)
    light_test.main(checks, Made, folder, noise)
    check_refusals(checks, folder)
    return 1 if checks.failed else 0
