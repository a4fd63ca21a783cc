#!/usr/bin/env python3
"""Writes the reference images of kelir-stage's ray tracer, and the ball, the sky and the slide that are in them, with Mitsuba 3 (BSD-3-Clause).

    pip install mitsuba==3.9.1 && python make.py [NAME...]

The scenes are the TOML files beside this one: stage.toml followed by a file for each light, and mirror.toml. What their keys mean is written down here a second time,
from docs/reference/scene-file.md and not from kelir's code. Each image is 48 x 36 pixels (box filter) of 32 independent renderings: channels R, G, B are their mean
in radiance, and SE.R, SE.G, SE.B its standard error, f32. Seeds are fixed; another number of cores or version of LLVM may change the last bits.

Where Mitsuba has no such thing:
- a sun with a radius is a disk at 10 km, whose cone differs over 1 m by 0.1 mrad;
- Mitsuba's sky has rows of texels from pole to pole, kelir's has none at the poles: so Mitsuba gets the sky in rows of its own, about 32 times as fine;
- Mitsuba's projector throws a slide's irradiance on a plane, kelir's radiant intensity: so Mitsuba gets the slide times the cube of the cosine.
"""
import os
import sys
import tomllib

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
T = mi.ScalarTransform4f
HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = (48, 36)
RENDERINGS, SAMPLES = 32, 1024
# Image: files of its scene, and Mitsuba's greatest depth: 2 is light by way of one surface, 3 by way of two.
IMAGES = {
    "point": (["stage", "point"], 2),
    "directional": (["stage", "directional"], 2),
    "sun": (["stage", "sun"], 2),
    "rectangle": (["stage", "rectangle"], 2),
    "disk": (["stage", "disk"], 2),
    "environment": (["stage", "environment"], 2),
    "projector": (["stage", "projector"], 2),
    "bounced": (["stage", "rectangle"], 3),
    # The camera sees mirror, sky and lamp alone, so a depth of 3 is what a mirror shows of surfaces that are lit directly.
    "mirror": (["mirror"], 3),
}


def path(name):
    return os.path.join(HERE, name)


def rgb(value):
    return {"type": "rgb", "value": [float(x) for x in (value if isinstance(value, list) else [value] * 3)]}


def looking(from_m, at_m, up=(0.0, 1.0, 0.0)):
    """Mitsuba's cameras, lamps and projectors look along their own +z."""
    return T().look_at(origin=[float(x) for x in from_m], target=[float(x) for x in at_m], up=[float(x) for x in up])


def placed(thing):
    """Enlarged, then turned about z, x and y, then moved."""
    x, y, z = thing.get("rotate_deg", [0, 0, 0])
    turn = T().rotate([0, 1, 0], y) @ T().rotate([1, 0, 0], x) @ T().rotate([0, 0, 1], z)
    return T().translate(thing.get("position_m", [0, 0, 0])) @ turn @ T().scale(float(thing.get("scale", 1)))


def size(size_m):
    """Mitsuba's rectangles have sides of 2."""
    return T().scale([0.5 * size_m[0], 0.5 * size_m[1], 1])


def surface(thing):
    if "mirror" in thing:
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(thing["mirror"])}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(thing["albedo"])}}


def shape(thing):
    match thing["shape"]:
        case "rectangle":
            form = {"type": "rectangle", "to_world": placed(thing) @ size(thing["size_m"])}
        case "sphere":
            form = {"type": "sphere", "center": [float(x) for x in thing["position_m"]], "radius": thing["radius_m"]}
        case "mesh":
            form = {"type": "ply", "filename": path(thing["file"]), "face_normals": True, "to_world": placed(thing)}
    return form | {"bsdf": surface(thing)}


def lamp(form, to_world, radiance):
    """It sends nothing back."""
    black = {"type": "diffuse", "reflectance": rgb(0)}
    return {"type": form, "to_world": to_world, "bsdf": black, "emitter": {"type": "area", "radiance": radiance}}


