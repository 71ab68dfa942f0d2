"""Stone, brick and roofing textures as linear reflectance images (rows, columns, 3)."""

import numpy as np

from .noise import blend, bricks, grey_to_rgb, smoothstep, spectral, streaks

LIMESTONE = (1.0, 0.91, 0.75)
SOOT = (0.11, 0.10, 0.085)


def limestone():
    """Ashlar of 10 courses over 3.75 m with joints, blocks of slightly different tone and rain stains."""
    shape = (1024, 1024)
    joint, tone = bricks(shape, 10, 5, 3.0, 11)
    grey = 0.425 + 0.032 * tone + 0.012 * spectral(shape, 0.6, 12) + 0.020 * spectral(shape, 1.6, 13)
    image = grey_to_rgb(grey, LIMESTONE)
    warm = grey_to_rgb(grey, (1.02, 0.86, 0.64))
    image = blend(image, warm, 0.5 * smoothstep(0.2, 1.0, tone))
    image = blend(image, np.full(3, 1.0) * SOOT, 0.16 * smoothstep(0.4, 2.2, streaks(shape, 14)))
    image = blend(image, np.full(3, 1.0) * SOOT, 0.45 * joint)
    pores = smoothstep(2.2, 3.0, spectral(shape, 0.25, 15))
    return blend(image, 0.6 * image, pores)


def stone_trim():
    """Dressed stone of mouldings: no joints, faint stains."""
    shape = (512, 512)
    grey = 0.42 + 0.012 * spectral(shape, 0.5, 21) + 0.022 * spectral(shape, 1.6, 22)
    image = grey_to_rgb(grey, (1.0, 0.92, 0.78))
    return blend(image, np.full(3, 1.0) * SOOT, 0.18 * smoothstep(0.2, 2.0, streaks(shape, 23, 6.0)))


def brick():
    """Chimney brick, 12 courses per tile."""
    shape = (256, 256)
    joint, tone = bricks(shape, 12, 4, 1.4, 31)
    grey = 0.24 + 0.05 * tone + 0.02 * spectral(shape, 1.0, 32)
    image = grey_to_rgb(grey, (1.0, 0.62, 0.45))
    return blend(image, np.full(3, 0.26), 0.8 * joint)


def zinc():
    """Rolled zinc sheets with standing seams every 0.625 m and grey-white bloom."""
    shape = (512, 512)
    x = np.mgrid[0:512, 0:512][1] / 512.0 * 6.0
    distance = np.abs(x - np.round(x)) * 512.0 / 6.0
    seam = 1.0 - smoothstep(1.5, 4.0, distance)
    shade = smoothstep(3.0, 5.0, distance) - smoothstep(5.0, 11.0, distance)
    panel = np.random.default_rng(41).uniform(-1, 1, (2, 6))
    row = (np.mgrid[0:512, 0:512][0] // 256).astype(int)
    tone = panel[row, np.floor(x).astype(int) % 6]
    grey = 0.25 + 0.02 * tone + 0.015 * spectral(shape, 1.5, 42) + 0.012 * streaks(shape, 43, 20.0)
    grey = grey + 0.08 * seam - 0.07 * np.clip(shade, 0, 1)
    lap = np.abs((np.mgrid[0:512, 0:512][0] % 256) - 128) > 126
    return grey_to_rgb(np.where(lap, grey * 0.75, grey), (0.95, 1.0, 1.06))


def slate():
    """Slates, 14 courses over 1.875 m."""
    shape = (512, 512)
    joint, tone = bricks(shape, 14, 8, 1.6, 51)
    y = np.mgrid[0:512, 0:512][0] * 14.0 / 512.0
    grey = 0.13 + 0.025 * tone + 0.01 * spectral(shape, 1.2, 52) + 0.02 * (y - np.floor(y))
    image = grey_to_rgb(grey, (0.92, 0.98, 1.10))
    return blend(image, np.full(3, 0.04), 0.7 * joint)
