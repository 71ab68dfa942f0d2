"""tools/oracle/oracle --self-test: paths of rays against closed forms. SPDX-License-Identifier: MIT"""

import base64
import io

import numpy as np
from PIL import Image

import radiance
import rays as tracing
from light import EMITTERS, LAMPS, SKY, Light
from scene import LUMINANCE

BLACK, WALL = 0, 1                          # materials: of the ground, of rooms
TURNS = {"up": [0, 0, 0, 1], "down": [1, 0, 0, 0], "east": [0, 0, -np.sqrt(0.5), np.sqrt(0.5)],
         "west": [0, 0, np.sqrt(0.5), np.sqrt(0.5)], "south": [np.sqrt(0.5), 0, 0, np.sqrt(0.5)],
         "north": [-np.sqrt(0.5), 0, 0, np.sqrt(0.5)]}
AWAY = {"up": [0, -1, 0], "down": [0, 1, 0], "east": [-1, 0, 0], "west": [1, 0, 0], "south": [0, 0, -1],
        "north": [0, 0, 1]}


def material(reflectance, emission=(0, 0, 0), **more):
    emission = np.array(emission, float)
    strength = max(emission.max(), 1e-9)
    factor = [*np.broadcast_to(reflectance, 3).astype(float).tolist(), 1]
    return {"pbrMetallicRoughness": {"baseColorFactor": factor, "metallicFactor": 0, "roughnessFactor": 1},
            "emissiveFactor": (emission / strength).tolist(),
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}, **more}


def dark(made_class, lamp=(0, -9, 0)):
    """A black ground, and a lamp that shines from below it."""
    made = made_class()
    made.json["materials"][BLACK] = material(0)
    made.lamp(list(lamp))
    return made


def room(made, middle, number, sides=tuple(TURNS), half=2.0):
    """Plates that face inwards."""
    for side in sides:
        place = np.array(middle) + half * np.array(AWAY[side])
        made.plate(place.tolist(), half * 1.001, half * 1.001, material=number, rotation=TURNS[side])


def points(position, normal=(0, 1, 0), reach=0.0, noise=None, count=16):
    position = np.tile(np.array(position, float), (count, 1))
    if reach:
        position[:, [0, 2]] += noise.uniform(-reach, reach, (count, 2))
    normal = np.tile(np.array(normal, float), (count, 1))
    return {"position": position, "normal": normal, "flat": normal, "depth": np.zeros(count), "eye": np.zeros(3)}


def illuminance(scene, seen, noise, side=32):
    """lx at points, (point, source), and the standard error of their sum."""
    parts, variance = Light(tracing.Rays(scene)).traced(seen, np.ones((len(seen["depth"]), 3)), side, noise)
    return np.pi * parts.sum(1), np.pi * np.sqrt(variance) / side


def agrees(checks, what, got, error, want, largest=0.01):
    """The mean over points within 3 standard errors, which must be small; and no single point far off."""
    off, scale = got - want, np.mean(want)
    mean_error = np.sqrt((error**2).sum()) / len(got)
    good = abs(off.mean()) <= 3 * mean_error + 1e-4 * scale and mean_error <= largest * scale
    good &= (np.abs(off) <= 6 * error + 1e-4 * scale).all()
    checks.check(what, good, f"{np.mean(got):.5g} +- {mean_error:.2g}, not {scale:.5g}")


def check_furnace(checks, made_class, folder, noise):
    """In a closed room whose walls emit L and reflect R: E = pi L / (1 - R), in each colour."""
    reflectance, emission = np.array([0.6, 0.4, 0.2]), np.array([3.0, 2.0, 5.0])
    made = dark(made_class)
    made.json["materials"].append(material(reflectance, emission))
    room(made, [0, 3, 0], WALL)
    got, error = illuminance(made.scene(folder), points([0, 1, 0], reach=1.9, noise=noise), noise)
    agrees(checks, "closed room that glows", got.sum(1), error, np.pi * LUMINANCE @ (emission / (1 - reflectance)))


