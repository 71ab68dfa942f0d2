"""Tileable procedural noise on square or rectangular grids (arrays are indexed [row, column])."""

import numpy as np


def spectral(shape, beta, seed, stretch=1.0):
    """Periodic noise with an amplitude spectrum of 1/f^beta, mean 0 and standard deviation 1.

    ``stretch`` above 1 draws the pattern out vertically, below 1 horizontally.
    """
    rng = np.random.default_rng(seed)
    spectrum = np.fft.rfft2(rng.standard_normal(shape))
    fy = np.fft.fftfreq(shape[0])[:, None] * shape[0]
    fx = np.fft.rfftfreq(shape[1])[None, :] * shape[1]
    frequency = np.hypot(fy * stretch, fx)
    frequency[0, 0] = 1.0
    spectrum /= frequency**beta
    spectrum[0, 0] = 0.0
    field = np.fft.irfft2(spectrum, s=shape)
    return field / field.std()


def streaks(shape, seed, stretch=12.0):
    """Periodic noise drawn out vertically, like the stains that rain leaves."""
    return spectral(shape, 1.4, seed, stretch)


def smoothstep(low, high, value):
    """Hermite step from 0 at ``low`` to 1 at ``high``."""
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def threshold_band(field, width):
    """Thin lines where ``field`` crosses zero: 1 on the line, 0 farther than ``width`` from it."""
    return 1.0 - smoothstep(0.0, width, np.abs(field))


def bricks(shape, rows, columns, joint_px, seed, stagger=0.5):
    """Running-bond masonry that tiles.

    Returns ``(joint, tone)``: 1 inside the joints, and a random number in [-1, 1] constant per block.
    """
    rng = np.random.default_rng(seed)
    height, width = shape
    y, x = np.mgrid[0:height, 0:width].astype(float)
    row = np.floor(y * rows / height).astype(int)
    shifted = (x * columns / width + stagger * (row % 2)) % columns
    column = np.floor(shifted).astype(int)
    in_row = y * rows / height - row
    in_column = shifted - column
    edge_y = np.minimum(in_row, 1.0 - in_row) * height / rows
    edge_x = np.minimum(in_column, 1.0 - in_column) * width / columns
    joint = 1.0 - smoothstep(joint_px * 0.5, joint_px * 1.5, np.minimum(edge_x, edge_y))
    return joint, rng.uniform(-1.0, 1.0, (rows, columns))[row, column]


def grey_to_rgb(grey, colour):
    """Scale a (rows, columns) field by a linear RGB triple."""
    return grey[..., None] * np.asarray(colour, float)


def blend(base, other, weight):
    """Mix two (rows, columns, 3) images by a (rows, columns) weight in 0..1."""
    return base + (np.asarray(other, float) - base) * np.asarray(weight)[..., None]
