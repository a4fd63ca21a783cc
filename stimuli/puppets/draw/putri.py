"""Putri, a princess of painted, oiled hide in the manner of Shaanxi and Kelantan: amber, vermilion and green that glow.

Run `python putri.py` (numpy, scipy, shapely) to write ../putri.svg and print the pivots.
"""

import math
from pathlib import Path

from shapely.geometry import Point

from leather import Leather, comma, dot, drop, line, lozenge, petal, plain, ribbon, sickle, through, ukel, write

SIZE = (1000, 1600)
DARK, AMBER, RED, GREEN, SKIN = "#241008", "#ffb43a", "#ea3d1e", "#2f9e54", "#ffd9a0"
RIM = 4.5
ROD = [4, 5, 6, 7, 8, 9, 10, 11, 22, 4]   # widths of a hand rod, from hand to handle


def along(points):
    return through(points, closed=False)


def hide(outline, fill, opacity=0.95, web=5.5):
    return Leather(outline, web=web, fill=fill, opacity=opacity, rim=RIM)


def inlay(over, under):
    """Lets the upper piece's holes go through the lower one too."""
    under.holes += over.holes
    under.polygons += over.polygons
    return over


def blossom(leather, x, y, r):
    """Five petals cut round a seed."""
    leather.fit(dot(), x, y, 0, r * 0.17)
    for i in range(5):
        a = 72 * i - 90
        leather.fit(drop(0.62), *polar(x, y, r * 0.68, a), a + 180, r * 0.36)


def polar(x, y, r, a):
    return x + r * math.cos(math.radians(a)), y + r * math.sin(math.radians(a))


def flower(x, y, r, petals, fill, heart, turn=0.0):
    """A rosette of overlapping petals about a pierced heart."""
    out = []
    for i in range(petals):
        a = turn + 360 * i / petals
        px, py = polar(x, y, r * 0.6, a)
        leaf = hide(through([(-0.9, 0), (-0.2, 0.6), (0.6, 0.5), (1, 0, 0), (0.6, -0.5), (-0.2, -0.6)]).at(px, py, a, r * 0.55), fill, web=4)
        qx, qy = polar(x, y, r * 0.78, a)
        leaf.fit(drop(0.5), qx, qy, a, r * 0.2)
        out.append(leaf)
    centre = hide(dot().at(x, y, 0, r * 0.3), heart)
    return out + [centre]


