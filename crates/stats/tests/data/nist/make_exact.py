"""The statistics in exact arithmetic on f64 inputs: python3 make_exact.py > exact.tsv (set, statistic, value)."""
from fractions import Fraction
from mpmath import mp, mpf, sqrt, nstr

mp.dps = 60
to_mpf = lambda q: mpf(q.numerator) / mpf(q.denominator)
show = lambda name, what, value: print(name, what, nstr(value, 17, min_fixed=0, max_fixed=0), sep="\t")

for line in open("univariate.txt"):
    head, data = line.split(":")
    name = head.split()[0]
    y = [Fraction(float(v)) for v in data.split()]
    mean = sum(y) / len(y)
    d = [v - mean for v in y]
    squares = sum(v * v for v in d)
    show(name, "mean", to_mpf(mean))
    show(name, "sd", sqrt(to_mpf(squares / (len(y) - 1))))
    show(name, "autocorrelation", to_mpf(sum(a * b for a, b in zip(d, d[1:])) / squares))
for k in range(1, 10):
    name = f"SmLs0{k}"
    groups = {}
    for line in open(name + ".dat").read().splitlines()[60:]:
        treatment, value = line.split()
        groups.setdefault(treatment, []).append(Fraction(float(value)))
    n = sum(map(len, groups.values()))
    grand = sum(sum(g) for g in groups.values()) / n
    between = sum(len(g) * (sum(g) / len(g) - grand) ** 2 for g in groups.values())
    within = Fraction(0)
    for g in groups.values():
        mean = sum(g) / len(g)
        within += sum((v - mean) ** 2 for v in g)
    show(name, "f", to_mpf((between / (len(groups) - 1)) / (within / (n - len(groups)))))
