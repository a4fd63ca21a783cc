"""Arjuna, the refined hero of the wayang kulit: bowed head, needle nose, arms to the knees.

Run `python arjuna.py` (numpy, scipy, shapely) to write ../arjuna.svg and print the pivots.
"""

import math
from pathlib import Path

from leather import Leather, comma, dot, drop, lozenge, petal, plain, ribbon, sickle, through, ukel, write

SIZE = (1000, 1900)
HEAD = dict(x=440, y=336, turn=-24, scale=1.06)


def head(curve):
    """From the head's own frame (ear at the origin, facing left, upright) to the puppet's."""
    return curve.at(**HEAD)


def along(points):
    return through(points, closed=False)


def rosette(leather, x, y, inner, outer, petals, fat=0.5):
    leather.fit(dot(), x, y, 0, inner * 0.6)
    for i in range(petals):
        a = 360 * i / petals
        p = complex(x, y) + (inner + outer) / 2 * complex(math.cos(math.radians(a)), math.sin(math.radians(a)))
        leather.fit(drop(fat), p.real, p.imag, a + 180, (outer - inner) / 2)


def kawung(leather, area, pitch, axis):
    """Batik of palm fruit: four petals a cell, a seed in the middle of each side."""
    x0, y0, x1, y1 = area.bounds
    c = complex((x0 + x1) / 2, (y0 + y1) / 2)
    turn = lambda a: complex(math.cos(math.radians(a)), math.sin(math.radians(a)))
    n = int(max(x1 - x0, y1 - y0) / pitch) + 2
    for j in range(-n, n + 1):
        for i in range(-n, n + 1):
            p = c + turn(axis) * pitch * complex(i, j)
            for a in (45, 135, 225, 315):
                m = p + turn(axis + a) * pitch * 0.3535
                leather.fit(petal(0.6), m.real, m.imag, axis + a, pitch * 0.29, inside=area, least=0.85)
            for side in (0.5, 0.5j):
                m = p + turn(axis) * pitch * side
                leather.fit(lozenge(0.9), m.real, m.imag, axis, pitch * 0.085, inside=area, least=0.85)