def head():
    at = dict(x=505, y=318, turn=6, scale=1.12)
    h = lambda c: c.at(**at)
    face = plain(h(through([(18, -86, 0), (60, -80), (82, -54), (84, -26, 0), (110, 2, 0), (94, 9, 0), (100, 20, 0), (91, 26, 0), (97, 34), (87, 43, 0), (88, 56), (66, 74), (30, 72),
                            (17, 84), (21, 106, 0), (-30, 106, 0), (-24, 60), (-24, -20), (-8, -70)])), SKIN, 0.72, RIM)
    lines = [line(h(along([(36, -44), (58, -56), (80, -46)])), 5), line(h(along([(40, -26), (62, -32), (84, -22)])), 6.5), line(h(along([(46, -22), (62, -20), (78, -22)])), 3),
             plain(h(through([(78, 22, 0), (88, 19), (99, 21, 0), (92, 26, 0), (96, 33), (86, 33)])), RED, 0.95), line(h(along([(96, 7), (86, 8), (84, 1)])), 3)]
    hair = Leather(h(through([(58, -84, 0), (44, -64), (26, -40), (24, 0), (36, 34), (22, 44, 0), (6, 22), (-8, 20), (-14, 52), (-50, 74), (-92, 56), (-112, 8), (-106, -42), (-69, -72), (-9, -94), (38, -87)])),
                   web=4, fill=DARK)
    for r, n in ((44, 9), (66, 12)):
        for i in range(n):
            x, y = polar(-34, -16, r, 60 + 210 * i / (n - 1))
            hair.fit(sickle(0.6), *xy(h, x, y), at["turn"] + 60 + 210 * i / (n - 1), 9, least=0.6)
    rosette(hair, *xy(h, -34, -16), 9, 30, 8)
    ear = [hide(h(dot().at(2, 30, 0, 9)), AMBER), hide(h(drop(0.6).at(3, 58, -90, 17)), GREEN), hide(h(dot().at(4, 82, 0, 7)), RED)]

    crown = []
    for i, a in enumerate((-168, -146, -124, -102, -80, -58)):                   # the fan, back to front
        r = 78 + 26 * math.sin(math.radians(180 * (i + 1) / 7.5))
        x, y = polar(-14, -72, r, a)
        leaf = hide(h(through([(-0.7, 0.42), (-0.2, 0.6), (0.5, 0.52), (1.1, 0, 0), (0.5, -0.52), (-0.2, -0.6), (-0.7, -0.42)]).at(x, y, a, 42)), (AMBER, GREEN)[i % 2])
        leaf.fit(drop(0.55), *xy(h, *polar(-14, -72, r + 10, a)), at["turn"] + a, 17)
        crown += [leaf, hide(h(dot().at(*polar(-14, -72, r + 55, a), 0, 11)), RED)]
    band = hide(h(ribbon([(-116, -44), (-78, -94), (-12, -119), (42, -107), (76, -82)], [30, 46, 52, 46, 26], n=13)), AMBER, web=4.5)
    band.clear_of(hair, *(c for c in crown if isinstance(c, Leather)), margin=0)
    mid = h(along([(-106, -56), (-77, -94), (-12, -119), (42, -107), (66, -92)]))
    for i, (p, a, s) in enumerate(mid.walk(31, 8, 8)):
        band.fit(ukel(), p.real, p.imag, a + 90, 17, flip=i % 2 == 0, least=0.5)
    phoenix = [hide(h(ribbon([(60, -92), (92, -112), (112, -146), (102, -176), (84, -170)], [22, 24, 20, 14, 3], n=11)), RED),
               hide(h(dot().at(118, -96, 0, 9)), AMBER), hide(h(dot().at(120, -74, 0, 7)), GREEN), hide(h(drop(0.6).at(121, -48, 90, 15)), RED)]
    phoenix.insert(0, line(h(along([(84, -106), (112, -116), (119, -96), (121, -50)])), 4))
    return [face, *lines, *ear, *crown, hair, *phoenix, band]


def xy(h, x, y):
    p = h(along([(x, y), (x + 1, y)])).segments[0][0]
    return p.real, p.imag


def rosette(leather, x, y, inner, outer, petals, fat=0.5):
    leather.fit(dot(), x, y, 0, inner * 0.6)
    for i in range(petals):
        a = 360 * i / petals
        leather.fit(drop(fat), *polar(x, y, (inner + outer) / 2, a), a + 180, (outer - inner) / 2)


