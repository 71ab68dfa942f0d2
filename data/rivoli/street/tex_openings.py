"""Windows, shop windows, fascias and doors as linear reflectance images (rows, columns, 3)."""

import numpy as np
from PIL import Image, ImageDraw

from .lettering import draw_text
from .noise import blend, grey_to_rgb, smoothstep, spectral

WINDOW_COLUMNS, WINDOW_ROWS = 4, 2
SHOP_COLUMNS, SHOP_ROWS = 4, 2
SIGN_COLUMNS, SIGN_ROWS = 2, 4
# in the order of the displays: clothes, books, bar, jewels, twice over
SIGN_TEXTS = ["MODE", "LIBRAIRIE", "CAFE RIVOLI", "BIJOUX", "COUTURE", "PAPETERIE", "BRASSERIE", "PHARMACIE"]


def _folds(height, width, seed):
    """Vertical folds of a hanging cloth, about 0.6..1.1."""
    x = np.linspace(0.0, 1.0, width)
    rng = np.random.default_rng(seed)
    wave = sum(np.sin(2 * np.pi * (x * f + rng.random())) / f**0.4 for f in (5, 9, 14))
    return np.tile(0.85 + 0.12 * wave, (height, 1))


def _room(variant, lit, seed):
    """One 512 x 256 window: room behind, side curtains or a net, per variant."""
    height, width = 512, 256
    y, x = np.mgrid[0:height, 0:width] / np.array([height, width])[:, None, None]
    rng = np.random.default_rng(seed)
    if lit:
        glow = np.exp(-((x - rng.uniform(0.3, 0.7)) ** 2 / 0.18 + (y - rng.uniform(0.15, 0.35)) ** 2 / 0.22))
        grey = 0.16 + 0.42 * glow + 0.10 * (1 - y)
    else:
        grey = 0.018 + 0.05 * np.clip(0.6 - y, 0, 1) + 0.012 * spectral((height, width), 1.8, seed)
        grey += 0.035 * smoothstep(-0.06, 0.06, x * 0.7 + y * 0.5 - rng.uniform(0.4, 0.8))
    room = grey_to_rgb(grey, (1.0, 0.93, 0.82) if lit else (0.85, 0.95, 1.1))
    if lit:
        picture = (np.abs(x - rng.uniform(0.35, 0.65)) < 0.13) & (np.abs(y - 0.38) < 0.07)
        room = blend(room, np.array([0.10, 0.07, 0.05]), 0.75 * picture)
        sill = y > rng.uniform(0.70, 0.85)
        room = blend(room, np.array([0.07, 0.05, 0.04]), 0.7 * sill)
    opening = (0.30, 0.22, 0.10, 0.42, 0.26, 0.34, 0.0, 0.38)[variant]
    cloth_tone = (0.42, 0.30, 0.48, 0.20, 0.45, 0.36, 0.46, 0.40)[variant]
    cloth = grey_to_rgb(cloth_tone * (0.62 if lit else 0.75) * _folds(height, width, seed + 1), (1.0, 0.93, 0.80))
    drawn = opening * (0.75 + 0.25 * np.cos(np.pi * np.clip(y - 0.15, 0, 1)))
    curtain = 1.0 - smoothstep(drawn - 0.02, drawn, np.abs(x - 0.5) + 0.0 * y)
    room = blend(room, cloth, (1.0 - curtain) * (0.95 if lit else 0.85))
    if variant in (1, 4, 6):
        net = grey_to_rgb(0.5 * _folds(height, width, seed + 2), (1.0, 0.98, 0.94))
        room = blend(room, net * (0.7 if lit else 0.55), 0.45 * (y > (0.45 if variant == 4 else 0.0)))
    if variant == 3:
        slats = 0.34 * (0.7 + 0.3 * (np.sin(y * 190.0) > 0))
        room = blend(room, grey_to_rgb(slats, (1.0, 0.97, 0.9)), 0.9 * (y < 0.42))
    return np.clip(room, 0.004, 0.6)


