"""Kayon (gunungan): the tree of life that opens and closes the play, a mountain, a gate and a forest in one leaf.

Run `python kayon.py` (numpy, scipy, shapely) to write ../kayon.svg. One half is cut, the other is its mirror image.
"""

import math
from pathlib import Path

from shapely.geometry import box

from leather import Leather, comma, dot, drop, lozenge, petal, plain, ribbon, sickle, through, write

SIZE = (1200, 1200)
AXIS = 600
EDGE = [(600, 14, 0), (622, 84), (668, 190), (738, 320), (816, 450), (882, 580), (912, 690), (894, 782), (828, 846), (766, 892), (752, 948), (776, 1014, 0), (690, 1036), (600, 1042)]


def along(points):
    return through(points, closed=False)


def mirrored(points):
    return [(2 * AXIS - p[0], *p[1:]) for p in points]


def mirror(curve):
    return curve.map(lambda z: complex(2 * AXIS - z.real, z.imag))


def draw():
    outline = through(EDGE + mirrored(EDGE)[-2:0:-1])
    k = Leather(outline, web=4.6)
    whole = k.free
    right = box(AXIS + 1.5, 0, 1200, 1200)
    k.free = k.free.intersection(right)

    rim = along([(600, 40), (648, 176), (716, 312), (794, 444), (858, 574), (884, 686), (868, 764), (808, 824)])
    rim_in = along([(600, 92), (634, 184), (698, 318), (774, 450), (836, 578), (860, 682), (846, 748), (792, 800)])
    k.row(rim, 17, drop(0.6), 7.6, 60, -1, 20, 0)
    k.row(rim_in, 11.5, dot(), 3.3, 0, 2, 26, 0)
    k.keep(along([(600, 100), (624, 184), (688, 322), (762, 454), (822, 580), (846, 680), (832, 740), (782, 788)]), margin=3)

    # the ground: base band and the pool
    k.row(along([(612, 1016), (690, 1010), (752, 994)]), 19, lozenge(0.7), 8)
    k.row(along([(608, 994), (690, 988), (744, 974)]), 12, dot(), 3.4)
    gate(k)
    face(k)
    branches(k)
    wings(k)

    free = k.free.intersection(right)
    inside = free.intersection(through([(598, 90, 0), (630, 190), (694, 324), (768, 456), (828, 582), (852, 682), (838, 742), (812, 806), (768, 858), (742, 900), (732, 944), (738, 966), (598, 984, 0)]).polygon(12).buffer(-1))
    flow = lambda x, y: -90 + 55 * math.tanh((x - AXIS) / 130) + 20 * math.sin(y / 47)
    k.pack(inside, 24, 3.2, flow, gap=4.7, cell=1.5, spiral=15, small=7, hand=lambda x, y: int(y // 53) % 2 == 0)

    k.holes += [mirror(h) for h in k.holes]
    k.free = whole
    # on the axis: the jewel, the bud, the crown
    for y, m, s, a in ((60, petal(0.3), 22, 90), (110, petal(0.4), 18, 90), (150, drop(0.6), 12, -90)):
        k.fit(m, AXIS, y, a, s, least=0.5)
    handle = plain(ribbon([(600, 1030), (600, 1080), (602, 1140), (600, 1196)], [16, 20, 34, 30, 6], n=11))
    print(write(Path(__file__).parent.parent / "kayon.svg", SIZE, [("body", [k, handle])], "Kayon"), len(k.holes))


def gate(k):
    """The gate (gapura): tiered roof, door leaves, stairs."""
    frame = through([(600, 724, 0), (640, 780), (676, 806, 0), (668, 826), (664, 970, 0), (600, 976, 0)])
    for pts in ([(604, 730), (630, 782), (680, 810)], [(600, 828), (676, 824)], [(664, 820), (660, 968)], [(622, 846), (622, 962)], [(600, 846), (660, 844)]):
        k.keep(along(pts), margin=3)
    for i in range(3):
        k.fit(sickle(0.6), 612 + 13 * i, 806 - 2 * i, -90, 9.5, least=0.5)
        if i < 2:
            k.fit(sickle(0.6), 608 + 9 * i, 786 - 3 * i, -90, 7.5, least=0.5)
    k.fit(drop(0.4), 610, 764, -90, 13)
    k.row(along([(606, 836), (660, 834)]), 11, dot(), 3.0)
    for y in (862, 884, 906, 928, 950):                                          # the door leaf and its jamb
        k.fit(lozenge(1.0), 611, y, 0, 7.2, least=0.6)
        k.fit(sickle(0.5), 641, y, -90, 11, least=0.6)
    k.keep(frame)


def face(k):
    """Banaspati, the demon in the tree: brows, bulging eyes, nose, tusks."""
    k.cut(ribbon([(606, 384), (628, 366), (660, 362), (692, 380), (704, 400)], [0, 11, 15, 9, 0]))         # brow
    k.cut(through([(616, 412, 0), (632, 392), (656, 390), (672, 412, 0), (656, 402), (632, 402)]))         # upper lid
    k.cut(through([(616, 420, 0), (630, 432), (658, 434), (674, 420, 0), (660, 446), (628, 446)]))         # lower lid
    k.fit(comma(), 618, 462, 30, 13)                                                                        # nostril
    k.cut(ribbon([(606, 492), (640, 484), (676, 492), (698, 470), (700, 446)], [3, 8, 8, 7, 0]))           # upper lip, curled
    for i in range(4):
        k.fit(drop(0.6), 609 + 14 * i, 508 - (0, 1, 1, 3)[i], 90, (9, 8, 8, 12)[i])                         # teeth, and the tusk
    k.cut(ribbon([(606, 532), (640, 528), (672, 520), (694, 500)], [3, 7, 6, 0]))
    for i in range(3):
        k.fit(drop(0.5), 612 + 19 * i, 550 - 4 * i, 84 - 14 * i, 12)                                        # beard
    k.cut(ribbon([(712, 404), (732, 424), (726, 456), (712, 466)], [0, 12, 11, 0]))                        # ear
    k.keep(through([(600, 356), (660, 356), (708, 380), (736, 420), (726, 470), (704, 510), (660, 548), (600, 556)]))


BOUGHS = [  # from the trunk outward, each ending in a volute
    [(611, 712), (660, 690), (720, 696), (776, 722), (820, 706), (828, 668), (804, 650), (784, 666), (796, 682)],
    [(611, 654), (650, 624), (706, 612), (762, 634), (802, 622), (812, 588), (790, 570), (771, 584), (782, 599)],
    [(611, 604), (650, 588), (704, 568), (752, 556), (780, 524), (766, 492), (738, 494), (736, 518), (752, 520)],
    [(608, 346), (640, 340), (670, 328), (680, 302), (664, 286), (648, 294), (654, 306)],
    [(607, 286), (630, 276), (644, 254), (634, 236), (619, 242), (623, 254)],
]


def branches(k):
    """The trunk stays leather; boughs are cut as scrolls of light with leaves on both sides."""
    k.keep(along([(600, 170), (600, 350)]), margin=3.5)
    k.keep(along([(600, 572), (600, 720)]), margin=7)
    for pts in BOUGHS:
        size = 0.75 if pts[0][1] < 400 else 1.0
        k.cut(ribbon(pts, [w * size for w in (0, 5, 7, 8, 8.5, 9, 9, 10, 13)], n=25))
        for side in (-1, 1):
            k.row(along(pts), 17 * size, drop(0.5), 9.5 * size, 150 * side, 15 * side * size, 14, 70 * size, least=0.6)


def wings(k):
    """The wing (lar) at the gate's shoulder: feathers in three rows."""
    for j, (r, n, size) in enumerate(((48, 5, 12), (78, 7, 14), (110, 9, 16))):
        for i in range(n):
            a = -72 + 100 * i / (n - 1)
            x, y = 676 + r * math.cos(math.radians(a)), 846 + r * 0.72 * math.sin(math.radians(a))
            k.fit(drop(0.42), x, y, a + 180, size, least=0.6)


if __name__ == "__main__":
    draw()
