#!/usr/bin/env python3
"""Golden profile-likelihood intervals of an S-N regression with run-outs: sn_profile.csv.

By brute force and without any derivative: under each value the likelihood of the tests of sn_mode.csv is maximized
over the other two parameters by Nelder and Mead's simplex, restarted until it stays, and the ends of the 90 % interval
are bisected. Needs nothing beside Python. Run from the project's root:
    python3 tests/golden/sn_profile.py > tests/golden/sn_profile.csv
"""
import csv
import math
import statistics

tests = []
starts = {}
for row in csv.reader(open("tests/golden/sn_mode.csv")):
    if row[0] == "test":
        tests.append((math.log10(float(row[1])), math.log10(float(row[2])), row[3] == "1"))
    elif row[0] in ("normal", "weibull"):
        starts[row[0]] = [float(each) for each in row[1:7]]  # estimates, standard errors

CRITICAL = statistics.NormalDist().inv_cdf(0.95) ** 2 / 2  # half of chi-square's 90 % quantile


def log_likelihood(family, a, b, sigma):  # of log10 life
    if sigma <= 0 or b >= 0:
        return -math.inf
    total = 0.0
    for stress, life, broke in tests:
        z = (life - (stress - a) / b) / sigma
        if family == "normal":
            total += -0.5 * z * z - math.log(sigma) if broke else math.log(max(0.5 * math.erfc(z / math.sqrt(2)), 1e-300))
        elif z > 700:
            return -math.inf
        else:
            total += z - math.exp(z) - math.log(sigma) if broke else -math.exp(z)
    return total


def simplex(f, start, size):  # the maximum of f
    best, value = list(start), f(start)
    while True:
        points = [(value, best)]
        for i in range(len(best)):
            moved = list(best)
            moved[i] += size[i]
            points.append((f(moved), moved))
        for _ in range(2000):
            points.sort(key=lambda p: -p[0])
            if points[0][0] - points[-1][0] < 1e-14:
                break
            n = len(best)
            middle = [sum(p[1][i] for p in points[:-1]) / n for i in range(n)]
            worst = points[-1][1]
            def at(t):
                x = [m + t * (m - w) for m, w in zip(middle, worst)]
                return f(x), x
            reflected = at(1)
            if reflected[0] > points[0][0]:
                points[-1] = max(at(2), reflected)
            elif reflected[0] > points[-2][0]:
                points[-1] = reflected
            else:
                inside = max(at(0.5), at(-0.5))
                if inside[0] > points[-1][0]:
                    points[-1] = inside
                else:
                    points = [points[0]] + [(f(x), x) for x in
                              ([0.5 * (u + v) for u, v in zip(p[1], points[0][1])] for p in points[1:])]
        points.sort(key=lambda p: -p[0])
        if points[0][0] - value < 1e-12:
            return points[0]
        value, best = points[0]
        size = [0.1 * each for each in size]


print("family,what,value,lower,upper")
for family in ("normal", "weibull"):
    a, b, sigma, *errors = starts[family]
    highest, (a, b, sigma) = simplex(lambda x: log_likelihood(family, *x), [a, b, sigma], [0.1 * e for e in errors])
    z10 = statistics.NormalDist().inv_cdf(0.1) if family == "normal" else math.log(-math.log1p(-0.1))
    s380 = math.log10(380e6)
    whats = {  # value at the maximum, a plausible step, its parameters from the held value and two others
        "log10_a": (a, errors[0], lambda v, o: (v, o[0], o[1]), (b, sigma), (errors[1], errors[2])),
        "b": (b, errors[1], lambda v, o: (o[0], v, o[1]), (a, sigma), (errors[0], errors[2])),
        "sigma": (sigma, errors[2], lambda v, o: (o[0], o[1], v), (a, b), (errors[0], errors[1])),
        "log10 B10 at 380 MPa": ((s380 - a) / b + z10 * sigma, sigma / 3,
                                 lambda v, o: (s380 - o[0] * (v - z10 * o[1]), o[0], o[1]), (b, sigma), (errors[1], errors[2])),
    }
    for what, (value, step, full, others, sizes) in whats.items():
        def fall(v):
            global last
            top, last = simplex(lambda o: log_likelihood(family, *full(v, o)), last, [0.1 * e for e in sizes])
            return highest - top
        ends = []
        for direction in (-1, 1):
            last = list(others)
            low, high = 0.0, step
            while fall(value + direction * high) < CRITICAL:
                low, high = high, high + step
            for _ in range(40):
                middle = 0.5 * (low + high)
                if fall(value + direction * middle) < CRITICAL:
                    low = middle
                else:
                    high = middle
            ends.append(value + direction * low)
        print(",".join([family, what] + ["%.9g" % each for each in (value, *ends)]), flush=True)