def _window_atlas(lit, tint, seed):
    rows = []
    for r in range(WINDOW_ROWS):
        cells = [
            _room(r * WINDOW_COLUMNS + c, lit, seed + 10 * (r * WINDOW_COLUMNS + c)) for c in range(WINDOW_COLUMNS)
        ]
        rows.append(np.concatenate(cells, axis=1))
    return np.concatenate(rows, axis=0) * np.asarray(tint)


def window_glass():
    """Eight unlit windows by day."""
    return _window_atlas(False, (1.0, 1.0, 1.0), 201)


def window_lit_warm():
    """Eight windows with an incandescent interior."""
    return _window_atlas(True, (1.0, 0.93, 0.82), 301)


def window_lit_cool():
    """Eight windows with a fluorescent interior."""
    return _window_atlas(True, (0.93, 1.0, 1.0), 401)


def _goods(pen, kind, rng, ox, oy):
    """Draw one shop window's display into the 512 px cell at (ox, oy); colours are stored values."""

    def colour(low=40, high=210):
        return tuple(int(v) for v in rng.integers(low, high, 3))

    if kind in (0, 4):  # clothes on stands
        for k in range(3):
            cx, top = ox + 100 + 155 * k, oy + 130 + int(rng.integers(0, 30))
            cloth = colour(30, 200)
            pen.ellipse([cx - 22, top - 52, cx + 22, top + 2], fill=(150, 130, 110))
            pen.polygon(
                [
                    (cx - 50, top + 15),
                    (cx + 50, top + 15),
                    (cx + 34, top + 130),
                    (cx + 62, top + 270),
                    (cx - 62, top + 270),
                    (cx - 34, top + 130),
                ],
                fill=cloth,
            )
            pen.line([cx, top + 270, cx, oy + 490], fill=(60, 55, 50), width=7)
    elif kind in (1, 5):  # shelves of books or boxes
        for shelf in range(4):
            base = oy + 130 + shelf * 110
            x = ox + 22
            while x < ox + 475:
                w, h = int(rng.integers(9, 26)), int(rng.integers(48, 88))
                pen.rectangle([x, base - h, x + w - 2, base], fill=colour())
                x += w
            pen.rectangle([ox + 12, base, ox + 500, base + 9], fill=(95, 72, 50))
    elif kind in (2, 6):  # tables and bar with bottles
        for x in range(ox + 30, ox + 490, 22):
            h = int(rng.integers(40, 66))
            pen.rectangle([x, oy + 190 - h, x + 11, oy + 190], fill=colour(30, 170))
            pen.rectangle([x + 3, oy + 176 - h, x + 8, oy + 190 - h], fill=(70, 80, 50))
        pen.rectangle([ox + 12, oy + 190, ox + 500, oy + 202], fill=(110, 78, 50))
        pen.rectangle([ox + 12, oy + 320, ox + 500, oy + 500], fill=(62, 40, 28))
        for cx in (ox + 130, ox + 370):
            pen.ellipse([cx - 80, oy + 352, cx + 80, oy + 384], fill=(150, 120, 90))
            pen.rectangle([cx - 6, oy + 380, cx + 6, oy + 495], fill=(30, 28, 26))
        for cx in (ox + 100, ox + 256, ox + 412):
            pen.ellipse([cx - 20, oy + 52, cx + 20, oy + 84], fill=(255, 240, 205))
    else:  # small precious things on steps
        for step in range(3):
            top = oy + 250 + step * 80
            pen.rectangle([ox + 40, top, ox + 472, top + 80], fill=(150 - 25 * step, 135 - 25 * step, 118 - 25 * step))
            for cx in range(ox + 70, ox + 460, 48):
                r = int(rng.integers(7, 17))
                pen.ellipse([cx - r, top - 2 * r, cx + r, top], fill=colour(70, 240))
        pen.rectangle([ox + 176, oy + 70, ox + 336, oy + 190], fill=(96, 60, 50))
        pen.rectangle([ox + 188, oy + 82, ox + 324, oy + 178], fill=colour(80, 200))