def headdress():
    """Face, hair cap, diadem, the lobster's claw (gelung supit urang) swept from the nape forward over the brow, and the
    bird that looks backward (garuda mungkur)."""
    face = Leather(head(through([
        (-34, -78, 0), (-104, -42), (-180, 4, 0),            # one line from the brow to the needle of the nose
        (-152, 9), (-128, 11, 0),                            # nostril
        (-136, 22, 0), (-124, 30, 0), (-131, 39), (-114, 46, 0),  # lips
        (-116, 58), (-96, 70), (-56, 70), (-20, 78),         # chin and jaw
        (6, 70), (46, 66), (62, 40), (58, 0), (30, -60, 0)])), web=3.2)
    cap = Leather(head(through([(-40, -70, 0), (-50, -92), (-20, -124), (40, -128), (84, -92), (96, -30), (88, 30), (74, 58, 0), (46, 40), (34, -14), (4, -54)])), web=3.6)
    claw_line = [(70, 40), (124, 30), (162, -30), (156, -118), (96, -184), (10, -202), (-62, -176), (-84, -122), (-50, -96), (-16, -116), (-24, -144)]
    widths = [40, 66, 80, 86, 82, 70, 56, 42, 32, 22, 8]
    claw = Leather(head(ribbon(claw_line, widths, n=25)), web=4.2)
    bird = Leather(head(through([
        (70, 40, 0), (150, 34), (190, 0), (214, -50), (206, -110), (172, -136, 0), (232, -116), (252, -50), (236, 10),  # crest
        (252, 14), (288, 40), (304, 92), (286, 124, 0), (276, 90), (248, 72), (208, 76, 0),                            # upper beak
        (238, 90), (262, 112), (268, 146, 0), (236, 132), (190, 130),                                                   # lower beak
        (168, 150), (172, 196), (146, 238), (112, 248, 0), (128, 206), (112, 162), (84, 124), (56, 84)])), web=4)        # plume
    pieces = [bird, claw, face, cap]
    for p in pieces:
        p.clear_of(*(q for q in pieces if q is not p))

    face.cut(head(through([(-116, -12, 0), (-86, -18), (-56, -8, 0), (-84, -5)])))               # eye, almost closed
    face.cut(head(ribbon([(-110, -29), (-78, -38), (-38, -22)], [0, 6.5, 0])))                   # brow
    face.cut(head(ribbon([(-118, 34), (-102, 32), (-86, 22)], [1, 5, 0])))                       # the smile
    face.cut(head(ribbon([(-138, 2), (-124, -6), (-116, 3)], [0, 5, 0])))                        # nostril
    e = head(along([(-2, 22), (0, 22)])).segments[0][0]
    rosette(face, e.real, e.imag, 8, 21, 8)
    face.row(head(along([(-96, 60), (-56, 60), (-26, 64), (8, 58), (40, 56)])), 12, dot(), 2.6, start=22)
    face.row(head(along([(-36, -66), (-2, -46), (24, -10), (34, 36)])), 15, lozenge(0.7), 6.2)   # diadem

    area = cap.within(head(through([(-60, -94), (-20, -134), (44, -138), (94, -96), (108, -30), (96, 60), (60, 40), (44, -14), (10, -64), (-30, -80)])))
    cap.lattice(area, (18, 13.5), sickle(0.55), 7.4, -120, axis=-24, least=0.7)

    spine = head(along(claw_line))
    for i, (p, a, s) in enumerate(spine.walk(33, 60, 200)):
        claw.fit(ukel(), p.real, p.imag, a + 20, 18.5, flip=i % 2 == 0, least=0.5)
    for side, start, end in ((-1, 60, 330), (1, 60, 330)):
        claw.row(spine, 15.5, drop(0.55), 6.8, 180 if side > 0 else 0, side * 27.5, start, end, least=0.55)
    claw.row(spine, 14, drop(), 6.5, 180, 0, 580, 16, taper=lambda s: 1.9 - 1.3 * s)
    bird.row(head(along([(186, 30), (222, -20), (232, -62), (222, -104)])), 19, comma(), 11)
    bird.row(head(along([(222, 44), (262, 50), (286, 84), (290, 112)])), 16, drop(0.6), 7.5, 180)
    e = head(along([(196, 56), (197, 56)])).segments[0][0]
    rosette(bird, e.real, e.imag, 7, 19, 7)
    bird.row(head(along([(196, 104), (226, 112), (244, 136)])), 14, drop(), 6, 180)
    bird.row(head(along([(120, 100), (150, 160), (148, 204), (130, 236)])), 19, comma(), 11, flip=True)
    bird.row(head(along([(120, 56), (160, 74), (180, 96)])), 15, drop(0.55), 6.5, 180)
    bird.row(head(along([(96, 78), (140, 104), (152, 126)])), 13, dot(), 3.4)

    # tongues of flame along the claw's outer edge
    flames = []
    edge = head(ribbon_edge(claw_line, widths))
    for p, a, s in edge.walk(34, 230, 170):
        size = 31 * (1.2 - 0.6 * s)
        flames.append(plain(through([(-0.9, -0.12), (-0.3, 0.4), (0.5, 0.72), (1.2, 0.64, 0), (0.75, 0.26), (0.7, -0.12)]).at(p.real, p.imag, a, size)))
    return flames + pieces


def ribbon_edge(points, widths):
    """The right edge of a ribbon, as an open curve."""
    n = 40
    left = []
    for i, (p, a, s) in enumerate(along(points).walk(1e-9 + _length(points) / n)):
        w = widths[min(int(s * (len(widths) - 1)), len(widths) - 2)]
        w += (widths[min(int(s * (len(widths) - 1)) + 1, len(widths) - 1)] - w) * (s * (len(widths) - 1) % 1)
        q = p + 1j * complex(math.cos(math.radians(a)), math.sin(math.radians(a))) * w / 2
        left.append((q.real, q.imag))
    return along(left)


def _length(points):
    pts = along(points).points(24)
    return sum(abs(b - a) for a, b in zip(pts, pts[1:]))


