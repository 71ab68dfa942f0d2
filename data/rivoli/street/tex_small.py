"""Ironwork, plants, signs, plates, wheels and clothing as linear reflectance images, some with alpha."""

import numpy as np
from PIL import Image, ImageDraw

from .lettering import draw_text
from .noise import blend, grey_to_rgb, smoothstep, spectral, streaks

CLOTH_CELLS = 8
SIGN_CELLS = {
    "no_entry": 0,
    "no_parking": 1,
    "crossing": 2,
    "priority": 3,
    "one_way": 4,
    "street_name": 5,
    "parking": 6,
    "speed": 7,
}
PLATE_COUNT = 8


def _decode(image):
    return (np.asarray(image, float) / 255.0) ** 2.2


def _with_alpha(colour, alpha):
    return np.concatenate([colour, alpha[..., None]], axis=2)


def railing():
    """A wrought-iron balcony panel, 1 m square tile: two rails, balusters and rings; alpha cut-out."""
    mask = Image.new("L", (512, 512), 0)
    pen = ImageDraw.Draw(mask)
    for y, t in ((14, 26), (96, 12), (410, 12), (488, 20)):
        pen.rectangle([0, y - t // 2, 511, y + t // 2], fill=255)
    for x in range(32, 512, 64):
        pen.rectangle([x - 8, 0, x + 8, 511], fill=255)
    for x in range(0, 513, 64):
        pen.ellipse([x - 24, 30, x + 24, 86], outline=255, width=12)
        pen.ellipse([x - 24, 424, x + 24, 476], outline=255, width=12)
        for s in (-1, 1):
            pen.arc([x - 26 + s * 13, 190, x + s * 13 + 26, 320], 0, 360, fill=255, width=12)
    alpha = np.asarray(mask.resize((256, 256), Image.BOX), float) / 255.0
    colour = grey_to_rgb(0.035 + 0.003 * spectral((256, 256), 0.8, 701), (0.95, 1.0, 1.0))
    return _with_alpha(colour, alpha)


def garden_railing():
    """The garden's spear railing, 2 m square tile; gilded points; alpha cut-out."""
    mask = Image.new("L", (1024, 1024), 0)
    gold = Image.new("L", (1024, 1024), 0)
    pen, gild = ImageDraw.Draw(mask), ImageDraw.Draw(gold)
    for y, t in ((150, 22), (210, 14), (900, 26)):
        pen.rectangle([0, y - t // 2, 1023, y + t // 2], fill=255)
    for x in range(32, 1024, 64):
        pen.rectangle([x - 12, 92, x + 12, 1023], fill=255)
        for layer in (pen, gild):
            layer.polygon([(x, 14), (x + 17, 64), (x + 8, 100), (x - 8, 100), (x - 17, 64)], fill=255)
    for x in range(0, 1025, 64):
        pen.ellipse([x - 22, 158, x + 22, 202], outline=255, width=8)
    size = (512, 512)
    alpha = np.asarray(mask.resize(size, Image.BOX), float) / 255.0
    tip = np.asarray(gold.resize(size, Image.BOX), float) / 255.0
    colour = grey_to_rgb(0.035 + 0.003 * spectral(size, 0.8, 702), (0.9, 1.0, 0.95))
    return _with_alpha(blend(colour, np.array([0.38, 0.28, 0.09]), tip), alpha)


def bark():
    """Plane-tree bark: grey-olive with pale flakes."""
    shape = (512, 256)
    grey = 0.13 + 0.03 * streaks(shape, 711, 0.35) + 0.015 * spectral(shape, 0.8, 712)
    image = grey_to_rgb(grey, (1.0, 0.95, 0.78))
    flakes = smoothstep(0.7, 1.0, spectral(shape, 1.5, 713))
    return np.clip(blend(image, np.array([0.30, 0.28, 0.20]), 0.7 * flakes), 0.03, 0.5)


def foliage():
    """A cluster of leaves with alpha, drawn darker deep inside and lighter at the rim."""
    size = 512
    image = Image.new("RGB", (2 * size, 2 * size), (62, 78, 34))
    mask = Image.new("L", (2 * size, 2 * size), 0)
    pen, cut = ImageDraw.Draw(image), ImageDraw.Draw(mask)
    rng = np.random.default_rng(721)
    for k in range(620):
        radius = 455.0 * np.sqrt(rng.random())
        bearing = rng.uniform(0, 2 * np.pi)
        cx, cy = size + radius * np.cos(bearing), size + radius * np.sin(bearing)
        length, turn = rng.uniform(30, 52), rng.uniform(0, 2 * np.pi)
        along = np.array([np.cos(turn), np.sin(turn)]) * length
        across = np.array([-np.sin(turn), np.cos(turn)]) * length * rng.uniform(0.36, 0.6)
        outline = [(-1.0, 0.0), (-0.45, 0.75), (0.25, 0.6), (1.0, 0.0), (0.25, -0.6), (-0.45, -0.75)]
        points = [(cx + along[0] * a + across[0] * b, cy + along[1] * a + across[1] * b) for a, b in outline]
        tone = rng.uniform(0.7, 1.1) * (0.75 + 0.35 * k / 620.0)
        pen.polygon(points, fill=tuple(int(v * tone) for v in (86, 108, 44)))
        pen.line([points[0], points[3]], fill=tuple(int(v * tone) for v in (104, 122, 60)), width=3)
        cut.polygon(points, fill=255)
    colour = _decode(image.resize((size, size), Image.BOX))
    return _with_alpha(colour, np.asarray(mask.resize((size, size), Image.BOX), float) / 255.0)


def hedge():
    """Clipped leaves, also used for lawn."""
    shape = (512, 512)
    grey = 0.075 + 0.028 * spectral(shape, 0.35, 731) + 0.012 * spectral(shape, 1.4, 732)
    return np.clip(grey_to_rgb(grey, (0.80, 1.0, 0.38)), 0.012, 0.3)


def painted_wood():
    """Gloss paint over boards; tinted by the material's base colour factor."""
    shape = (256, 256)
    grey = 0.92 + 0.02 * streaks(shape, 741, 8.0)
    x = np.mgrid[0:256, 0:256][1] % 64
    return grey_to_rgb(np.where(x < 2, grey * 0.5, grey), (1.0, 1.0, 1.0))


def awning():
    """Striped canvas."""
    x = np.mgrid[0:256, 0:256][1] // 32
    grey = 1.0 + 0.03 * spectral((256, 256), 0.8, 751)
    stripe = np.where((x % 2 == 0)[..., None], np.array([0.48, 0.44, 0.36]), np.array([0.26, 0.05, 0.04]))
    return stripe * grey[..., None]


def road_signs():
    """Eight 256 px cells, 4 x 2: the faces of the traffic signs, the street-name plate, grey backs."""
    image = Image.new("RGB", (1024, 512), (120, 122, 124))
    pen = ImageDraw.Draw(image)

    def cell(name):
        index = SIGN_CELLS[name]
        return 256 * (index % 4), 256 * (index // 4)

    x, y = cell("no_entry")
    pen.ellipse([x + 4, y + 4, x + 252, y + 252], fill=(206, 206, 204))
    pen.ellipse([x + 12, y + 12, x + 244, y + 244], fill=(170, 28, 30))
    pen.rectangle([x + 48, y + 106, x + 208, y + 150], fill=(206, 206, 204))
    x, y = cell("no_parking")
    pen.ellipse([x + 4, y + 4, x + 252, y + 252], fill=(170, 28, 30))
    pen.ellipse([x + 36, y + 36, x + 220, y + 220], fill=(34, 62, 140))
    pen.line([x + 60, y + 60, x + 196, y + 196], fill=(170, 28, 30), width=30)
    x, y = cell("crossing")
    pen.rectangle([x, y, x + 256, y + 256], fill=(34, 66, 146))
    pen.polygon([(x + 128, y + 24), (x + 236, y + 224), (x + 20, y + 224)], fill=(206, 206, 204))
    pen.ellipse([x + 116, y + 74, x + 142, y + 100], fill=(22, 22, 22))
    pen.line([x + 128, y + 100, x + 126, y + 150, x + 100, y + 205], fill=(22, 22, 22), width=14)
    pen.line([x + 126, y + 150, x + 158, y + 205], fill=(22, 22, 22), width=14)
    pen.line([x + 100, y + 130, x + 156, y + 126], fill=(22, 22, 22), width=10)
    x, y = cell("priority")
    pen.polygon([(x + 128, y + 4), (x + 252, y + 128), (x + 128, y + 252), (x + 4, y + 128)], fill=(206, 206, 204))
    pen.polygon([(x + 128, y + 44), (x + 212, y + 128), (x + 128, y + 212), (x + 44, y + 128)], fill=(204, 150, 24))
    x, y = cell("one_way")
    pen.rectangle([x, y, x + 256, y + 256], fill=(34, 66, 146))
    pen.polygon(
        [
            (x + 128, y + 24),
            (x + 200, y + 110),
            (x + 152, y + 110),
            (x + 152, y + 230),
            (x + 104, y + 230),
            (x + 104, y + 110),
            (x + 56, y + 110),
        ],
        fill=(206, 206, 204),
    )
    x, y = cell("street_name")
    pen.rectangle([x, y, x + 256, y + 256], fill=(24, 58, 44))
    pen.rectangle([x + 10, y + 10, x + 246, y + 246], fill=(26, 46, 112))
    draw_text(image, "RUE DE", (x + 128, y + 88), 34, (206, 206, 204))
    draw_text(image, "RIVOLI", (x + 128, y + 160), 38, (206, 206, 204))
    x, y = cell("parking")
    pen.rectangle([x, y, x + 256, y + 256], fill=(34, 66, 146))
    draw_text(image, "P", (x + 140, y + 128), 150, (206, 206, 204))
    x, y = cell("speed")
    pen.ellipse([x + 4, y + 4, x + 252, y + 252], fill=(170, 28, 30))
    pen.ellipse([x + 40, y + 40, x + 216, y + 216], fill=(206, 206, 204))
    draw_text(image, "50", (x + 132, y + 128), 86, (20, 20, 20))
    return _decode(image.resize((512, 256), Image.BOX))


def plates():
    """Eight French number plates of 512 x 64 drawn, stored as 256 x 256 in one column."""
    image = Image.new("RGB", (512, 64 * PLATE_COUNT))
    pen = ImageDraw.Draw(image)
    rng = np.random.default_rng(761)
    letters = "ABCDEFGHJKLMNPQRSTVWXYZ"
    for k in range(PLATE_COUNT):
        pick = [letters[i] for i in rng.integers(0, len(letters), 4)]
        text = f"{pick[0]}{pick[1]}-{rng.integers(100, 999)}-{pick[2]}{pick[3]}"
        pen.rectangle([0, 64 * k, 511, 64 * k + 63], fill=(206, 206, 200))
        pen.rectangle([0, 64 * k, 40, 64 * k + 63], fill=(24, 50, 140))
        pen.rectangle([471, 64 * k, 511, 64 * k + 63], fill=(24, 50, 140))
        draw_text(image, text, (258, 64 * k + 32), 44, (16, 16, 16), 0.14)
    return _decode(image.resize((256, 256), Image.BOX))


def car_panels():
    """Side view of a car body as a factor on its paint: door gaps, handles, rocker; the lowest quarter is plain."""
    image = Image.new("L", (1024, 512), 255)
    pen = ImageDraw.Draw(image)
    bottom = 384
    for row in range(250, bottom):
        pen.line([0, row, 1023, row], fill=255 - int(70 * ((row - 250) / (bottom - 250)) ** 2))
    for points in (
        [(300, 0), (296, 130), (306, 330), (505, 338), (512, 130), (512, 0)],
        [(512, 130), (518, 338), (640, 336), (688, 250), (752, 150), (758, 0)],
    ):
        pen.line(points, fill=60, width=4, joint="curve")
    pen.line([(60, 128), (960, 122)], fill=225, width=4)
    pen.rectangle([0, 238, 1023, 245], fill=95)
    for x in (452, 690):
        pen.rounded_rectangle([x, 140, x + 44, 152], 5, fill=60)
    pen.rectangle([850, 120, 884, 160], outline=150, width=3)
    value = np.asarray(image.resize((512, 256), Image.BOX), float) / 255.0
    return grey_to_rgb(value, (1.0, 1.0, 1.0))


def wheel():
    """A wheel seen from the side: tyre, alloy spokes, nuts."""
    y, x = (np.mgrid[0:256, 0:256] - 127.5) / 127.5
    radius, bearing = np.hypot(x, y), np.arctan2(y, x)
    spokes = np.cos(5 * bearing) > -0.25
    grey = np.where(radius < 0.64, np.where(spokes | (radius < 0.2), 0.30, 0.02), 0.035)
    grey = np.where(np.abs(radius - 0.63) < 0.04, 0.34, grey)
    grey = np.where(radius < 0.08, 0.08, grey)
    return grey_to_rgb(grey, (1.0, 1.0, 1.02))


def clothing():
    """An 8 x 8 atlas of fabrics; rows of swatches: coats, trousers, skirts, shirts, skins, hairs, shoes, bags."""
    colours = [
        [
            (0.10, 0.09, 0.08),
            (0.05, 0.06, 0.10),
            (0.22, 0.16, 0.10),
            (0.28, 0.05, 0.05),
            (0.12, 0.15, 0.10),
            (0.30, 0.27, 0.22),
            (0.06, 0.06, 0.06),
            (0.09, 0.14, 0.24),
        ],
        [
            (0.06, 0.08, 0.14),
            (0.05, 0.05, 0.055),
            (0.12, 0.11, 0.10),
            (0.20, 0.17, 0.12),
            (0.08, 0.10, 0.18),
            (0.10, 0.10, 0.11),
            (0.16, 0.15, 0.14),
            (0.05, 0.06, 0.09),
        ],
        [
            (0.24, 0.06, 0.09),
            (0.06, 0.06, 0.07),
            (0.28, 0.24, 0.18),
            (0.10, 0.18, 0.22),
            (0.30, 0.20, 0.10),
            (0.12, 0.08, 0.14),
            (0.08, 0.13, 0.09),
            (0.20, 0.20, 0.21),
        ],
        [
            (0.40, 0.39, 0.37),
            (0.20, 0.26, 0.36),
            (0.34, 0.12, 0.10),
            (0.36, 0.32, 0.20),
            (0.12, 0.24, 0.18),
            (0.07, 0.07, 0.08),
            (0.38, 0.28, 0.26),
            (0.15, 0.16, 0.20),
        ],
        [
            (0.38, 0.24, 0.17),
            (0.44, 0.29, 0.21),
            (0.28, 0.16, 0.10),
            (0.10, 0.055, 0.035),
            (0.34, 0.21, 0.14),
            (0.18, 0.10, 0.06),
            (0.42, 0.27, 0.20),
            (0.30, 0.18, 0.12),
        ],
        [
            (0.03, 0.02, 0.015),
            (0.10, 0.06, 0.03),
            (0.24, 0.17, 0.08),
            (0.20, 0.19, 0.18),
            (0.05, 0.035, 0.025),
            (0.14, 0.06, 0.03),
            (0.30, 0.29, 0.28),
            (0.02, 0.02, 0.02),
        ],
        [
            (0.03, 0.025, 0.02),
            (0.09, 0.05, 0.03),
            (0.36, 0.35, 0.33),
            (0.05, 0.05, 0.06),
            (0.03, 0.03, 0.03),
            (0.14, 0.08, 0.04),
            (0.02, 0.02, 0.025),
            (0.20, 0.19, 0.18),
        ],
        [
            (0.12, 0.06, 0.03),
            (0.04, 0.04, 0.04),
            (0.26, 0.10, 0.05),
            (0.10, 0.12, 0.20),
            (0.30, 0.26, 0.18),
            (0.05, 0.09, 0.07),
            (0.20, 0.05, 0.05),
            (0.08, 0.08, 0.09),
        ],
    ]
    cell = 512 // CLOTH_CELLS
    base = np.kron(np.asarray(colours), np.ones((cell, cell, 1)))
    y, x = np.mgrid[0:512, 0:512]
    weave = 1.0 + 0.10 * spectral((512, 512), 0.9, 771) + 0.05 * np.where((x + y) % 4 < 2, 1.0, -1.0)
    check = np.where((y // cell == 3) & (x // cell % 3 == 1) & ((x // 8 + y // 8) % 2 == 0), 0.7, 1.0)
    plain = y // cell == 4
    return np.clip(base * np.where(plain, 1.0, weave * check)[..., None], 0.012, 0.5)
