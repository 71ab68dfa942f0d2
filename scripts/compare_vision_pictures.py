"""Pictures of scripts/compare-vision in cd/m^2, and what is done to them. SPDX-License-Identifier: MIT"""

import json
import shutil

import cv2
import numpy as np

from compared_pictures import HDR, ROOT, WEIGHTS, cleaned, read_exr, run

WIDTH, HEIGHT = 480, 304  # px: whole squares of 16 px and blocks of 8 px
# What is no picture of ours has no unit: its log average becomes so many cd/m^2.
SHARED = [(HDR / "polyhaven/dikhololo_night_1k.hdr", 0.1), (HDR / "openexr-images/ScanLines/CandleGlass.exr", 0.1),
          (HDR / "openexr-tests/comp_zip.exr", 1), (HDR / "openexr-images/ScanLines/Desk.exr", 3),
          (HDR / "polyhaven/potsdamer_platz_1k.hdr", 3), (HDR / "openexr-images/ScanLines/Carrots.exr", 10),
          (HDR / "openexr-images/Chromaticities/Rec709.exr", 30), (HDR / "polyhaven/pedestrian_overpass_1k.hdr", 100)]
CAMERAS = "driver", "pedestrian", "overview", "crossing"
DOZEN = 12


def luminance(rgb):
    return np.maximum(rgb @ WEIGHTS, 1e-6)


def log_average(rgb):
    return np.exp(np.log(luminance(rgb)).mean())


def window(rgb):
    """The middle of a picture, in the size of all."""
    scale = max(WIDTH / rgb.shape[1], HEIGHT / rgb.shape[0])
    size = max(WIDTH, round(rgb.shape[1] * scale)), max(HEIGHT, round(rgb.shape[0] * scale))
    rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
    top, left = (rgb.shape[0] - HEIGHT) // 2, (rgb.shape[1] - WIDTH) // 2
    return rgb[top:top + HEIGHT, left:left + WIDTH]


def synthetic(noise):
    """A texture of all frequencies from 0.1 to 10 cd/m^2 or so, with ten lamps: for want of pictures."""
    frequency = np.hypot(np.fft.fftfreq(HEIGHT)[:, None], np.fft.fftfreq(WIDTH)[None])
    frequency[0, 0] = 1
    texture = np.fft.ifft2(np.fft.fft2(noise.normal(size=(HEIGHT, WIDTH))) / frequency).real
    light = np.exp(texture / texture.std())
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    for _ in range(10):
        light += 1000 * (np.hypot(x - noise.uniform(0, WIDTH), y - noise.uniform(0, HEIGHT)) < noise.uniform(1, 6))
    return light[..., None] * np.ones(3)


class Street:
    """The night street of data/rivoli."""

    def __init__(self, vesper, folder):
        self.vesper, self.folder, self.scenes = vesper, folder, {}
        self.data = shutil.copytree(ROOT / "data/rivoli", folder / "rivoli")

    def scene(self, lamps):
        """glTF with the luminous intensity of its street lamps times `lamps`."""
        if lamps not in self.scenes:
            photometry = json.loads((self.data / "rivoli.photometry.json").read_text())
            for lamp in photometry["lamps"]:
                if lamp["name"].startswith("street lamp"):
                    lamp["intensity_cd"] *= lamps
            file, self.scenes[lamps] = self.data / "lamps.json", self.folder / f"street{lamps}.gltf"
            file.write_text(json.dumps(photometry))
            run([self.vesper, "convert", self.data / "rivoli.gltf", "--photometry", file, "-o", self.scenes[lamps]])
        return self.scenes[lamps]

    def seen(self, camera, *options, lamps=1):
        made = self.folder / "seen.exr"
        run([self.vesper, "render", self.scene(lamps), "--camera", camera, "--size", f"{WIDTH}x{HEIGHT}", "--indirect",
             "off", *options, "-o", made])
        return read_exr(made)


def pictures(street, noise):
    """A dozen of (name, cd/m^2)."""
    made = [(f"street, {camera}", street.seen(camera, "--samples", "16")) for camera in CAMERAS]
    for file, level in SHARED:
        if file.exists():
            rgb = np.maximum(window(cleaned(file)), 0)
            made.append((file.stem, rgb * (level / log_average(rgb))))
    while len(made) < DOZEN:
        made.append((f"synthetic {len(made)}", synthetic(noise)))
    return made


def in_proportion(rgb, changed):
    """With another luminance."""
    return rgb * (changed / luminance(rgb))[..., None]


def noisy(rgb, strength, noise):
    return in_proportion(rgb, luminance(rgb) * np.exp(strength * noise.normal(size=rgb.shape[:2])))


def blurred(rgb, strength, _):
    return np.maximum(cv2.GaussianBlur(rgb, (0, 0), strength), 0)


def flattened(rgb, strength, _):
    middle = log_average(rgb)
    return in_proportion(rgb, middle * (luminance(rgb) / middle) ** (1 - strength))


def brightened(rgb, strength, _):
    return rgb * (1 + strength)


def with_spot(rgb, strength, noise):
    """A soft spot of 8 px, as many times as bright as what it lies on and the picture's log average together."""
    y, x = noise.integers(40, HEIGHT - 40), noise.integers(40, WIDTH - 40)
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    spot = np.exp(-((rows - y) ** 2 + (columns - x) ** 2) / (2 * 4.0**2))
    return rgb + (strength * (luminance(rgb)[y, x] + log_average(rgb)) * spot)[..., None]


def in_blocks(rgb, strength, _):
    """Cosine transforms of 8 x 8 px of the logarithm of luminance, in steps, as JPEG's."""
    log = np.log(luminance(rgb))
    for y in range(0, HEIGHT, 8):
        for x in range(0, WIDTH, 8):
            block = cv2.dct(log[y:y + 8, x:x + 8])
            log[y:y + 8, x:x + 8] = cv2.idct(np.round(block / strength) * strength)
    return in_proportion(rgb, np.exp(log))


# Kinds, with strengths from hardly visible to obvious.
DISTORTIONS = {"noise": (noisy, (0.01, 0.05, 0.25)), "blur": (blurred, (0.4, 1, 3)),
               "contrast": (flattened, (0.02, 0.1, 0.3)), "brightness": (brightened, (0.02, 0.15, 0.6)),
               "spot": (with_spot, (0.05, 0.5, 5)), "blocks": (in_blocks, (0.05, 0.3, 1.5))}


def pairs(made, street, noise):
    """(name, kind, strength, reference, distorted): each kind once for each picture, in strengths by turns."""
    for i, (name, rgb) in enumerate(made):
        for j, (kind, (distort, strengths)) in enumerate(DISTORTIONS.items()):
            strength = strengths[(i + j) % len(strengths)]
            yield name, kind, strength, rgb, distort(rgb, strength, noise)
        if name.startswith("street, "):
            camera = name.removeprefix("street, ")
            yield name, "edges", 1, rgb, street.seen(camera, "--anti-aliasing", "off")
            yield name, "lamps", 0.8, rgb, street.seen(camera, "--samples", "16", lamps=0.8)