def trunk():
    """Torso, belt and hip cloth."""
    torso = Leather(through([
        (434, 404), (440, 446), (418, 484), (352, 508), (292, 528), (260, 566), (268, 614), (308, 642),
        (352, 684), (386, 750), (396, 816, 0), (484, 818, 0),
        (494, 752), (532, 684), (588, 630), (644, 592), (684, 546), (682, 494), (642, 462), (586, 464), (532, 478), (504, 462), (496, 430), (500, 380)]), web=4.5)
    belt = Leather(through([(384, 798), (440, 808), (492, 796), (514, 816), (514, 852), (438, 871), (362, 856), (364, 818)]), web=3.6)
    cloth = Leather(through([
        (364, 848, 0), (330, 896), (304, 962), (308, 1052), (326, 1128, 0), (400, 1146), (480, 1140), (560, 1150), (640, 1186), (768, 1268, 0),
        (768, 1180), (760, 1090), (726, 990), (666, 912), (590, 866), (504, 842, 0), (438, 860)]), web=4.6)
    for p, others in ((torso, [belt]), (belt, [torso, cloth]), (cloth, [belt])):
        p.clear_of(*others)

    for k, (step, size, motif, turn) in enumerate([(14, 4.6, dot(), 0), (18, 9, drop(0.55), 90), (14, 3.6, dot(), 0)]):
        y = (0, 20, 42)[k]
        torso.row(along([(420, 474 + y * .5), (452, 494 + y), (486, 492 + y), (514, 470 + y * .5)]), step, motif, size, turn, 0, 3, 3)
    torso.row(along([(394, 506), (398, 600), (424, 690), (436, 790)]), 12.5, dot(), 3.6)             # the long chain (ulur-ulur)
    torso.row(along([(532, 500), (506, 600), (458, 690), (442, 790)]), 12.5, dot(), 3.6, end=18)
    torso.fit(ukel(), 452, 580, 90, 22)
    torso.fit(ukel(), 423, 566, 90, 15, flip=True)
    torso.fit(ukel(), 483, 566, 90, 15)
    torso.fit(drop(0.6), 453, 628, 90, 18)
    torso.row(along([(664, 572), (672, 530), (650, 486), (590, 482), (548, 494)]), 14, drop(0.6), 5.5, 90)
    torso.row(along([(278, 594), (276, 562), (304, 540), (352, 524), (384, 512)]), 14, drop(0.6), 5.5, 90)

    belt.row(along([(364, 838), (438, 851), (510, 836)]), 12, dot(), 3.0, least=0.5)
    belt.row(along([(368, 819), (438, 830), (506, 817)]), 22, lozenge(0.55), 8.5, least=0.5)

    hem = along([(328, 1114), (400, 1131), (480, 1125), (560, 1135), (640, 1169), (752, 1244)])
    back = along([(752, 1236), (752, 1180), (744, 1092), (710, 998), (654, 924), (586, 876), (508, 850)])
    front = along([(352, 888), (320, 962), (324, 1052), (338, 1108)])
    for edge, offset in ((hem, 0), (back, 0)):
        cloth.row(edge, 15.5, drop(0.6), 6.8, -90, offset, 6, 8)
        cloth.row(edge, 11, dot(), 3.0, 0, offset - 17, 10, 12)
    cloth.row(front, 13, dot(), 4.0)
    area = cloth.within(through([(376, 872), (344, 960), (342, 1050), (354, 1094), (400, 1106), (480, 1100), (560, 1108), (650, 1144), (722, 1190), (724, 1180), (716, 1100), (686, 1008),
                                 (636, 940), (574, 894), (500, 868)]))
    kawung(cloth, area, 45, -14)
    return torso, belt, cloth


def kris():
    """The dagger at his back: sheath, its boat-shaped mouth, and the curved hilt."""
    return [plain(ribbon([(470, 856), (540, 800), (604, 756)], [16, 17, 18])),
            plain(ribbon([(562, 742), (610, 764), (646, 802)], [2, 24, 2], n=7)),
            plain(ribbon([(598, 764), (638, 728), (650, 690), (634, 668), (616, 682)], [14, 18, 20, 15, 3], n=11))]