def robe():
    """Skirt with its apron and hem, bodice with the cloud collar, girdle, and two streamers behind."""
    out = []
    for pts, fill, flip in (([(424, 716), (334, 762), (266, 860), (230, 970), (170, 1056), (104, 1084), (74, 1050), (96, 1026)], GREEN, False),
                            ([(424, 732), (354, 826), (308, 930), (270, 1040), (208, 1130), (144, 1160), (104, 1136), (120, 1108)], AMBER, True)):
        s = hide(ribbon(pts, [30, 46, 52, 50, 46, 36, 20, 4], n=19), fill, web=5)
        for i, (p, a, t) in enumerate(along(pts).walk(35, 60, 70)):
            s.fit(ukel(), p.real, p.imag, a, 17, flip=(i % 2 == 0) != flip, least=0.6)
        out.append(s)

    skirt = hide(through([(428, 700, 0), (392, 800), (360, 920), (318, 1060), (240, 1190), (150, 1262, 0), (300, 1290), (460, 1288), (620, 1282), (668, 1262, 0),
                          (660, 1120), (632, 960), (592, 820), (556, 700, 0)]), RED)
    hem = hide(through([(236, 1192, 0), (150, 1262, 0), (300, 1290), (460, 1288), (620, 1282), (668, 1262, 0), (668, 1196, 0), (600, 1216), (460, 1222), (320, 1214)]), AMBER)
    for i, (p, a, t) in enumerate(along([(226, 1236), (320, 1250), (460, 1255), (600, 1250), (654, 1238)]).walk(45, 14, 16)):
        hem.fit(ukel(), p.real, p.imag, a - 90 if i % 2 else a + 90, 22, flip=i % 2 == 0, least=0.6)
        hem.fit(dot(), p.real + 22, p.imag - 14 * (-1) ** i, 0, 4)
    apron = hide(through([(466, 730, 0), (448, 900), (426, 1040), (414, 1150), (450, 1190), (492, 1206, 0), (540, 1188), (580, 1150), (576, 1040), (556, 900), (530, 730, 0)]), GREEN)
    apron.row(along([(470, 752), (464, 900), (443, 1040), (432, 1144), (460, 1176), (492, 1190), (534, 1174), (562, 1144), (560, 1040), (540, 900), (520, 752)]), 15.5, dot(), 4.2)
    for k, (y, r) in enumerate(((1132, 26), (1072, 25), (1014, 24), (958, 22), (906, 20), (858, 18), (814, 16), (776, 14))):  # the vine that climbs the apron
        for flip in (False, True):
            m = 1 if flip else -1
            apron.fit(ukel(), 496 + m * (r + 7), y, 90, r, flip, least=0.6)
            apron.fit(drop(0.45), 496 + m * 13, y - r * 1.12, -90 + 18 * m, r * 0.36, least=0.5)
    inlay(apron, skirt)
    inlay(hem, skirt)
    skirt.clear_of(apron, hem)
    # scattered plum blossoms and fold lines
    for x, y, r in ((418, 846, 22), (386, 950, 26), (372, 1066, 28), (306, 1140, 26), (384, 1160, 26), (606, 1000, 24), (622, 1120, 26), (580, 870, 20)):
        blossom(skirt, x, y, r)
    for x, y, a in ((404, 900, 100), (354, 1010, 108), (342, 1104, 112), (394, 1010, 100), (390, 1112, 100), (340, 1180, 100), (596, 936, 80), (626, 1060, 80), (610, 1176, 80), (568, 820, 80), (430, 796, 100)):
        skirt.fit(petal(0.45), x, y, a, 16)
    folds = [line(along([(424, 760), (398, 920), (352, 1070), (286, 1190)]), 4), line(along([(560, 770), (608, 940), (640, 1080), (648, 1190)]), 4)]

    bodice = hide(through([(470, 426, 0), (426, 436), (392, 454), (398, 520), (420, 610), (428, 716, 0), (556, 716, 0), (566, 610), (584, 530), (598, 458), (566, 436), (526, 426, 0)]), RED)
    collar = []
    for a, r in ((152, 84), (121, 92), (90, 98), (59, 92), (28, 84)):            # the cloud collar, lobe by lobe
        x, y = polar(497, 436, r * 0.62, a)
        lobe = hide(through([(-0.8, 0.35), (-0.1, 0.6), (0.4, 0.78), (0.8, 0.5), (0.72, 0.22), (1.06, 0, 0), (0.72, -0.22), (0.8, -0.5), (0.4, -0.78), (-0.1, -0.6), (-0.8, -0.35)]).at(x, y, a, r * 0.52), AMBER)
        qx, qy = polar(497, 436, r * 0.78, a)
        lobe.fit(drop(0.5), qx, qy, a, 14)
        for s in (-1, 1):
            lobe.fit(comma(), *polar(qx, qy, 21, a + 100 * s), a, 11, flip=s > 0, least=0.5)
        collar.append(lobe)
    for lobe in collar:
        bodice.clear_of(lobe)
        bodice.holes += lobe.holes
    neck = hide(ribbon([(456, 430), (497, 446), (538, 430)], [30, 34, 30], n=7), GREEN, web=4)
    neck.row(along([(456, 430), (497, 446), (538, 430)]), 16, drop(0.6), 6.5, 90)
    for y in (566, 634):
        blossom(bodice, 494, y, 30)
    for x, y in ((446, 556), (542, 556), (446, 604), (544, 604), (450, 652), (540, 652)):
        bodice.fit(ukel(), x, y, 90, 19, flip=x < 490, least=0.5)
    for p in ((594, 476), (398, 476)):
        pierce(*p, bodice, *(c for c in collar if c.area.contains(Point(p))))
    girdle = hide(through([(420, 682), (492, 692), (566, 680), (572, 722), (492, 738), (414, 724)]), AMBER, web=4.5)
    girdle.row(along([(424, 703), (492, 715), (564, 701)]), 27, lozenge(0.75), 11)
    knot = flower(494, 712, 34, 6, GREEN, RED)
    ends = []
    for pts in ([(488, 738), (470, 840), (486, 940), (462, 1010)], [(500, 738), (520, 830), (508, 910), (532, 980)]):
        ends.append(plain(ribbon(pts, [10, 17, 19, 15], n=9), AMBER, 0.92, RIM))
    shoe = hide(through([(600, 1290, 0), (640, 1272), (678, 1268), (704, 1246), (716, 1262), (704, 1290), (670, 1302), (620, 1304)]), GREEN, web=4)
    shoe.fit(comma(), 682, 1284, -20, 11)
    rear_shoe = hide(through([(440, 1290, 0), (480, 1280), (530, 1284), (564, 1268), (570, 1290), (540, 1308), (470, 1310)]), GREEN, web=4)
    return [*out, shoe, rear_shoe, skirt, *folds, hem, apron, *ends, bodice, girdle, *knot, *collar, neck]