def light(it):
    look = lambda: looking(it["position_m"], it.get("look_at_m", [0, 0, 0]), it.get("up", [0, 1, 0]))
    match it["kind"]:
        case "point":
            return {"type": "point", "position": it["position_m"], "intensity": rgb(it["intensity"])}
        case "directional" if "angular_radius_deg" not in it:
            return {"type": "directional", "direction": it["direction"], "irradiance": rgb(it["irradiance"])}
        case "directional":
            far_m, alpha = 1e4, np.radians(it["angular_radius_deg"])
            middle = -far_m * np.array(it["direction"]) / np.linalg.norm(it["direction"])
            radiance = np.array(it["irradiance"]) / (np.pi * np.sin(alpha) ** 2)
            return lamp("disk", looking(middle, [0, 0, 0]) @ T().scale(float(far_m * np.tan(alpha))), rgb(list(radiance)))
        case "rectangle":
            return lamp("rectangle", look() @ size(it["size_m"]), rgb(it["radiance"]))
        case "disk":
            return lamp("disk", look() @ T().scale(float(it["radius_m"])), rgb(it["radiance"]))
        case "environment":
            # Mitsuba's u is 0 at -z; kelir's is 1/2 there.
            turn = T().rotate([0, 1, 0], 180)
            picture = fine_sky(np.array(mi.Bitmap(path(it["image"])))) * np.array(it["scale"])
            return {"type": "envmap", "bitmap": mi.Bitmap(picture.astype(np.float32)), "to_world": turn}
        case "projector":
            slide = linear(np.array(mi.Bitmap(path(it["slide"]["image"])))) * np.array(it["intensity"])
            texture = {"type": "bitmap", "bitmap": mi.Bitmap(fine_slide(slide, it["throw_deg"])), "raw": True, "wrap_mode": "clamp"}
            # Mitsuba's numbers are pi times too small for an irradiance.
            return {"type": "projector", "irradiance": texture, "scale": 1 / np.pi, "fov": it["throw_deg"], "to_world": look()}


def bilinear(picture, x, y, around):
    """`picture` at columns `x` and rows `y` counted from texels' middles; its sides meet where it goes `around`, otherwise its edge goes on."""
    rows, columns, _ = picture.shape
    y = np.clip(y, 0, rows - 1)
    x = x if around else np.clip(x, 0, columns - 1)
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - x0)[None, :, None], (y - y0)[:, None, None]
    x1, y1 = x0 + 1, np.minimum(y0 + 1, rows - 1)
    x0, x1 = (x0 % columns, x1 % columns) if around else (x0, np.minimum(x1, columns - 1))
    row = lambda k: picture[k][:, x0] * (1 - fx) + picture[k][:, x1] * fx
    return row(y0) * (1 - fy) + row(y1) * fy


def fine_sky(picture):
    # Odd one way and even the other: the middles of kelir's texels are among those of the fine ones, so that its kinks stay.
    along, down = 33, 32
    rows, columns, _ = picture.shape
    u = (np.arange(columns * along) + 0.5) / (columns * along)
    v = np.arange(rows * down + 1) / (rows * down)
    return bilinear(picture.astype(float), u * columns - 0.5, v * rows - 0.5, True)


def fine_slide(picture, throw_deg, pixels=1024):
    u = (np.arange(pixels) + 0.5) / pixels
    tangent = np.tan(np.radians(throw_deg / 2)) * (2 * u - 1)
    cos3 = (1 + tangent[:, None] ** 2 + tangent[None, :] ** 2) ** -1.5
    n = picture.shape[0]
    return (bilinear(picture, u * n - 0.5, u * n - 0.5, False) * cos3[..., None]).astype(np.float32)