def corner_factor(x, z, h):
    """Form factor from a level place to a level rectangle, one corner of which is over it at height h."""
    a, b = x / h, z / h
    p, q = np.sqrt(1 + a * a), np.sqrt(1 + b * b)
    return (a / p * np.arctan(b / p) + b / q * np.arctan(a / q)) / (2 * np.pi)


def plate_factor(position, low, high, h):
    x0, x1 = low[0] - position[:, 0], high[0] - position[:, 0]
    z0, z1 = low[1] - position[:, 2], high[1] - position[:, 2]
    return corner_factor(x1, z1, h) - corner_factor(x0, z1, h) - corner_factor(x1, z0, h) + corner_factor(x0, z0, h)


def check_square(checks, made_class, folder, noise):
    """A square of 2 m over a plane: from its front only, on both sides, with a picture, as a lamp's glass."""
    cases = (("from 2 m", 2, "down", {}, 1), ("from 5 cm", 0.05, "down", {}, 1), ("turned away", 2, "up", {}, 0),
             ("both sides", 2, "up", {"doubleSided": True}, 1))
    for what, height, turn, more, share in cases:
        made = dark(made_class)
        made.json["materials"].append(material(0, [100, 100, 100], **more))
        made.plate([0, height, 0], 1, 1, material=1, rotation=TURNS[turn])
        seen = points([0, 0, 0], reach=0.9 if height < 1 else 3, noise=noise)
        got, error = illuminance(made.scene(folder), seen, noise)
        agrees(checks, f"square that glows, {what}", got[:, EMITTERS], error,
               share * 100 * np.pi * plate_factor(seen["position"], (-1, -1), (1, 1), height))
    check_half(checks, made_class, folder, noise)
    made = dark(made_class)
    made.json["materials"].append(material(0, [100, 100, 100]))
    post = made.node({"translation": [0, 2, 0]})
    made.plate([0, 0, 0], 1, 1, material=1, parent=post, rotation=TURNS["down"])
    made.lamp([0, 1, 0], parent=post)
    got, _ = illuminance(made.scene(folder), points([0, 0, 0]), noise)
    checks.check("square that holds a lamp", (got[:, EMITTERS] == 0).all(), f"{got[:, EMITTERS].mean()} lx")


def check_half(checks, made_class, folder, noise):
    """Half of a picture emits: at x > 0 the code 188, sRGB."""
    codes = np.zeros((2, 4, 3), np.uint8)
    codes[:, 2:] = 188
    png = io.BytesIO()
    Image.fromarray(codes).save(png, "PNG")
    made = dark(made_class)
    made.json |= {"images": [{"uri": "data:image/png;base64," + base64.b64encode(png.getvalue()).decode()}],
                  "textures": [{"source": 0, "sampler": 0}],
                  "samplers": [{"magFilter": 9728, "wrapS": 33071, "wrapT": 33071}]}
    made.json["materials"].append(material(0, [100, 100, 100], emissiveTexture={"index": 0}))
    made.plate([0, 2, 0], 1, 1, material=1, rotation=TURNS["down"])
    seen = points([0, 0, 0], reach=3, noise=noise)
    got, error = illuminance(made.scene(folder), seen, noise)
    luminance = 100 * ((188 / 255 + 0.055) / 1.055) ** 2.4
    agrees(checks, "square of which half glows", got[:, EMITTERS], error,
           luminance * np.pi * plate_factor(seen["position"], (0, -1), (1, 1), 2))


def check_sky(checks, made_class, folder, noise):
    """Sky of L over a plane: pi L, less what a black plate of 2 m x 2 m hides."""
    for what, height in (("over a plane", None), ("past a plate", 1.5)):
        made = dark(made_class)
        made.json["materials"].append(material(0))
        made.json["extras"] = {"vesper": {"version": 1, "transfer": {"kind": "srgb"}, "sky": {"luminance_cd_m2": 0.5}}}
        if height:
            made.plate([0, height, 0], 1, 1, material=1)
        seen = points([0, 0, 0], reach=2, noise=noise)
        got, error = illuminance(made.scene(folder), seen, noise)
        hidden = plate_factor(seen["position"], (-1, -1), (1, 1), height) if height else np.zeros(16)
        agrees(checks, f"sky {what}", got[:, SKY], error, 0.5 * np.pi * (1 - hidden))


