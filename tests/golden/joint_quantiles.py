"""Quantiles of k and sigma of the joint study (flat k, bounded sigma), far into the tails: an independent computation in
plain Python. Log sigma and, on each of its nodes, log k in panels of Gauss-Legendre nodes about the conditional mode, where
each width of k is resolved; distributions by the polynomial through the nodes of a panel.

    python3 tests/golden/joint_quantiles.py > tests/golden/joint_quantiles.csv

k in 1e-4 mm^3/(N m), sigma in mm^3."""

import math

CYCLES = [1, 100, 1000, 5000, 10000, 20585]
VOLUME = [4.44, 5.105, 8.825, 24.175, 45.31, 92.73]
WORK = [c * 5.966e-4 for c in CYCLES]
UPPER = {"normal": 15.0, "lognormal": 7.0}
PROBABILITIES = [0.01, 0.05, 0.5, 0.95, 0.99]
NODES = 10


def gauss(n):
    """Nodes and weights on [-1, 1], by Newton's method on the Legendre polynomial."""
    x, w = [], []
    for i in range(n):
        t = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(100):
            p, q = 1.0, 0.0
            for j in range(n):
                p, q = ((2 * j + 1) * t * p - j * q) / (j + 1), p
            slope = n * (t * p - q) / (t * t - 1)
            t -= p / slope
        x.append(t)
        w.append(2 / ((1 - t * t) * slope * slope))
    return x[::-1], w[::-1]


X, W = gauss(NODES)


def log_density(family, n, t, z):
    """Of log k = t and log sigma = z: likelihood of the first n inspections times Jacobian."""
    k, s, total = math.exp(t), math.exp(z), t + z
    for v, work in zip(VOLUME[:n], WORK[:n]):
        mu = k * work
        if family == "normal":
            total += -0.5 * ((v - mu) / s) ** 2 - z
        else:
            zeta2 = math.log1p((s / mu) ** 2)
            total += -0.5 * (math.log(v) - math.log(mu) + zeta2 / 2) ** 2 / zeta2 - 0.5 * math.log(zeta2)
    return total


def highest(f, low, high):
    """Where f is highest: a grid, then golden sections about its best point."""
    points = [low + (high - low) * i / 400 for i in range(401)]
    i = max(range(401), key=lambda j: f(points[j]))
    a, b = points[max(i - 1, 0)], points[min(i + 1, 400)]
    g = (math.sqrt(5) - 1) / 2
    while b - a > 1e-12 * max(1, abs(a)):
        c, d = b - g * (b - a), a + g * (b - a)
        if f(c) > f(d):
            b = d
        else:
            a = c
    return 0.5 * (a + b)


class Panels:
    """A density on panels of nodes: its integral and its distribution function."""

    def __init__(self, edges, f):
        self.edges, self.nodes, self.values, self.cumulated = edges, [], [], [0.0]
        for a, b in zip(edges, edges[1:]):
            nodes = [0.5 * (a + b) + 0.5 * (b - a) * x for x in X]
            values = [f(t) for t in nodes]
            self.nodes.append(nodes)
            self.values.append(values)
            self.cumulated.append(self.cumulated[-1] + 0.5 * (b - a) * sum(w * v for w, v in zip(W, values)))

    def below(self, t):
        if t <= self.edges[0]:
            return 0.0
        if t >= self.edges[-1]:
            return self.cumulated[-1]
        i = max(j for j in range(len(self.edges) - 1) if self.edges[j] <= t)
        a, half, total = self.edges[i], 0.5 * (t - self.edges[i]), 0.0
        nodes, values = self.nodes[i], self.values[i]
        for x, w in zip(X, W):
            u = a + half * (1 + x)
            for j, v in enumerate(values):
                term = v
                for m, other in enumerate(nodes):
                    if m != j:
                        term *= (u - other) / (nodes[j] - other)
                total += w * half * term
        return self.cumulated[i] + total


def root(f, a, b):
    fa = f(a)
    for _ in range(60):
        c = 0.5 * (a + b)
        fc = f(c)
        if (fc > 0) == (fa > 0):
            a, fa = c, fc
        else:
            b = c
    return 0.5 * (a + b)


def study(family, n):
    top_z = math.log(UPPER[family])
    edges = [top_z - 16 + 0.5 * i for i in range(33)]
    least = math.log(sum(w * v for w, v in zip(WORK[:n], VOLUME[:n])) / sum(w * w for w in WORK[:n]))
    lines = []  # (log k's panels, weight of the line) per node of log sigma
    tops = []
    for a, b in zip(edges, edges[1:]):
        for x, w in zip(X, W):
            z = 0.5 * (a + b) + 0.5 * (b - a) * x
            mode = highest(lambda t: log_density(family, n, t, z), least - 3, least + 5)
            top = log_density(family, n, mode, z)
            tops.append(top)
            reach = []
            for way in (-1, 1):
                r = 1e-9
                while r < 40 and log_density(family, n, mode + way * r, z) > top - 40:
                    r *= 1.2
                reach.append(r)
            parts = [(i / 16) ** 1.5 for i in range(17)]
            cuts = [mode - reach[0] * p for p in parts[:0:-1]] + [mode] + [mode + reach[1] * p for p in parts[1:]]
            lines.append((z, 0.5 * (b - a) * w, cuts))
    top = max(tops)
    return edges, [
        (z, w, Panels(cuts, lambda t, z=z: math.exp(log_density(family, n, t, z) - top))) for z, w, cuts in lines
    ]


print("family,rows,parameter,mean,q01,q05,q50,q95,q99")
for family in UPPER:
    for n in (1, 2, 3, 5, 6):
        edges, lines = study(family, n)
        masses = {z: panels.cumulated[-1] for z, _, panels in lines}
        marginal = Panels(edges, lambda z: masses[min(masses, key=lambda other: abs(other - z))])
        total = marginal.cumulated[-1]
        mean = sum(w * masses[z] * math.exp(z) for z, w, _ in lines) / total
        quantiles = [
            math.exp(root(lambda z: marginal.below(z) / total - p, edges[0], edges[-1])) for p in PROBABILITIES
        ]
        print(f"{family},{n},sigma," + ",".join(f"{x:.8g}" for x in [mean, *quantiles]))
        mean = sum(
            w * 0.5 * (b - a) * wk * v * math.exp(t)
            for _, w, panels in lines
            for a, b, nodes, values in zip(panels.edges, panels.edges[1:], panels.nodes, panels.values)
            for t, v, wk in zip(nodes, values, W)
        ) / total
        quantiles = [
            math.exp(root(lambda t: sum(w * panels.below(t) for _, w, panels in lines) / total - p, -3, 16))
            for p in PROBABILITIES
        ]
        print(f"{family},{n},k," + ",".join(f"{x:.8g}" for x in [mean, *quantiles]), flush=True)
