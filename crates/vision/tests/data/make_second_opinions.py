"""Expected SSIM and FLIP of two small images that the Rust tests make by the same formula.

pip install numpy scikit-image flip-evaluator; python3 make_second_opinions.py
"""
import flip_evaluator
import numpy as np
from skimage.metrics import structural_similarity

W, H = 64, 48


def images():
    """A soft-edged disk on a gradient, and the same disk moved, dimmed and tinted a little; float32 sRGB in [0, 1]."""
    y, x = np.mgrid[0:H, 0:W].astype(np.float64)
    def disk(cx, cy, r, level):
        t = np.clip((np.hypot(x - cx, y - cy) - r) / 6.0 + 0.5, 0.0, 1.0)
        ground = 0.4 + 0.5 * x / W
        return ground * (t + (1.0 - t) * level)
    a, b = disk(30, 24, 12, 0.1), disk(31.5, 24, 12, 0.15)
    return np.stack([a, 0.9 * a, 0.7 * a], -1), np.stack([b, 0.88 * b, 0.72 * b], -1)


reference, test = images()
grey = lambda image: image @ np.array([0.25, 0.5, 0.25])
print("ssim", repr(float(structural_similarity(grey(reference), grey(test), gaussian_weights=True, sigma=1.5,
      use_sample_covariance=False, data_range=1.0))))
for name, (a, b) in {"flip": (reference, test), "flip_same": (reference, reference)}.items():
    error_map, mean, parameters = flip_evaluator.evaluate(a.astype(np.float32), b.astype(np.float32), "LDR", applyMagma=False)
    print(name, repr(float(mean)), repr(float(error_map.max())), parameters)
