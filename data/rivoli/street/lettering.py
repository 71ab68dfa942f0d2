"""A small stroke alphabet, so that signs need no font file. Glyph cells are 4 wide and 6 high."""

from PIL import ImageDraw

_STROKES = {
    "A": "06 20 46/14 34",
    "B": "00 06 36 45 44 33 03/33 42 41 30 00",
    "C": "41 30 10 01 05 16 36 45",
    "D": "00 06 26 44 42 20 00",
    "E": "40 00 06 46/03 33",
    "F": "40 00 06/03 33",
    "G": "41 30 10 01 05 16 36 45 43 23",
    "H": "00 06/40 46/03 43",
    "I": "20 26",
    "J": "40 45 36 16 05",
    "K": "00 06/40 03 46",
    "L": "00 06 46",
    "M": "06 00 23 40 46",
    "N": "06 00 46 40",
    "O": "10 01 05 16 36 45 41 30 10",
    "P": "06 00 30 41 42 33 03",
    "Q": "10 01 05 16 36 45 41 30 10/24 46",
    "R": "06 00 30 41 42 33 03/23 46",
    "S": "41 30 10 01 02 13 33 44 45 36 16 05",
    "T": "00 40/20 26",
    "U": "00 05 16 36 45 40",
    "V": "00 26 40",
    "W": "00 16 23 36 40",
    "X": "00 46/40 06",
    "Y": "00 23 40/23 26",
    "Z": "00 40 06 46",
    "0": "10 01 05 16 36 45 41 30 10",
    "1": "11 20 26",
    "2": "01 10 30 41 42 06 46",
    "3": "00 40 23 33 44 45 36 16 05",
    "4": "36 30 04 44",
    "5": "40 00 02 32 43 45 36 06",
    "6": "40 20 02 05 16 36 45 44 33 03",
    "7": "00 40 16",
    "8": "10 01 02 13 33 44 45 36 16 05 04 13/33 42 41 30 10",
    "9": "06 26 44 41 30 10 01 02 13 43",
    "-": "13 33",
    "'": "20 21",
    "&": "46 01 10 20 31 05 16 26 44",
    " ": "",
}


def text_width(text, height):
    """Width in pixels of ``text`` at a cap height in pixels."""
    return len(text) * height * 0.92 - height * 0.25


def draw_text(image, text, centre, height, fill, weight=0.16):
    """Draw ``text`` centred on ``centre`` (pixels) with a stroke of ``weight`` cap heights."""
    draw = ImageDraw.Draw(image)
    x0 = centre[0] - text_width(text, height) / 2.0
    y0 = centre[1] - height / 2.0
    thick = max(1, round(height * weight))
    for character in text:
        for stroke in filter(None, _STROKES[character].split("/")):
            points = [(x0 + int(p[0]) * height / 6.0, y0 + int(p[1]) * height / 6.0) for p in stroke.split()]
            draw.line(points, fill=fill, width=thick, joint="curve")
        x0 += height * 0.92