def button(x, y, r):
    """The dark patch on both sides of a joint: dark on dark hides the overlap, and the rivet's hole shows at every pose."""
    b = Leather(dot().at(x, y, 0, r), web=4, fill=DARK, opacity=1)
    b.cut(dot().at(x, y, 0, 6))
    return b


def pierce(x, y, *pieces):
    """Opens hides for a rivet."""
    for p in pieces:
        p.holes.append(dot().at(x, y, 0, 6))


def hand(x, y, turn, flip=False):
    h = lambda c: c.at(x, y, turn, 1.05, flip)
    return [plain(h(c), SKIN, 0.8, 3.5) for c in (
        through([(-16, -14), (4, -16), (26, -10), (32, 4), (22, 16), (0, 16), (-18, 12)]),
        ribbon([(20, -8), (46, -16), (66, -34)], [12, 10, 4], n=7), ribbon([(26, -2), (54, -4), (80, -14)], [12, 10, 4], n=7),
        ribbon([(26, 6), (52, 12), (76, 8)], [12, 10, 4], n=7), ribbon([(18, 12), (38, 26), (58, 30)], [12, 9, 4], n=7),
        ribbon([(0, -12), (16, -30), (32, -34)], [12, 9, 4], n=7))]


def sleeve(shoulder, elbow, wrist, droop, flip):
    """Upper arm, the wide forearm sleeve and its cuff."""
    sx, sy = shoulder
    ex, ey = elbow
    wx, wy = wrist
    mid = ((sx + ex) / 2, (sy + ey) / 2)
    upper = hide(ribbon([shoulder, mid, elbow], [40, 74, 46], n=9), RED)
    for t in (0.42, 0.62):
        blossom(upper, sx + (ex - sx) * t, sy + (ey - sy) * t, 24)
    b = math.degrees(math.atan2(wy - ey, wx - ex))
    m = -1 if flip else 1
    dx, dy = droop
    lower = hide(through([
        polar(ex, ey, 24, b + 180), polar(ex, ey, 30, b - 90 * m), polar(wx, wy, 26, b - 90 * m), (*polar(wx, wy, 30, b - 60 * m), 0),
        ((wx * 2 + dx) / 3 + 14 * m, (wy * 2 + dy) / 3), (dx, dy, 0), ((dx + ex) / 2 - 8 * m, (dy + ey) / 2 + 28), polar(ex, ey, 26, b + 120 * m)]), GREEN)
    cuff_line = [polar(wx, wy, 20, b - 70 * m), ((wx * 2 + dx) / 3 - 4 * m, (wy * 2 + dy) / 3), ((wx + 2 * dx) / 3 - 2 * m, (wy + 2 * dy) / 3), (dx, dy - 12)]
    cuff = hide(ribbon(cuff_line, [34, 44, 42, 20], n=9), AMBER, web=4.5)
    for i, (p, t, s) in enumerate(along(cuff_line).walk(33, 18, 30)):
        cuff.fit(ukel(), p.real, p.imag, t, 16, flip=i % 2 == 0, least=0.6)
    lower.clear_of(cuff)
    inlay(cuff, lower)
    cx, cy = (ex + wx + dx) / 3, (ey + wy + dy) / 3
    for t, r in ((-0.1, 34), (0.5, 25)):
        blossom(lower, cx + (ex - cx) * t, cy + (ey - cy) * t, r)
    pierce(sx, sy, upper)
    pierce(ex, ey, upper, lower)
    return upper, lower, cuff