def linear(srgb):
    """IEC 61966-2-1."""
    x = srgb / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def camera(it):
    film = {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"}
    sensor = {"type": "perspective", "fov_axis": "y", "fov": it["field_of_view_deg"], "near_clip": 0.01, "film": film}
    return sensor | {"to_world": looking(it["position_m"], it["look_at_m"]), "sampler": {"type": "independent"}}


def draw(name):
    files, depth = IMAGES[name]
    stage = tomllib.loads("".join(open(path(f"{file}.toml")).read() for file in files))["stage"]
    scene = {"type": "scene", "integrator": {"type": "path", "max_depth": depth, "rr_depth": 100}, "sensor": camera(stage["camera"])}
    scene |= {f"object{k}": shape(it) for k, it in enumerate(stage["objects"])}
    scene |= {f"light{k}": light(it) for k, it in enumerate(stage["lights"])}
    scene = mi.load_dict(scene)
    images = np.array([np.array(mi.render(scene, spp=SAMPLES, seed=1 + k), dtype=float) for k in range(RENDERINGS)])
    mean, error = images.mean(0), images.std(0, ddof=1) / np.sqrt(RENDERINGS)
    both = np.concatenate([mean, error], 2).astype(np.float32)
    names = ["R", "G", "B", "SE.R", "SE.G", "SE.B"]
    mi.Bitmap(both, mi.Bitmap.PixelFormat.MultiChannel, names).write(path(f"{name}.exr"))
    print(name, "mean", mean.mean((0, 1)), "its standard error", np.sqrt((error**2).sum((0, 1))) / mean[..., 0].size, flush=True)


def ball():
    """An icosahedron, each of its triangles cut into four twice: 320, counter-clockwise seen from outside."""
    g = (1 + 5**0.5) / 2
    corners = [np.array(p) for p in [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    corners = [p / np.linalg.norm(p) for p in corners]
    edges = lambda: [(i, j) for i in range(12) for j in range(12) if i != j and corners[i] @ corners[j] > 0.4]
    near = set(edges())
    faces = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12) if {(i, j), (j, k), (i, k)} <= near]
    out = lambda f: np.cross(corners[f[1]] - corners[f[0]], corners[f[2]] - corners[f[0]]) @ corners[f[0]] > 0
    faces = [f if out(f) else (f[0], f[2], f[1]) for f in faces]
    for _ in range(2):
        middles = {}

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(corners)
                m = corners[i] + corners[j]
                corners.append(m / np.linalg.norm(m))
            return middles[key]

        cut = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            cut += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = cut
    with open(path("ball.ply"), "w") as file:
        head = ["ply", "format ascii 1.0", f"element vertex {len(corners)}", "property float x", "property float y", "property float z"]
        head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
        file.write("\n".join(head) + "\n")
        file.writelines("%.6f %.6f %.6f\n" % tuple(p) for p in corners)
        file.writelines("3 %d %d %d\n" % f for f in faces)


def sky(columns=32, rows=16):
    """Smooth, of other colours in all directions, and dark within 40 degrees of where mirror.toml has its lamp."""
    phi = 2 * np.pi * ((np.arange(columns) + 0.5) / columns - 0.5)[None, :]
    theta = np.pi * ((np.arange(rows) + 0.5) / rows)[:, None]
    x, y, z = np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.cos(phi)
    lamp = np.array([2.4, 1.1, 0.6]) / np.linalg.norm([2.4, 1.1, 0.6])
    angle = np.degrees(np.arccos(np.clip(x * lamp[0] + y * lamp[1] + z * lamp[2], -1, 1)))
    open_ = np.clip((angle - 50) / 40, 0, 1)[..., None]
    colours = np.stack([1.2 - x, 0.7 + 0.5 * y + 2 * np.clip(-x * z * 2, 0, 1), 0.8 + 0.7 * z + 0.2 * y], 2)
    mi.Bitmap((colours * open_).astype(np.float32)).write(path("sky.exr"))


def slide():
    """Four by four squares of fixed random colours, none black."""
    colours = np.random.Generator(np.random.PCG64(7)).integers(40, 256, (4, 4, 3), dtype=np.uint8)
    mi.Bitmap(colours).write(path("slide.png"))


if __name__ == "__main__":
    print("Mitsuba", mi.__version__)
    ball()
    sky()
    slide()
    for name in sys.argv[1:] or IMAGES:
        draw(name)
