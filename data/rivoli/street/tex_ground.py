"""Road and pavement textures as linear reflectance images (rows, columns, 3)."""

import numpy as np
from PIL import Image, ImageDraw

from .noise import blend, bricks, grey_to_rgb, smoothstep, spectral, threshold_band


def asphalt():
    """Worn dry asphalt over 6 m: aggregate, polished tracks, oil, hair cracks."""
    shape = (1024, 1024)
    aggregate = spectral(shape, 0.15, 61)
    grey = 0.090 + 0.014 * aggregate + 0.008 * spectral(shape, 1.1, 62) + 0.006 * spectral(shape, 2.0, 63)
    image = grey_to_rgb(grey, (1.0, 0.985, 0.96))
    stones = smoothstep(2.0, 2.8, spectral(shape, 0.3, 64))
    image = blend(image, np.full(3, 0.17), 0.7 * stones)
    region = smoothstep(0.2, 1.2, spectral(shape, 1.8, 66))
    cracks = threshold_band(spectral(shape, 1.9, 65) + 0.05 * aggregate, 0.035) * region
    image = blend(image, np.full(3, 0.03), 0.75 * cracks)
    oil = smoothstep(1.4, 2.6, spectral(shape, 1.5, 67))
    return blend(image, np.full(3, 0.05), 0.45 * oil)


def paving():
    """Parisian pavement over 4 m: grey flags 0.5 m by 0.8 m, gum spots, stains."""
    shape = (1024, 1024)
    joint, tone = bricks(shape, 8, 5, 2.2, 71)
    grey = 0.235 + 0.022 * tone + 0.012 * spectral(shape, 0.3, 72) + 0.016 * spectral(shape, 1.6, 73)
    image = grey_to_rgb(grey, (1.0, 0.97, 0.92))
    image = blend(image, np.full(3, 0.07), 0.6 * joint)
    rng = np.random.default_rng(74)
    gum = Image.new("L", (1024, 1024), 0)
    pen = ImageDraw.Draw(gum)
    for x, y, r in zip(rng.integers(8, 1016, 150), rng.integers(8, 1016, 150), rng.integers(1, 6, 150)):
        pen.ellipse([int(x - r), int(y - r), int(x + r), int(y + r)], fill=150)
    return blend(image, np.full(3, 0.10), np.asarray(gum, float) / 255.0 * 0.7)


def arcade_floor():
    """Chequered stone under the arcades, 0.625 m squares, 2.5 m period."""
    shape = (512, 512)
    y, x = np.mgrid[0:512, 0:512] // 128
    dark = (x + y) % 2 == 1
    joint, tone = bricks(shape, 4, 4, 1.6, 81, stagger=0.0)
    grey = np.where(dark, 0.13, 0.30) + 0.02 * tone + 0.010 * spectral(shape, 1.2, 82)
    image = grey_to_rgb(grey, (1.0, 0.95, 0.86))
    return blend(image, np.full(3, 0.08), 0.5 * joint)


def granite():
    """Kerb granite with a joint every metre."""
    shape = (256, 256)
    grey = 0.25 + 0.035 * spectral(shape, 0.2, 91) + 0.015 * spectral(shape, 1.5, 92)
    image = grey_to_rgb(grey, (1.0, 0.98, 0.97))
    image[:, :3] *= 0.35
    image[:3, :] *= 0.5
    return image


def gravel():
    """The sandy gravel of a Paris garden."""
    shape = (512, 512)
    grey = 0.31 + 0.045 * spectral(shape, 0.35, 101) + 0.02 * spectral(shape, 1.6, 102)
    return grey_to_rgb(grey, (1.0, 0.90, 0.72))


def marking():
    """Thermoplastic white paint worn down to the asphalt in places."""
    shape = (512, 512)
    grey = 0.55 + 0.02 * spectral(shape, 0.5, 111)
    image = grey_to_rgb(grey, (1.0, 0.99, 0.95))
    wear = smoothstep(1.0, 2.0, spectral(shape, 0.7, 112) + 0.6 * spectral(shape, 1.8, 113))
    tyre = smoothstep(0.6, 2.4, spectral(shape, 1.6, 114))
    image = blend(image, np.full(3, 0.30), 0.35 * tyre)
    return blend(image, np.full(3, 0.11), 0.85 * wear)


def covers():
    """Left half: a round manhole cover set in asphalt; right half: a kerb gully grating."""
    image = np.zeros((256, 512, 3))
    asphalt_tile = 0.088 + 0.010 * spectral((256, 512), 0.2, 121)
    image += asphalt_tile[..., None] * np.array([1.0, 0.985, 0.96])
    y, x = np.mgrid[0:256, 0:256] - 127.5
    radius = np.hypot(x, y)
    iron = 0.10 + 0.05 * ((np.floor(x / 12) + np.floor(y / 12)) % 2) + 0.012 * spectral((256, 256), 0.8, 122)
    iron = np.where(np.abs(radius - 98) < 4, 0.03, iron)
    left = image[:, :256]
    left[:] = np.where((radius < 116)[..., None], iron[..., None] * np.array([1.0, 0.95, 0.9]), left)
    right = image[:, 256:]
    bars = np.where((np.floor(x / 13) % 2 == 0) & (np.abs(y) < 100), 0.012, 0.12)
    inside = (np.abs(x) < 118) & (np.abs(y) < 118)
    right[:] = np.where(inside[..., None], bars[..., None] * np.ones(3), right)
    return image
