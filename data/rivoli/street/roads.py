"""The street's lanes as OpenDRIVE 1.7: x is X, y is -Z, the road runs in driving direction from the near end."""

from .layout import FACADE_X, JUNCTIONS, KERB_X, LANE, PAVEMENT_Y, SIDE_PAVEMENT, Z_FAR, Z_NEAR

SPEED = 50  # km/h


def roads():
    """The text of the file: one road, its sections apart where side streets open the kerbs."""
    mouths = [(Z_NEAR - near + SIDE_PAVEMENT, Z_NEAR - far - SIDE_PAVEMENT) for near, far in JUNCTIONS]
    starts = [0.0] + [s for mouth in mouths for s in mouth]
    sections = "".join(_section(s, k, len(starts), open_kerb=k % 2 == 1) for k, s in enumerate(starts))
    length = Z_NEAR - Z_FAR
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<OpenDRIVE>
  <header revMajor="1" revMinor="7" name="Rivoli" version="1.0" north="{-Z_FAR:g}" south="{-Z_NEAR:g}" east="{FACADE_X:g}" west="{-FACADE_X:g}"/>
  <road name="Rivoli" length="{length:g}" id="0" junction="-1" rule="RHT">
    <type s="0" type="town"><speed max="{SPEED}" unit="km/h"/></type>
    <planView>
      <geometry s="0" x="0" y="{-Z_NEAR:g}" hdg="1.5707963267948966" length="{length:g}"><line/></geometry>
    </planView>
    <lanes>
{sections}    </lanes>
  </road>
</OpenDRIVE>
"""


def _section(s, index, count, open_kerb):
    """Lanes from the left to the right; a mouth of a side street where the kerb is open."""

    def link(lane):
        before = f'<predecessor id="{lane}"/>' if index > 0 else ""
        after = f'<successor id="{lane}"/>' if index + 1 < count else ""
        return f"<link>{before}{after}</link>"

    def lane(number, kind, width, rest=""):
        return f'          <lane id="{number}" type="{kind}" level="false">{link(number)}<width sOffset="0" a="{width:.6g}" b="0" c="0" d="0"/>{rest}</lane>\n'

    def side(sign):
        dashes = '<line length="3" space="7" tOffset="0" sOffset="3.5" width="0.12"/>'
        mark = f'<roadMark sOffset="0" type="broken" color="white" width="0.12"><type name="broken" width="0.12">{dashes}</type></roadMark>'
        height = f'<height sOffset="0" inner="{PAVEMENT_Y:g}" outer="{PAVEMENT_Y:g}"/>'
        return [
            lane(sign, "driving", LANE, mark),
            lane(2 * sign, "driving", LANE),
            lane(3 * sign, "parking", KERB_X - 2 * LANE),
            lane(4 * sign, "border" if open_kerb else "sidewalk", FACADE_X - KERB_X, "" if open_kerb else height),
        ]

    lines = "".join(f'<line length="0" space="0" tOffset="{t}" sOffset="0" width="0.12"/>' for t in (0.13, -0.13))
    centre = f'<roadMark sOffset="0" type="solid solid" color="white" width="0.12"><type name="solid solid" width="0.12">{lines}</type></roadMark>'
    return f"""      <laneSection s="{s:g}">
        <left>
{"".join(side(1)[::-1])}        </left>
        <center>
          <lane id="0" type="none" level="false">{centre}</lane>
        </center>
        <right>
{"".join(side(-1))}        </right>
      </laneSection>
"""
