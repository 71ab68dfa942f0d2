"""What the signs over the shops emit by night, in cd/m2 (rows, columns, 3): luminous letters, their glow on the board."""

import numpy as np
from PIL import Image

from .lettering import draw_text
from .tex_openings import SIGN_COLUMNS, SIGN_ROWS, SIGN_TEXTS

WIDTH, HEIGHT = 160, 40  # px of one sign
_FINER = 6  # letters are drawn so much larger
# Linear Rec. 709 and cd/m2 of the tubes, in the order of the texts: whites, neon, argon, the green of a pharmacy.
_TUBES = [
    ((1.0, 0.80, 0.55), 900),
    ((1.0, 0.86, 0.66), 700),
    ((1.0, 0.10, 0.02), 2200),
    ((1.0, 0.75, 0.40), 800),
    ((1.0, 0.94, 0.90), 1100),
    ((0.25, 0.55, 1.0), 1300),
    ((1.0, 0.22, 0.03), 1800),
    ((0.06, 1.0, 0.30), 1500),
]
_GLOW = 0.02  # of what a tube gives, on the board beside it
_STEPS, _LEAST_STEP = 32, 0.25  # per octave; cd/m2: what is finer only costs bytes


def neon_signs():
    """All signs, laid out as ``shop_sign`` is."""
    picture = np.zeros((HEIGHT * SIGN_ROWS, WIDTH * SIGN_COLUMNS, 3))
    for cell, (text, (colour, luminance)) in enumerate(zip(SIGN_TEXTS, _TUBES)):
        tubes = _letters(text)
        light = tubes + _GLOW * (4.0 * _blurred(tubes, 1.25) + 6.0 * _blurred(tubes, 3.75))
        colour = np.array(colour) / np.dot(colour, (0.2126, 0.7152, 0.0722))
        y, x = HEIGHT * (cell // SIGN_COLUMNS), WIDTH * (cell % SIGN_COLUMNS)
        picture[y : y + HEIGHT, x : x + WIDTH] = luminance * light[..., None] * colour
    step = np.maximum(2.0 ** np.floor(np.log2(np.maximum(picture, 1.0))) / _STEPS, _LEAST_STEP)
    return np.round(picture / step) * step


def _letters(text):
    """Share of every pixel that a tube covers."""
    image = Image.new("L", (WIDTH * _FINER, HEIGHT * _FINER))
    height = min(HEIGHT * 0.47, WIDTH * 0.92 / (len(text) * 0.92))
    draw_text(image, text, (WIDTH * _FINER / 2, HEIGHT * _FINER / 2), height * _FINER, 255, 0.1)
    fine = np.asarray(image, float).reshape(HEIGHT, _FINER, WIDTH, _FINER) / 255.0
    return fine.mean(axis=(1, 3))


def _blurred(image, sigma):
    """Gaussian of ``sigma`` pixels along both axes; nothing beyond the border."""
    reach = int(3 * sigma)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        image = np.apply_along_axis(np.convolve, axis, image, kernel, mode="same")
    return image