def shop_window():
    """Eight displays of 512 px: the lit interior, goods, door-high glass."""
    image = Image.new("RGB", (512 * SHOP_COLUMNS, 512 * SHOP_ROWS))
    pen = ImageDraw.Draw(image)
    rng = np.random.default_rng(501)
    for cell in range(SHOP_COLUMNS * SHOP_ROWS):
        ox, oy = 512 * (cell % SHOP_COLUMNS), 512 * (cell // SHOP_COLUMNS)
        tone = np.array([[196, 178, 150], [178, 182, 182], [190, 158, 116], [204, 196, 184]][cell % 4])
        for row in range(512):
            level = 0.62 + 0.38 * np.exp(-(((row - 110) / 190.0) ** 2))
            pen.line([ox, oy + row, ox + 511, oy + row], fill=tuple(int(v) for v in tone * level))
        _goods(pen, cell, rng, ox, oy)
        for lamp in range(4):
            cx = ox + 64 + 128 * lamp
            pen.ellipse([cx - 9, oy + 12, cx + 9, oy + 26], fill=(255, 248, 226))
    pixels = (np.asarray(image, float) / 255.0) ** 2.2
    shade = 1.0 + 0.06 * spectral(pixels.shape[:2], 1.6, 502)
    return np.clip(pixels * shade[..., None] * 0.8, 0.0, 0.7)


def shop_sign():
    """Eight fascias of 512 x 128: light letters on dark paint."""
    image = Image.new("RGB", (512 * SIGN_COLUMNS, 128 * SIGN_ROWS))
    pen = ImageDraw.Draw(image)
    grounds = [
        (60, 20, 22),
        (22, 50, 40),
        (90, 22, 24),
        (14, 70, 46),
        (26, 28, 40),
        (34, 34, 34),
        (66, 42, 26),
        (22, 30, 66),
    ]
    inks = [
        (236, 206, 140),
        (230, 222, 196),
        (240, 232, 220),
        (232, 240, 232),
        (220, 190, 120),
        (232, 230, 226),
        (238, 214, 170),
        (236, 214, 150),
    ]
    for cell, text in enumerate(SIGN_TEXTS):
        ox, oy = 512 * (cell % SIGN_COLUMNS), 128 * (cell // SIGN_COLUMNS)
        pen.rectangle([ox, oy, ox + 511, oy + 127], fill=grounds[cell])
        pen.rectangle([ox + 8, oy + 10, ox + 503, oy + 117], outline=inks[cell], width=2)
        draw_text(image, text, (ox + 256, oy + 64), min(60, 470 / (len(text) * 0.92)), inks[cell])
    return (np.asarray(image, float) / 255.0) ** 2.2


def door():
    """A carriage door of 256 x 512: two leaves, three panels each, brass knobs."""
    height, width = 512, 256
    grey = 0.055 + 0.004 * spectral((height, width), 1.2, 601)
    image = Image.new("L", (width, height), 0)
    pen = ImageDraw.Draw(image)
    for x0 in (14, 138):
        for y0, y1 in ((20, 150), (170, 330), (350, 490)):
            pen.rectangle([x0, y0, x0 + 104, y1], fill=70)
            pen.rectangle([x0 + 6, y0 + 6, x0 + 104, y1], fill=150)
            pen.rectangle([x0 + 6, y0 + 6, x0 + 98, y1 - 6], fill=110)
    pen.rectangle([126, 0, 129, 511], fill=20)
    relief = 0.7 + np.asarray(image, float) / 160.0
    colour = grey_to_rgb(grey * relief, (0.75, 1.0, 0.95))
    colour[255:268, 112:122] = colour[255:268, 134:144] = (0.45, 0.33, 0.12)
    return colour
