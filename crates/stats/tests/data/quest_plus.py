#!/usr/bin/env python3
"""Writes quest_plus.json: which stimuli the questplus package (2023.1) shows an observer, and the posterior means it ends with. Needs questplus, numpy.

The observer answers by a fixed list. Our lapse prior is Beta(1, 10), given to questplus as weights; its sd is our width / 3.2897.
"""
import json
import numpy as np
from scipy.stats import norm
from questplus import QuestPlus

SPAN = 2 * norm.ppf(0.95)
stimuli = np.linspace(-2, 2, 17)
thresholds = np.linspace(-1.5, 1.5, 13)
widths = np.array([0.5, 1.0, 2.0, 3.5])
lapses = np.array([0.0, 0.03, 0.08])
answers = [bool(int(c)) for c in "1101101110101101111010111101101110110111"]
weights = (1 - lapses) ** 9
q = QuestPlus(stim_domain=dict(intensity=stimuli), param_domain=dict(mean=thresholds, sd=widths / SPAN, lower_asymptote=[0.5], lapse_rate=lapses),
              outcome_domain=dict(response=["yes", "no"]), prior=dict(lapse_rate=weights / weights.sum()), func="norm_cdf", stim_scale="linear",
              stim_selection_method="min_entropy", param_estimation_method="mean")
shown = []
for answer in answers:
    x = float(np.squeeze(q.next_stim["intensity"]))
    shown.append(int(np.argmin(abs(stimuli - x))))
    q.update(stim=dict(intensity=x), outcome=dict(response="yes" if answer else "no"))
mean = {k: float(np.squeeze(v)) for k, v in q.param_estimate.items()}
out = dict(stimuli=stimuli.tolist(), thresholds=thresholds.tolist(), widths=widths.tolist(), lapses=lapses.tolist(), answers=answers, shown=shown,
           threshold=mean["mean"], width=mean["sd"] * SPAN, lapse=mean["lapse_rate"])
with open("quest_plus.json", "w") as f:
    json.dump(out, f, indent=1)
    f.write("\n")
