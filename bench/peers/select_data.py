#!/usr/bin/env python3
"""Makes select.csv, the data of bench_select and peers/select.R: python3 select_data.py > select.csv

The layout of Haramina et al. (Appl. Sci. 2025, 15, 8150): a full factorial of 81 points in four inputs and 20 points
around it. The response is a constant and nine random terms of a cubic, with noise for an R2 of about 0.88.
"""
import itertools
import math
import random

random.seed(3)
levels = [(120, 170, 240), (1200, 1700, 2800), (0.9, 2.15, 3.4), (25, 50, 75)]
points = [list(map(float, point)) for point in itertools.product(*levels)]
for _ in range(20):
    points.append([round(random.uniform(l[0] - 0.15 * (l[2] - l[0]), l[2] + 0.15 * (l[2] - l[0])), 3) for l in levels])
terms = [c for d in (1, 2, 3) for c in itertools.combinations_with_replacement(range(4), d)]
truth = [0.0] * len(points)
for term in random.sample(terms, 9):
    column = [math.prod(point[i] for i in term) for point in points]
    low, high = min(column), max(column)
    coefficient = random.choice([-1, 1]) * random.uniform(0.5, 2)
    truth = [t + coefficient * (x - low) / (high - low) for t, x in zip(truth, column)]
mean = sum(truth) / len(truth)
sd = math.sqrt(sum((t - mean) ** 2 for t in truth) / len(truth) * 0.12 / 0.88)
print("a,b,c,d,y")
for point, t in zip(points, truth):
    print(",".join(f"{x:g}" for x in point) + f",{t + sd * random.gauss(0, 1):.6f}")
