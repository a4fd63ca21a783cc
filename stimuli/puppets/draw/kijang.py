"""Kijang, the golden deer of the forest scenes: a plain outline whose penumbrae are easy to see.

Run `python kijang.py` (numpy, scipy, shapely) to write ../kijang.svg and print the pivots.
"""

from pathlib import Path

from leather import Leather, dot, drop, petal, plain, ribbon, through, ukel, write

SIZE = (1240, 1360)


def along(points):
    return through(points, closed=False)


def body():
    b = Leather(through([(286, 600), (318, 540), (400, 500), (500, 506), (620, 520), (720, 500), (800, 480), (868, 514), (892, 560), (888, 620), (850, 684), (780, 716), (680, 716), (570, 690), (470, 690),
                         (400, 730), (320, 720), (280, 670)]), web=7)
    for k, (x, y, n) in enumerate(((452, 546, 9), (470, 580, 8), (488, 614, 6))):   # dapples
        for i in range(n):
            b.fit(drop(0.62), x + 36 * i, y + 1.2 * (i - n / 2) ** 2 * 0.4, 180, 12.5 - 1.2 * k, least=0.7)
    b.row(along([(468, 664), (570, 664), (660, 682), (730, 690)]), 17, dot(), 4.4)
    return b


def neck():
    n = Leather(through([(716, 540), (770, 470), (822, 392), (852, 310), (880, 262), (926, 262), (948, 300), (938, 380), (926, 460), (904, 526), (878, 572), (858, 566), (838, 540), (800, 532), (760, 556), (728, 566)]), web=7)
    for k, r in enumerate((0, 1, 2)):                                             # a collar of three strings
        pts = [(826 - 14 * k, 404 + 26 * k), (872 - 6 * k, 424 + 27 * k), (930 - 3 * k, 410 + 30 * k)]
        n.row(along(pts), (18, 15, 18)[k], (petal(0.6), dot(), drop(0.6))[k], (8, 4.6, 9.5)[k], (0, 0, 90)[k], 0, 8, 8)
    return n


def head():
    skull = Leather(through([(872, 300), (866, 256), (888, 222), (930, 214), (976, 240), (1030, 280), (1084, 306), (1104, 324), (1098, 346), (1070, 358), (1012, 360), (966, 362), (930, 372), (892, 350)]), web=4)
    skull.fit(through([(-1, 0.1, 0), (-0.2, -0.5), (0.5, -0.42), (1, 0.3, 0), (0.3, 0.42), (-0.4, 0.4)]), 952, 270, 18, 24)
    skull.fit(drop(0.6), 1082, 326, 30, 7)
    skull.cut(ribbon([(1090, 342), (1060, 340), (1030, 332)], [0, 5, 0]))
    ear = Leather(through([(900, 250, 0), (852, 240), (800, 206), (770, 158, 0), (830, 164), (880, 190), (912, 232, 0)]), web=6)
    ear.fit(drop(0.35), 836, 200, 216, 34)
    antlers = []
    for dx, lean in ((0, 0), (30, 34)):
        beam = ribbon([(912 + dx, 236), (896 + dx, 180), (920 + dx + lean, 110), (974 + dx + lean, 70), (986 + dx + lean, 16)], [20, 18, 16, 12, 0], n=13)
        tines = [ribbon([(900 + dx, 168), (932 + dx + lean, 158), (960 + dx + lean, 128)], [13, 10, 0], n=7),
                 ribbon([(916 + dx + lean, 116), (900 + dx + lean, 76), (914 + dx + lean, 30)], [12, 10, 0], n=7)]
        antlers += [plain(c) for c in (beam, *tines)]
    return [*antlers, ear, skull]


HIP, SHOULDER = (372, 620), (812, 592)
EYELET = {HIP: 52, SHOULDER: 41}   # round holes at the pivots of whatever lies under a near leg: the spiral in it shows at every pose


def eyelet(piece, pivot):
    piece.cut(dot().at(*pivot, 0, EYELET[pivot]))
    return piece


def leg(points, widths, hoof):
    """Ribbon from hip to fetlock, and the hoof; `hoof` is its turn in degrees."""
    (x, y) = points[-1]
    limb = Leather(ribbon(points, widths, n=15, tip=False), web=7)
    foot = plain(through([(-16, -14, 0), (-15, 10), (-18, 40, 0), (30, 40, 0), (18, 8), (14, -14, 0)]).at(x, y, hoof))
    return limb, foot


def draw():
    tail = plain(through([(330, 560, 0), (282, 560), (236, 540), (204, 494), (212, 448, 0), (238, 478), (278, 500), (330, 520, 0)]))
    back_near, bn_foot = leg([HIP, (404, 740), (392, 800), (318, 900), (330, 980), (336, 1096)], [164, 130, 88, 46, 36, 28], 0)
    back_far, bf_foot = leg([HIP, (452, 740), (470, 790), (442, 900), (474, 980), (500, 1090)], [150, 120, 84, 44, 34, 27], -12)
    front_near, fn_foot = leg([SHOULDER, (812, 700), (806, 790), (816, 880), (808, 980), (806, 1096)], [132, 96, 58, 46, 34, 28], 0)
    front_far, ff_foot = leg([SHOULDER, (880, 690), (946, 758), (990, 800), (958, 880), (924, 944)], [126, 92, 56, 44, 32, 26], 32)
    trunk, throat = eyelet(eyelet(body(), HIP), SHOULDER), neck()
    eyelet(back_far, HIP)
    eyelet(front_far, SHOULDER)
    for near, (x, y), size in ((back_near, HIP, 46), (front_near, SHOULDER, 35)):
        near.fit(ukel(1.5), x, y, 120, size)
    rod = plain(ribbon([(622, 640), (622, 900), (624, 1150), (622, 1260), (622, 1356)], [8, 9, 10, 11, 12, 13, 16, 26, 28, 5], n=21))
    parts = [("tail", [tail]), ("leg_back_far", [back_far, bf_foot]), ("leg_front_far", [front_far, ff_foot]), ("neck", [throat]), ("head", head()), ("body", [trunk, rod]),
             ("leg_back_near", [back_near, bn_foot]), ("leg_front_near", [front_near, fn_foot])]
    print(write(Path(__file__).parent.parent / "kijang.svg", SIZE, parts, "Kijang"))


if __name__ == "__main__":
    draw()