def sashes():
    """The pleats (wiron) that fall in front, and the loose end that flies behind."""
    pleats = Leather(through([(338, 880, 0), (286, 980), (256, 1110), (236, 1230), (204, 1330, 0), (230, 1316, 0), (244, 1350, 0), (264, 1320, 0), (284, 1350, 0), (300, 1316, 0), (322, 1340, 0),
                              (334, 1240), (332, 1130), (312, 1060), (310, 970), (342, 890, 0)]), web=4.5)
    for k, x in enumerate((0, 20, 40)):
        pleats.row(along([(302 + x * .2, 960), (274 + x * .7, 1080), (258 + x * 1.15, 1220), (232 + x * 1.4, 1310)]), 42, petal(0.2), 18.5, 0, 0, 4 + 21 * (k % 2), 6, least=0.5)
    line = [(508, 842), (600, 826), (706, 846), (784, 920), (824, 1030), (876, 1104), (926, 1096), (918, 1062)]
    loose = Leather(ribbon(line, [24, 50, 58, 56, 46, 32, 17, 3], n=17), web=4.2)
    for i, (p, a, s) in enumerate(along(line).walk(31, 100, 70)):
        loose.fit(ukel() if s < 0.7 else comma(), p.real, p.imag, a + 10, 17.5, flip=i % 2 == 0, least=0.5)
    for side in (-1, 1):
        loose.row(along(line), 15.5, drop(0.5), 5, 180, side * 19, 100, 120)
    return pleats, loose


def leg(hip, knee, ankle, toe):
    """Trouser, anklet and the long bare foot."""
    (ax, ay), (tx, ty) = ankle, toe
    shank = Leather(ribbon([hip, knee, ankle], [118, 88, 40], tail=False, tip=False, n=9), web=4)
    cuff = Leather(ribbon([(ax - 25, ay - 8), (ax + 2, ay), (ax + 27, ay - 2)], [21, 24, 21]), web=2.8)
    foot = Leather(through([(ax - 17, ay, 0), (ax - 24, ay + 20), (ax - 70, ty - 20), (tx + 8, ty - 12), (tx - 6, ty + 2), (tx + 6, ty + 12), (tx + 46, ty + 11),
                            (ax - 60, ty), (ax - 20, ty + 12), (ax + 14, ty + 15), (ax + 36, ty), (ax + 20, ay, 0)]), web=2.8)
    shank.clear_of(cuff)
    foot.clear_of(cuff)
    rows = along([hip, knee, ankle])
    for o in (-1, 0, 1):
        shank.row(rows, 21, lozenge(0.6), 7.4, 0, o * 20, 50 + (10.5 if o else 0), 16, taper=lambda s: 1.25 - 0.5 * s)
    cuff.row(along([(ax - 25, ay - 8), (ax + 2, ay), (ax + 27, ay - 2)]), 11.5, dot(), 3.4)
    for i in range(4):
        foot.fit(petal(0.26), tx + 12 + 14 * i, ty - 3 - 0.6 * i, 20, 9, least=0.6)
    return [shank, foot, cuff]