def check_leak(checks, made_class, folder, noise):
    """Two rooms with one wall between them: no light of one comes to the other, nor of lamps outside."""
    made = dark(made_class)
    made.json["materials"] += [material(0.8), material(0.8, [1000, 1000, 1000])]
    made.json["extras"] = {"vesper": {"version": 1, "transfer": {"kind": "srgb"}, "sky": {"luminance_cd_m2": 5}}}
    made.lamp([0, 9, 0])
    room(made, [-2, 3, 0], WALL)
    room(made, [2, 3, 0], WALL, sides=("up", "down", "west", "south", "north"))
    made.plate([2, 4.9, 0], 1, 1, material=2, rotation=TURNS["down"])
    scene = made.scene(folder)
    got, _ = illuminance(scene, points([-2, 1, 0], reach=1.9, noise=noise), noise)
    lit, _ = illuminance(scene, points([2, 1, 0], reach=1.9, noise=noise), noise)
    checks.check("light stays in its room", (got == 0).all() and (lit[:, EMITTERS] > 100).all(), f"{got.max()} lx")


def check_reflected(checks, made_class, folder, noise):
    """A surface 2 m over the ground that faces it, and lamps that light the ground: the integral over the ground."""
    made = made_class()
    reflectance = np.array([0.2, 0.5, 0.7])
    made.json["materials"][0] = material(reflectance)
    made.lamp([1, 3, 0])
    made.lamp([-2, 6, 1], spot={"innerConeAngle": 0.2, "outerConeAngle": 0.5})
    made.json["extensions"]["KHR_lights_punctual"]["lights"][1]["color"] = [1, 0.2, 0.1]
    scene = made.scene(folder)
    seen = points([0, 2, 0], (0, -1, 0))
    got, error = illuminance(scene, seen, noise)
    step = 0.02
    grid = np.arange(-40 + step / 2, 40, step)
    want = 0.0
    for x in grid:
        ground = np.stack([np.full_like(grid, x), np.zeros_like(grid), grid], axis=1)
        factor = (2 / np.linalg.norm(ground - [0, 2, 0], axis=1)) ** 2 / (x * x + grid**2 + 4) / np.pi * step**2
        for k in range(2):
            lit = tracing.lamp_light(scene.lamps, np.int64(k), ground, np.array([0, 1.0, 0]))
            want += (lit * factor).sum() * (reflectance * scene.lamps["colour"][k]) @ LUMINANCE
    agrees(checks, "lamps, reflected by a plane", got[:, LAMPS], error, want)


def check_radiance(checks, made_class, folder, noise):
    """Radiance in a closed room with a lamp and a plate that glows."""
    made = dark(made_class, (0.5, 3, 0.5))
    made.json["materials"] += [material([0.6, 0.5, 0.4]), material(0, [100, 50, 20])]
    room(made, [0, 3, 0], WALL)
    made.plate([0.5, 4.5, -0.5], 0.7, 0.7, material=2, rotation=TURNS["down"])
    made.json["extensions"]["KHR_lights_punctual"]["lights"][0]["color"] = [1, 0.5, 0.2]
    scene, seen = made.scene(folder), points([0, 1, 0], reach=1.9, noise=noise)
    light = Light(tracing.Rays(scene))
    parts, _ = light.traced(seen, np.ones((16, 3)), 32, noise)
    direct = tracing.lamp_light(scene.lamps, np.int64(0), seen["position"], seen["normal"])
    got = radiance.Radiance(scene, folder, light).all_light(
        seen["position"] + [0, tracing.OFF_SURFACE, 0], seen["normal"], 12, 1024) @ LUMINANCE
    ratio = (np.pi * parts.sum() + direct.sum()) / got.sum()
    checks.check("Radiance: all light in a room", abs(ratio - 1) < 0.02, f"paths / Radiance {ratio:.4f}")


def main(checks, made_class, folder, noise):
    check_furnace(checks, made_class, folder, noise)
    check_square(checks, made_class, folder, noise)
    check_sky(checks, made_class, folder, noise)
    check_leak(checks, made_class, folder, noise)
    check_reflected(checks, made_class, folder, noise)
    check_radiance(checks, made_class, folder, noise)