def arms():
    fs, fe, fw = (594, 476), (676, 622), (808, 560)
    bs, be, bw = (398, 476), (296, 592), (196, 664)
    fu, fl, fcuff = sleeve(fs, fe, fw, (792, 748), False)
    bu, bl, bcuff = sleeve(bs, be, bw, (276, 790), True)
    stem = [line(along([(858, 548), (872, 480), (866, 420)]), 6), *flower(866, 384, 56, 8, RED, AMBER, -90),
            hide(petal(0.4).at(896, 478, -30, 30), GREEN), hide(petal(0.4).at(848, 492, -150, 26), GREEN)]
    front = ([fu, button(*fs, 21), button(*fe, 24)], [*hand(830, 552, -12), *stem, fl, fcuff, button(*fe, 24)])
    back = ([bu, button(*bs, 21), button(*be, 24)], [*hand(178, 682, 128), bl, bcuff, button(*be, 24)])
    rods = ([plain(ribbon([(836, 556), (846, 1000), (850, 1400), (848, 1500), (850, 1594)], ROD, n=21, tail=False))], [plain(ribbon([(172, 690), (166, 1150), (170, 1400), (168, 1500), (166, 1594)], ROD, n=21, tail=False))])
    return front, back, rods, (fs, fe, (836, 556), bs, be, (172, 690))


def draw():
    (fu, fl), (bu, bl), (fr, br), pivots = arms()
    main_rod = plain(ribbon([(494, 730), (498, 900), (500, 1290), (498, 1420), (500, 1500), (498, 1598)], [5, 5, 6, 7, 7, 8, 9, 13, 24, 26, 4], n=21))
    parts = [("rod_back", br), ("arm_back_lower", bl), ("arm_back_upper", bu), ("body", [*robe(), main_rod, button(594, 476, 21), button(398, 476, 21)]), ("head", head()),
             ("rod_front", fr), ("arm_front_lower", fl), ("arm_front_upper", fu)]
    n = write(Path(__file__).parent.parent / "putri.svg", SIZE, parts, "Putri", DARK)
    print(n, pivots)


if __name__ == "__main__":
    draw()