def arm(front):
    """Upper arm, forearm with its hand, and rod; and the pivots."""
    if front:
        shoulder, elbow, wrist, palm = (288, 576), (206, 806), (132, 1004), (114, 1050)
    else:
        shoulder, elbow, wrist, palm = (650, 528), (770, 744), (846, 918), (868, 964)
    bend = -10 if front else 12
    side = 1 if front else -1
    mid = ((shoulder[0] + elbow[0]) / 2 + bend, (shoulder[1] + elbow[1]) / 2)
    bone = along([shoulder, mid, elbow])
    upper = Leather(ribbon([shoulder, mid, elbow], [58, 46, 40], n=7), web=4.2)
    a = math.degrees(math.atan2(elbow[1] - shoulder[1], elbow[0] - shoulder[0]))
    p = complex(*shoulder) + 0.42 * (complex(*elbow) - complex(*shoulder)) + bend
    place = lambda c, s=1.0: c.at(p.real, p.imag, a, s)
    # the winged armlet (kelat bahu)
    band = Leather(place(ribbon([(-5, -32), (0, 0), (-5, 32)], [27, 31, 27])), web=3.2)
    wings = []
    for s, size in ((side, 1.1), (-side, 0.66)):
        hand = (lambda c: c) if s > 0 else (lambda c: c.map(lambda z: z.conjugate()))
        wing = Leather(place(hand(ribbon([(4, 18), (-4, 50), (-34, 70), (-60, 56), (-50, 38)], [36, 34, 24, 14, 3], n=11)), size), web=3.2)
        wing.clear_of(band, upper)
        wing.row(place(hand(along([(2, 40), (-12, 57), (-36, 68), (-54, 58)])), size), 15 * size, drop(0.6), 7.2 * size, 180)
        wings.append(wing)
    upper.clear_of(band)
    upper.row(bone, 13, dot(), 3.4, start=150, end=34)
    upper.row(bone, 13, dot(), 3.4, start=34, end=168)
    band.row(place(along([(-4, -30), (0, 0), (-4, 30)])), 14, drop(0.7), 6.4, 90)

    fore = Leather(ribbon([elbow, ((elbow[0] + wrist[0]) / 2 + bend / 2, (elbow[1] + wrist[1]) / 2), wrist, palm], [40, 33, 25, 24], n=9), web=3)
    b = math.degrees(math.atan2(wrist[1] - elbow[1], wrist[0] - elbow[0]))
    cuffs = []
    for back in (2, 29):
        q = complex(*wrist) - back * complex(math.cos(math.radians(b)), math.sin(math.radians(b)))
        across = [(0, -22), (3, 0), (0, 22)]
        cuff = Leather(ribbon(across, [20, 22, 20]).at(q.real, q.imag, b), web=2.6)
        fore.clear_of(cuff)
        cuff.row(along(across).at(q.real, q.imag, b), 11.5, dot(), 3.6)
        cuffs.append(cuff)
    fingers = [plain(h.at(palm[0], palm[1], b - 90, 1.0, flip=not front)) for h in (
        through([(-14, -24), (-17, 0), (-14, 22), (0, 30), (13, 20), (16, 0), (13, -24)]),
        ribbon([(-10, 14), (-26, 34), (-32, 58), (-22, 76)], [13, 11, 9, 4], n=8),
        ribbon([(-3, 20), (-12, 46), (-14, 72), (-2, 88)], [13, 11, 9, 4], n=8),
        ribbon([(6, 20), (4, 46), (8, 68), (20, 80)], [12, 11, 8, 4], n=8),
        ribbon([(12, 12), (18, 34), (28, 46), (42, 48)], [12, 10, 8, 4], n=8),
        ribbon([(-12, -8), (-32, 4), (-42, 28)], [13, 10, 5], n=7),                        # thumb
    )]
    foot = (palm[0] + (40 if front else -50), 1890)   # longer than needed at rest: a raised hand must not lift it into view
    rod = ribbon([palm, ((palm[0] + foot[0]) / 2 + 6 * side, 1440), foot], [5, 6, 7, 8, 9, 11], n=9, tip=False, tail=False)
    return [upper, *wings, band], [fore, *fingers, *cuffs], [plain(rod)], (shoulder, elbow, palm)


def gapit():
    """The horn rod that holds him, from the chest to the spike below the feet."""
    return plain(ribbon([(458, 660), (448, 780), (452, 960), (446, 1140), (450, 1300), (446, 1440), (448, 1560), (446, 1698)], [6, 9, 11, 14, 20, 30, 26, 5], n=17))


def draw():
    pleats, loose = sashes()
    torso, belt, cloth = trunk()
    legs = leg((560, 1136), (558, 1220), (592, 1330), (462, 1368)) + leg((392, 1134), (376, 1214), (402, 1322), (272, 1364))
    fu, fl, fr, pf = arm(True)
    bu, bl, br, pb = arm(False)
    body = [loose, *kris(), *legs, pleats, cloth, torso, belt, *headdress(), gapit()]
    parts = [("rod_back", br), ("arm_back_upper", bu), ("arm_back_lower", bl), ("body", body), ("rod_front", fr), ("arm_front_upper", fu), ("arm_front_lower", fl)]
    n = write(Path(__file__).parent.parent / "arjuna.svg", SIZE, parts, "Arjuna")
    print(n, pf, pb)


if __name__ == "__main__":
    draw()
